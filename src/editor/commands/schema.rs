//! `tabray schema`: a schema with which editors check and complete scenes in TOML.

use crate::schema;
use tabray_cli::process::failure::{Failure, print};
use tabray_cli::{Command, Group, Run};
use tabray_core::text;
use tabray_lang::registry::Registry;

/// Print a JSON Schema of scenes in TOML, for editors
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {}

const EXAMPLES: &str = "\
Examples:
  tabray schema > tabray.schema.json";

inventory::submit! {
    Command::new("schema", Group::Tools, &Run(run)).placed(1, 24)
}

fn run(registry: &Registry, _: Args) -> Result<(), Failure> {
    print(&text::json_in_lines(&schema::of(registry)))
}
