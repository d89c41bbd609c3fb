//! `tabray schema`: what editors need to check and complete scenes in TOML.

use super::failure::{Failure, print};
use crate::scene::registry::Registry;
use crate::scene::schema;

/// Print a JSON Schema of scenes in TOML, for editors
#[derive(clap::Args)]
pub struct Args {}

pub fn run(registry: &Registry) -> Result<(), Failure> {
    print(&format!("{:#}\n", schema::of(registry)))
}
