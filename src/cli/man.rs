//! `tabray man`: manual pages, as packages install them.

use crate::command::{Command, Group, Run};
use crate::files::output;
use crate::line;
use crate::process::failure::Failure;
use crate::process::{messages, program};
use clap_mangen::Man;
use std::path::{Path, PathBuf};
use tabray_core::text;
use tabray_lang::registry::Registry;

/// Write the man pages, one for each command
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The folder to write to, such as share/man/man1
    folder: PathBuf,
}

const EXAMPLES: &str = "\
Examples:
  tabray man ~/.local/share/man/man1";

inventory::submit! {
    Command::new("man", Group::Tools, &Run(run)).placed(4, 28)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let folder = &args.folder;
    output::create_folder(folder)?;
    let mut command = program::described(line(), registry).disable_help_subcommand(true);
    command.build();
    let count = pages(command, folder)?;
    messages::note(&format!("wrote {count} pages to {}", text::shown(folder)));
    Ok(())
}

/// Writes the page of a command and those of its subcommands; returns the number of pages.
fn pages(command: clap::Command, folder: &Path) -> Result<usize, Failure> {
    let mut count = 1;
    for command in command.get_subcommands() {
        count += pages(command.clone(), folder)?;
    }
    let man = Man::new(command).source(concat!("tabray ", env!("CARGO_PKG_VERSION")));
    let path = folder.join(man.get_filename());
    let mut page = Vec::new();
    man.render(&mut page)?;
    output::replace(&path, &page)?;
    Ok(count)
}
