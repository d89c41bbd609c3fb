//! `tabray completions`: scripts with which shells complete the command line.

use crate::command::{Command, Group, Run};
use crate::line;
use crate::process::failure::{Failure, print};
use crate::process::program;
use clap_complete::Shell;
use tabray_lang::registry::Registry;

/// Print a completion script for a shell
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The shell
    shell: Shell,
}

const EXAMPLES: &str = "\
Examples:
  tabray completions bash > ~/.local/share/bash-completion/completions/tabray
  tabray completions fish > ~/.config/fish/completions/tabray.fish";

inventory::submit! {
    Command::new("completions", Group::Tools, &Run(run)).placed(3, 27)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(
        args.shell,
        &mut program::described(line(), registry),
        program::name(),
        &mut script,
    );
    print(&String::from_utf8_lossy(&script))
}
