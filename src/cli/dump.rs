//! `tabray dump`: a scene as the program understands it.

use super::failure::{Failure, print};
use super::input;
use crate::scene::dump;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use std::path::PathBuf;

/// Print a scene as the program understands it
#[derive(clap::Args)]
pub struct Args {
    /// The scene; `-` reads it from standard input
    scene: PathBuf,
    /// How to print it
    #[arg(long, default_value = "notes")]
    format: Format,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// As the course notes' program prints it, numbers to one decimal
    Notes,
    /// As a scene that loads again to the identical model
    Ray,
    /// As such a scene in TOML
    Toml,
}

pub fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let model = input::load(registry, &args.scene, None)?;
    print(&match args.format {
        Format::Notes => dump::notes(&model),
        Format::Ray => dump::scene(&model, Syntax::Notes),
        Format::Toml => dump::scene(&model, Syntax::Toml),
    })
}
