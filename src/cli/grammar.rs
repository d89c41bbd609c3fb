//! `tabray grammar`: a grammar with which editors colour scenes in the notes' syntax.

use super::failure::{Failure, print};
use crate::scene::grammar;
use crate::scene::registry::Registry;
use crate::text;

/// Print a TextMate grammar of scenes, for editors
#[derive(clap::Args)]
pub struct Args {}

pub fn run(registry: &Registry) -> Result<(), Failure> {
    print(&text::json_in_lines(&grammar::of(registry)))
}
