//! `tabray grammar`: a grammar with which editors colour scenes in the notes' syntax.

use crate::cli::process::failure::{Failure, print};
use crate::scene::grammar;
use crate::scene::registry::Registry;
use crate::text;

/// Print a TextMate grammar of scenes, for editors
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {}

const EXAMPLES: &str = "\
Examples:
  tabray grammar > ray.tmLanguage.json";

pub fn run(registry: &Registry) -> Result<(), Failure> {
    print(&text::json_in_lines(&grammar::of(registry)))
}
