//! The scene that rays are asked of: it needs no camera, and may be the file of a mesh.

use std::path::Path;
use tabray_cli::files::input::{self, Source};
use tabray_cli::files::mesh;
use tabray_cli::options::set;
use tabray_cli::process::failure::Failure;
use tabray_cli::process::messages;
use tabray_core::scene::model::Model;
use tabray_core::shapes::mesh::read::Wanted;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::reader::mesh_for_rays;
use tabray_lang::registry::Registry;

/// Reads a scene, or makes one of a mesh, and prints its warnings.
pub fn load(
    registry: &Registry,
    path: &Path,
    sets: &set::Args,
    accuracy: Option<Accuracy>,
) -> Result<Model, Failure> {
    if !mesh::is_one(path) {
        let loaded = Source::read(path, sets)?.load_for_rays(registry, accuracy).map_err(Failure::Scene);
        return input::print_warnings(Ok(loaded?)).map(|loaded| loaded.model);
    }
    let loaded = Source::of_text(path, mesh_for_rays(path), sets).load_for_rays(registry, accuracy);
    let loaded = loaded.map_err(|report| {
        // That names the file of the mesh and the place in it.
        mesh::read(path, Wanted::default()).err().unwrap_or(Failure::Scene(report))
    })?;
    // The text of the scene is none that anybody wrote, so its lines are not shown.
    for fault in loaded.warnings.faults() {
        messages::warning(&fault.message, fault.help.as_deref());
    }
    Ok(loaded.model)
}
