//! `tabray grammar`: what editors need to colour scenes in the notes' spelling.

use super::failure::{Failure, print};
use crate::scene::grammar;
use crate::scene::registry::Registry;

/// Print a TextMate grammar of scenes, for editors
#[derive(clap::Args)]
pub struct Args {}

pub fn run(registry: &Registry) -> Result<(), Failure> {
    print(&format!("{:#}\n", grammar::of(registry)))
}
