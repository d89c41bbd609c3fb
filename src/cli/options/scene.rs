//! One scene, and what is set in it.

use super::set;
use crate::files::input::{self, Source};
use crate::process::failure::Failure;
use std::path::PathBuf;
use tabray_core::scene::model::Model;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::registry::Registry;

/// A scene, and what is set in it.
#[derive(clap::Args)]
#[group(skip)]
pub struct Args {
    /// The scene; `-` reads it from standard input
    #[arg(value_name = "SCENE")]
    pub path: PathBuf,
    /// What is set in it.
    #[command(flatten)]
    pub set: set::Args,
}

impl Args {
    /// Reads the text of the scene.
    pub fn read(&self) -> Result<Source, Failure> {
        Source::read(&self.path, &self.set)
    }

    /// Reads the scene, prints its warnings and returns its model, with the given accuracy or with its own.
    pub fn load(&self, registry: &Registry, accuracy: Option<Accuracy>) -> Result<Model, Failure> {
        input::print_warnings(self.read()?.load(registry, accuracy)).map(|loaded| loaded.model)
    }
}
