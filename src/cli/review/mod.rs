//! `tabray review`: the snapshots that wait for a decision, on a page.

mod decide;
mod items;
mod pending;

use super::failure::Failure;
use super::messages;
use super::report::Page;
use crate::scene::registry::Registry;
use pending::Pending;
use std::path::PathBuf;

/// Show the snapshots that tests left to be reviewed
///
/// The page shows for each the old and the new picture and their difference, or what lines of a text changed, and the
/// command that accepts it. The first pixel that differs is explained as `tabray probe` does it, for the scene as it is
/// now, and with `--before` by the program that the old picture was made with.
#[derive(clap::Args)]
pub struct Args {
    /// The folder of the snapshots
    #[arg(default_value = "snapshots")]
    folder: PathBuf,
    /// Where to write the page: one .html file, with everything in it
    #[arg(short, long, value_name = "FILE", default_value = "review.html")]
    output: PathBuf,
    /// An older `tabray`, which explains the old pictures
    #[arg(long, value_name = "PROGRAM")]
    before: Option<PathBuf>,
    /// Show the page in a browser instead, and accept or reject from there, until nothing is pending; only this machine
    /// can see it
    #[arg(long, conflicts_with = "output")]
    serve: bool,
    /// The port for that; by default the first free one from 3000
    #[arg(long, requires = "serve")]
    port: Option<u16>,
    /// Accept these snapshots, or all below a folder, instead of writing a page
    #[arg(long, value_name = "SNAPSHOT", num_args = 1.., conflicts_with_all = ["reject", "output", "before", "serve"])]
    accept: Vec<PathBuf>,
    /// Reject these snapshots, or all below a folder: what is new goes, what is old stays
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
        return decide::serve(registry, args.folder.clone(), args.before.clone(), args.port);
    }
    let page = Page::open(&args.output)?;
    let (items, is_whole) = items::items(registry, &args.folder, args.before.as_deref())?;
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
