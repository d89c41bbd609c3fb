//! `tabray review`: a page with the snapshots that wait for a decision.

pub(super) mod decide;
mod items;
mod pending;

use super::report::Page;
use pending::Pending;
use std::path::PathBuf;
use tabray_cli::options::number::whole;
use tabray_cli::process::failure::Failure;
use tabray_cli::process::messages;
use tabray_cli::{Command, Group, Run};
use tabray_core::text;
use tabray_lang::registry::Registry;

/// Review the snapshots that failing tests left
///
/// For each snapshot, the page shows the old image, the new image and their difference, or the changed lines of a text,
/// and the command that accepts it. It explains the pixel that differs most, like `tabray probe`, for the current scene
/// and, with `--before`, by the program that made the old image.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
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
    /// Serve the page instead, to accept or reject snapshots in the browser until none is pending. Only this machine
    /// can reach the page, and only at the printed address, which contains a token that keeps other users out
    #[arg(long, conflicts_with = "output")]
    serve: bool,
    /// The port to serve on; by default the first free one from 3000
    #[arg(long, value_name = "N", value_parser = whole::<u16>(0..=65535), requires = "serve")]
    port: Option<u16>,
    /// Accept these snapshots, or all in a folder, instead of writing a page
    #[arg(long, value_name = "SNAPSHOT", num_args = 1.., conflicts_with_all = ["reject", "output", "before", "serve"])]
    accept: Vec<PathBuf>,
    /// Reject these snapshots, or all in a folder: the new ones are deleted, the old ones stay
    #[arg(long, value_name = "SNAPSHOT", num_args = 1.., conflicts_with_all = ["output", "before", "serve"])]
    reject: Vec<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  tabray review --serve
  tabray review --accept snapshots/entities/ring.snap.png
  tabray review -o review.html --before ../old/tabray";

inventory::submit! {
    Command::new("review", Group::Inside, &Run(run)).placed(4, 19)
}

fn run(registry: &'static Registry, args: Args) -> Result<(), Failure> {
    if !args.accept.is_empty() {
        return each(&args.accept, "accepted", Pending::accept);
    }
    if !args.reject.is_empty() {
        return each(&args.reject, "rejected", Pending::reject);
    }
    if pending::find(&args.folder)?.is_empty() {
        messages::note(&format!("nothing is pending in `{}`", text::shown(&args.folder)));
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
    if is_whole { Ok(()) } else { Err(Failure::AlreadyReported) }
}

/// Accepts or rejects the snapshots at these paths.
fn each(
    paths: &[PathBuf],
    verdict: &str,
    decide: impl Fn(&Pending) -> Result<(), Failure>,
) -> Result<(), Failure> {
    for path in paths {
        for new in pending::find(path)? {
            let snapshot = Pending::read(&new)?;
            decide(&snapshot)?;
            messages::note(&format!("{verdict} {}", text::shown(&snapshot.path)));
        }
    }
    Ok(())
}
