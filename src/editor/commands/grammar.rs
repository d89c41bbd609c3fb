//! `tabray grammar`: a grammar with which editors colour scenes in the notes' syntax.

use crate::grammar;
use tabray_cli::process::failure::{Failure, print};
use tabray_cli::{Command, Group, Run};
use tabray_core::text;
use tabray_lang::registry::Registry;

/// Print a TextMate grammar of scenes, for editors
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {}

const EXAMPLES: &str = "\
Examples:
  tabray grammar > ray.tmLanguage.json";

inventory::submit! {
    Command::new("grammar", Group::Tools, &Run(run)).placed(2, 25)
}

fn run(registry: &Registry, _: Args) -> Result<(), Failure> {
    print(&text::json_in_lines(&grammar::of(registry)))
}
