//! `tabray dump`: a scene as the program understands it.

use crate::command::{Command, Group, Run};
use crate::options::scene;
use crate::process::failure::{Failure, print, print_scene};
use tabray_lang::dump;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// Print a scene as the program understands it
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// The format to print
    #[arg(long, default_value = "notes")]
    format: Format,
}

const EXAMPLES: &str = "\
Examples:
  tabray dump ball.ray
  tabray dump ball.ray --format toml
  tabray dump ball.ray --format ray --set ball.radius=3";

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// The course notes' dump, with numbers to one decimal
    Notes,
    /// A scene in the course notes' syntax that loads to the identical model
    Ray,
    /// A scene in TOML that loads to the identical model
    Toml,
}

inventory::submit! {
    Command::new("dump", Group::Scenes, &Run(run)).placed(6, 4)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let model = args.scene.load(registry, None)?;
    match args.format {
        Format::Notes => print(&dump::notes(&model)),
        Format::Ray => print_scene(&dump::scene(&model, Syntax::Notes)),
        Format::Toml => print_scene(&dump::scene(&model, Syntax::Toml)),
    }
}
