//! `tabray new`: templates to start from.

mod mesh_scene;
mod plugin;
mod scene;

use crate::command::{Command, Group, Run};
use crate::process::failure::Failure;
use tabray_lang::registry::Registry;

/// Write a scene or a plugin to start from
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(subcommand)]
    subcommand: Subcommand,
}

const EXAMPLES: &str = "\
Examples:
  tabray new scene ball
  tabray new scene part --mesh part.stl
  tabray new plugin gem
  tabray new plugin stripes --kind shader";

#[derive(clap::Subcommand)]
enum Subcommand {
    Scene(scene::Args),
    Plugin(plugin::Args),
}

inventory::submit! {
    Command::new("new", Group::First, &Run(run)).placed(0, 23)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    match &args.subcommand {
        Subcommand::Scene(args) => scene::run(registry, args),
        Subcommand::Plugin(args) => plugin::run(registry, args),
    }
}
