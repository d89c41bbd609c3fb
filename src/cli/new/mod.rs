//! `tabray new`: templates to start from.

mod plugin;
mod scene;

use super::failure::Failure;
use crate::scene::registry::Registry;

/// Write a scene or a plugin to start from
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    Scene(scene::Args),
    Plugin(plugin::Args),
}

pub fn run(registry: &Registry, args: &Args) -> Result<(), Failure> {
    match &args.what {
        What::Scene(args) => scene::run(args),
        What::Plugin(args) => plugin::run(registry, args),
    }
}
