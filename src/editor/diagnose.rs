//! The errors and warnings of a scene, as the loader reports them, each in its file.

use super::text::{Position, Text};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_core::files::plain;
use tabray_core::text;
use tabray_lang::reader::{self, Fault, Located, ReadOptions, Severity};
use tabray_lang::registry::Registry;

/// An error or a warning in a file.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// The file.
    pub path: PathBuf,
    /// Whether this is an error or a warning.
    pub severity: Severity,
    /// The error and its correction.
    pub message: String,
    /// The beginning and the end of the marked text.
    pub range: [Position; 2],
    /// Further places.
    pub also: Vec<Remark>,
    /// The likely correction of the marked word.
    pub meant: Option<String>,
    /// The marked text.
    pub marked: String,
}

/// A further place of an error or a warning.
#[derive(Clone, Debug)]
pub struct Remark {
    pub path: PathBuf,
    pub range: [Position; 2],
    pub text: String,
}

/// Reads a scene like a render, and returns its errors and warnings. Included files that are `open` in the editor are
/// read from there.
pub fn diagnose(
    registry: &Registry,
    path: &Path,
    text: &str,
    open: &[(PathBuf, Arc<str>)],
) -> Vec<Diagnosis> {
    let folder = path.parent().unwrap_or(path);
    let name = text::shown(path);
    let report = match reader::read_by(
        registry,
        &name,
        folder,
        text.as_bytes(),
        ReadOptions { open, ..ReadOptions::default() },
    ) {
        Ok(loaded) => loaded.warnings,
        Err(report) => report,
    };
    let mut texts = HashMap::new();
    report.located().map(|(fault, located)| diagnosis(fault, located, &mut texts)).collect()
}

/// Returns an error or a warning with its places.
fn diagnosis<'r>(fault: &Fault, located: Vec<Located<'r>>, texts: &mut HashMap<&'r str, Text>) -> Diagnosis {
    let mut remarks: Vec<_> = located
        .iter()
        .map(|located| {
            let text = texts.entry(located.name).or_insert_with(|| Text::new(located.text));
            let range = [located.place.start, located.place.end].map(|at| text.position(at));
            Remark { path: plain(Path::new(located.name)), range, text: located.label.to_owned() }
        })
        .collect();
    let first = remarks.remove(0);
    let mut message = fault.message.clone();
    if !first.text.is_empty() {
        message += &format!(": {}", first.text);
    }
    if fault.similar_faults.0 > 0 {
        message += &format!(" (and in {})", tabray_core::text::count(fault.similar_faults.0, "more place"));
    }
    if let Some(help) = &fault.help {
        message += &format!("\nhelp: {help}");
    }
    let marked = &located[0];
    Diagnosis {
        path: first.path,
        severity: fault.severity,
        message,
        range: first.range,
        also: remarks,
        meant: fault.meant.clone(),
        marked: marked.text.get(marked.place.clone()).unwrap_or_default().to_owned(),
    }
}
