//! `tabray` with one more command, `template`. Describe it here.

use std::path::{Path, PathBuf};
use tabray::cli::{self, Command, Failure, Group, Run, clap};
use tabray::prelude::inventory;
use tabray::scene::{Registry, read};

// Its name, the group in which `--help` lists it, and what it does.
inventory::submit! {
    Command::new("template", Group::Inside, &Run(run))
}

/// Tell how many objects a scene has
#[derive(clap::Args)]
struct Args {
    /// The scene
    scene: PathBuf,
}

fn run(registry: &Registry, Args { scene }: Args) -> Result<(), Failure> {
    let bytes = std::fs::read(&scene).map_err(|error| Failure::cannot_read(&scene, &error))?;
    let folder = scene.parent().unwrap_or(Path::new(""));
    let loaded = read(registry, &scene.to_string_lossy(), folder, &bytes, None).map_err(Failure::Scene)?;
    cli::print(&format!("{} objects\n", loaded.model.objects.len()))
}

fn main() -> std::process::ExitCode {
    cli::run()
}
