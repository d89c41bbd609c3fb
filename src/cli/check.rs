//! `tabray check`: reports the faults of scenes.

use crate::command::{Command, Group, Run};
use crate::files::{folders, input};
use crate::options::set;
use crate::process::failure::{Failure, report, status};
use crate::process::messages;
use std::path::PathBuf;
use std::sync::Arc;
use tabray_core::text;
use tabray_lang::reader;
use tabray_lang::registry::Registry;
use tabray_tools::diagnosis;

/// Check scenes for errors
///
/// Prints the first 100 errors and the first 100 warnings of each scene, and counts the others.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scenes, or folders of scenes; `-` reads one from standard input
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    set: set::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray check ball.ray
  tabray check *.ray --message-format short";

inventory::submit! {
    Command::new("check", Group::First, &Run(run)).placed(2, 7)
}

fn run(registry: &Registry, mut args: Args) -> Result<(), Failure> {
    folders::open(&mut args.scenes)?;
    let mut worst = 0;
    for scene in &args.scenes {
        match input::load(registry, scene, &args.set, None) {
            Ok(model) => {
                if !reader::is_black(&model) {
                    messages::remark(diagnosis::tried(Arc::new(model)));
                }
                messages::note(&format!("{}: no errors", text::shown(scene)));
            }
            // The scene may be sound: the machine is at fault.
            Err(failure @ Failure::Failed(_)) => return Err(failure),
            Err(failure) => {
                report(&failure);
                worst = worst.max(status(&failure));
            }
        }
    }
    if worst == 0 { Ok(()) } else { Err(Failure::Several(worst)) }
}
