//! The pending snapshots, as the page shows them.

use super::pending::{self, Content, Pending};
use crate::explain::Place;
use crate::report::{Change, Decision, Item};
use std::env;
use std::ffi::OsStr;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use tabray_cli::files::{input, picture};
use tabray_cli::options::set;
use tabray_cli::process::crash;
use tabray_cli::process::failure::{self, Failure};
use tabray_core::output::compare::Comparison;
use tabray_core::text::{self, quoted};
use tabray_lang::registry::Registry;

/// Returns the pending snapshots below a folder, and whether all of them could be read; errors were printed.
pub fn items(
    registry: &Registry,
    folder: &Path,
    before: Option<&Path>,
) -> Result<(Vec<Item>, bool), Failure> {
    let mut items = Vec::new();
    let found = pending::find(folder)?;
    for new in &found {
        match Pending::read(new).and_then(|snapshot| crash::catch(|| item(registry, &snapshot, before))?) {
            Ok(item) => items.push(item),
            Err(failure) => {
                failure::report(&failure);
            }
        }
    }
    let is_whole = items.len() == found.len();
    Ok((items, is_whole))
}

/// Describes a pending snapshot for the page.
fn item(registry: &Registry, snapshot: &Pending, before: Option<&Path>) -> Result<Item, Failure> {
    let path = &snapshot.path;
    let change = change(snapshot)?;
    let explanations = match (&change, scene(path)) {
        (
            Change::Picture { comparison: Some(Comparison { worst: Some(pixel), size, .. }), .. },
            Some(scene),
        ) => match input::load(registry, &scene, &set::Args::default(), None) {
            Ok(model) => {
                let set = &set::Args::default();
                Place { scene: &scene, set, model, size: *size, pixel: *pixel }.explained(before)
            }
            Err(failure) => {
                failure::report(&failure);
                Vec::new()
            }
        },
        _ => Vec::new(),
    };
    let program = env::args_os().next().unwrap_or_else(|| "tabray".into());
    let command = |option: &str| {
        [&program, OsStr::new("review"), OsStr::new(option), path.as_os_str()].map(quoted).join(" ")
    };
    let decision =
        Decision { accept: command("--accept"), reject: command("--reject"), version: snapshot.version() };
    Ok(Item { name: text::shown(path), change, explanations, decision: Some(decision) })
}

/// Returns the old and the new content of a snapshot.
fn change(snapshot: &Pending) -> Result<Change, Failure> {
    let unreadable = |reason: String| {
        Failure::usage(format!("cannot show the snapshot `{}`: {reason}", text::shown(&snapshot.path)))
    };
    let (old, new) = (snapshot.old.as_ref(), &snapshot.new);
    if let Some(new) = new.text() {
        let old = old.and_then(Content::text).map(str::to_owned);
        return Ok(Change::Text { old, new: new.to_owned() });
    }
    let decode = |content: &Content| picture::decode(&mut Cursor::new(content.bytes()));
    let new = decode(new).map_err(unreadable)?;
    // An old file that is not an image is a reason to accept a new one.
    let old = old.and_then(|old| decode(old).ok());
    let comparison = old.as_ref().and_then(|old| Comparison::new(old, &new, 0));
    Ok(Change::Picture { old, new, names: ["old".to_owned(), "new".to_owned()], comparison })
}

/// Returns the scene of an image's snapshot, if there is one: `snapshots/sphere/ball.snap` belongs to
/// `scenes/sphere/ball.ray`.
fn scene(snapshot: &Path) -> Option<PathBuf> {
    let mut parts: Vec<_> = snapshot.components().map(|part| part.as_os_str()).collect();
    let folder = parts.iter().rposition(|part| *part == "snapshots")?;
    parts[folder] = OsStr::new("scenes");
    let scene: PathBuf = parts.iter().collect();
    ["ray", "toml"].iter().map(|extension| scene.with_extension(extension)).find(|scene| scene.is_file())
}
