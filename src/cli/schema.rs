//! `tabray schema`: a schema with which editors check and complete scenes in TOML.

use super::failure::{Failure, print};
use crate::scene::registry::Registry;
use crate::scene::schema;
use crate::text;

/// Print a JSON Schema of scenes in TOML, for editors
#[derive(clap::Args)]
pub struct Args {}

pub fn run(registry: &Registry) -> Result<(), Failure> {
    print(&text::json_in_lines(&schema::of(registry)))
}
