//! `tabray review`: the snapshots that wait for a decision, on a page.

mod decide;
mod pending;

use super::explain::Place;
use super::report::{Change, Decision, Item, Page};
use super::{Failure, input, messages, picture, tell};
use crate::compare::Comparison;
use crate::registry::Registry;
use pending::{Content, Pending};
use std::env;
use std::ffi::OsStr;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Review the snapshots that failing tests left
///
/// For each snapshot, the page shows the old image, the new image and their difference, or the changed lines of a text,
/// and the command that accepts it. The first pixel that differs is explained as by `tabray probe`, for the scene as it
/// is now and, with `--before`, by the program that made the old image.
#[derive(clap::Args)]
pub struct Args {
    /// The folder of the snapshots
    #[arg(default_value = "snapshots")]
    folder: PathBuf,
    /// The page to write: one self-contained .html file
    #[arg(short, long, value_name = "FILE", default_value = "review.html")]
    output: PathBuf,
    /// An older `tabray`, to explain the old images
    #[arg(long, value_name = "PROGRAM")]
    before: Option<PathBuf>,
    /// Serve the page instead, to accept or reject from the browser until nothing is pending; only this machine can
    /// reach it
    #[arg(long, conflicts_with = "output")]
    serve: bool,
    /// The port to serve on; by default the first free one from 3000
    #[arg(long, requires = "serve")]
    port: Option<u16>,
    /// Accept these snapshots, or all in a folder, instead of writing a page
    #[arg(long, value_name = "SNAPSHOT", num_args = 1.., conflicts_with_all = ["reject", "output", "before", "serve"])]
    accept: Vec<PathBuf>,
    /// Reject these snapshots, or all in a folder: the new ones are deleted, the old ones stay
    #[arg(long, value_name = "SNAPSHOT", num_args = 1.., conflicts_with_all = ["output", "before", "serve"])]
    reject: Vec<PathBuf>,
}

pub fn run(registry: &'static Registry, args: &Args) -> Result<(), Failure> {
    if !args.accept.is_empty() {
        return each(&args.accept, "accepted", Pending::accept);
    }
    if !args.reject.is_empty() {
        return each(&args.reject, "rejected", Pending::reject);
    }
    if pending::find(&args.folder)?.is_empty() {
        messages::note(&format!("nothing is pending in `{}`", args.folder.display()));
        return Ok(());
    }
    if args.serve {
        return decide::serve(registry, args);
    }
    let page = Page::open(&args.output)?;
    let (items, is_whole) = items(registry, &args.folder, args.before.as_deref())?;
    for item in &items {
        messages::note(&format!("{}: {}", item.name, item.change.summary()));
    }
    page.write("tabray review", &items)?;
    if is_whole { Ok(()) } else { Err(Failure::Told) }
}

/// Decides about the snapshots at these paths.
fn each(
    paths: &[PathBuf],
    verdict: &str,
    decide: impl Fn(&Pending) -> Result<(), Failure>,
) -> Result<(), Failure> {
    for path in paths {
        for new in pending::find(path)? {
            let snapshot = Pending::read(&new)?;
            decide(&snapshot)?;
            messages::note(&format!("{verdict} {}", snapshot.path.display()));
        }
    }
    Ok(())
}

/// What is pending below a folder, and whether all of it could be read; what could not has been told.
fn items(registry: &Registry, folder: &Path, before: Option<&Path>) -> Result<(Vec<Item>, bool), Failure> {
    let mut items = Vec::new();
    let found = pending::find(folder)?;
    for new in &found {
        match Pending::read(new).and_then(|snapshot| item(registry, &snapshot, before)) {
            Ok(item) => items.push(item),
            Err(failure) => {
                tell(&failure);
            }
        }
    }
    let is_whole = items.len() == found.len();
    Ok((items, is_whole))
}

/// A pending snapshot on the page.
fn item(registry: &Registry, snapshot: &Pending, before: Option<&Path>) -> Result<Item, Failure> {
    let path = &snapshot.path;
    let change = change(snapshot)?;
    let explanations = match (&change, scene(path)) {
        (
            Change::Picture { comparison: Some(Comparison { first: Some(pixel), size, .. }), .. },
            Some(scene),
        ) => match input::load(registry, &scene, None) {
            Ok(model) => Place { scene: &scene, model, size: *size, pixel: *pixel }.explained(before),
            Err(failure) => {
                tell(&failure);
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
    Ok(Item { name: path.display().to_string(), change, explanations, decision: Some(decision) })
}

/// What is old and new of it.
fn change(snapshot: &Pending) -> Result<Change, Failure> {
    let unreadable = |reason: String| {
        Failure::Usage(format!("cannot show the snapshot `{}`: {reason}", snapshot.path.display()), None)
    };
    match (&snapshot.old, &snapshot.new) {
        (old, Content::Text(new)) => {
            let old = match old {
                Some(Content::Text(old)) => Some(old.clone()),
                _ => None,
            };
            Ok(Change::Text { old, new: new.clone() })
        }
        (old, Content::Binary(new, _)) => {
            let decode = |bytes: &Vec<u8>| picture::decode(Cursor::new(bytes));
            let new = decode(new).map_err(unreadable)?;
            // An old picture that is none is a reason to have a new one.
            let old = match old {
                Some(Content::Binary(old, _)) => decode(old).ok(),
                _ => None,
            };
            let comparison = old.as_ref().and_then(|old| Comparison::new(old, &new, 0));
            Ok(Change::Picture { old, new, names: ["old".to_owned(), "new".to_owned()], comparison })
        }
    }
}

/// The scene of a picture's snapshot, if there is one: `snapshots/sphere/ball.snap` is of `scenes/sphere/ball.ray`.
fn scene(snapshot: &Path) -> Option<PathBuf> {
    let mut parts: Vec<_> = snapshot.components().map(|part| part.as_os_str()).collect();
    let folder = parts.iter().rposition(|part| *part == "snapshots")?;
    parts[folder] = OsStr::new("scenes");
    let scene: PathBuf = parts.iter().collect();
    ["ray", "toml"].iter().map(|extension| scene.with_extension(extension)).find(|scene| scene.is_file())
}

/// A word of a command, as a shell takes it.
fn quoted(word: &OsStr) -> String {
    let word = word.to_string_lossy();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-./:=+,@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.into_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
