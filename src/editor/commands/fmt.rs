//! `tabray fmt`: formats scenes.

use crate::{self as editor, Text, formatted, problem};
use std::path::{Path, PathBuf};
use tabray_cli::files::{input, output};
use tabray_cli::process::failure::{Failure, print_scene, report, status};
use tabray_cli::process::messages;
use tabray_cli::{Command, Group, Run};
use tabray_lang::reader::Report;
use tabray_lang::registry::Registry;

/// Format scenes
///
/// Aligns attributes that have a line each in columns; attributes that share a line stay on it. Keeps the comments, the
/// order and the meaning of the scene. A scene with syntax errors stays as it is.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scenes; `-` reads one from standard input and writes it to standard output
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Change nothing; name the scenes that are not formatted, and end with status 2 if there are any
    #[arg(long)]
    check: bool,
}

const EXAMPLES: &str = "\
Examples:
  tabray fmt ball.ray
  tabray fmt --check *.ray
  tabray fmt - < ball.ray";

inventory::submit! {
    Command::new("fmt", Group::Scenes, &Run(run)).placed(3, 8)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let mut worst = 0;
    for scene in &args.scenes {
        let failure = match one(registry, scene, args.check) {
            Ok(true) => continue,
            Ok(false) => Failure::AlreadyReported,
            Err(failure) => failure,
        };
        report(&failure);
        worst = worst.max(status(&failure));
    }
    if worst == 0 { Ok(()) } else { Err(Failure::Several(worst)) }
}

/// Formats a scene; returns whether it was formatted, or is now.
fn one(registry: &Registry, path: &Path, only_check: bool) -> Result<bool, Failure> {
    let (name, bytes) = input::read(path)?;
    let text = String::from_utf8(bytes).map_err(|_| {
        Failure::usage(format!("`{name}` is not text")).help("a scene is plain text, in UTF-8")
    })?;
    let (mark, body) = match text.strip_prefix('\u{feff}') {
        Some(body) => ("\u{feff}", body),
        None => ("", text.as_str()),
    };
    let view = editor::read(registry, &name, Text::new(body));
    let Some(new) = formatted(&view) else {
        let mut report = Report::new(&name, body.to_owned(), view.syntax);
        if let Some(fault) = problem(&view) {
            report.add(fault.help("only a scene without syntax errors can be formatted"));
        }
        return Err(Failure::Scene(report));
    };
    let is_formatted = new == body;
    match (input::is_standard(path), only_check) {
        (_, true) if !is_formatted => messages::error(&format!("{name}: not formatted"), None),
        (_, true) => {}
        (true, false) => print_scene(&format!("{mark}{new}"))?,
        (false, false) if is_formatted => {}
        (false, false) => {
            output::replace(path, format!("{mark}{new}").as_bytes())?;
            messages::note(&format!("formatted {name}"));
        }
    }
    Ok(is_formatted || !only_check)
}
