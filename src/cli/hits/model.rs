//! The scene that rays are asked of: it needs no camera, and may be the file of a mesh.

use crate::files::input::{self, Source};
use crate::files::mesh;
use crate::options::set;
use crate::process::failure::Failure;
use std::path::Path;
use tabray_core::scene::model::Model;
use tabray_core::scene::value::Datum;
use tabray_core::shapes::mesh::read::Wanted;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::reader::{Loaded, NO_CAMERA, ReadOptions, Report};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// The name of the camera of scenes that have none. No answer depends on it.
pub const UNUSED: &str = "a camera that is not used";

const CAMERA: &str = "{ pixeldim 1 1 position 0 0 1 target 0 0 0 angle 40 }";
const CAMERA_IN_TOML: &str = "\npixeldim = [1, 1]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nangle = 40";

/// Reads a scene, or makes one of a mesh, and prints its warnings.
pub fn load(
    registry: &Registry,
    path: &Path,
    sets: &set::Args,
    accuracy: Option<Accuracy>,
) -> Result<Model, Failure> {
    let options = ReadOptions { above_all: accuracy, only_rays: true, ..ReadOptions::default() };
    let loaded = if mesh::is_one(path) {
        of_mesh(path, sets).load_by(registry, options).map_err(|report| {
            // That names the file of the mesh and the place in it.
            mesh::read(path, Wanted::default()).err().unwrap_or(Failure::Scene(report))
        })?
    } else {
        let source = Source::read(path, sets)?;
        let loaded = source.load_by(registry, options);
        loaded.or_else(|report| with_camera(&source, registry, options, report)).map_err(Failure::Scene)?
    };
    input::print_warnings(Ok(loaded)).map(|loaded| loaded.model)
}

/// Reads a scene again with a camera, if the report says that it lacks one.
fn with_camera(
    source: &Source,
    registry: &Registry,
    options: ReadOptions,
    report: Report,
) -> Result<Loaded, Report> {
    if !report.faults().iter().any(|fault| fault.message == NO_CAMERA) {
        return Err(report);
    }
    let camera = match source.syntax() {
        Syntax::Toml => format!("[look_at.\"{UNUSED}\"]{CAMERA_IN_TOML}"),
        Syntax::Notes => format!("look_at \"{UNUSED}\" {CAMERA}"),
    };
    source.and(&camera).load_by(registry, options)
}

fn of_mesh(path: &Path, sets: &set::Args) -> Source {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let text = format!(
        "look_at \"{UNUSED}\" {CAMERA}\nmaterial grey {{ }}\nmesh {} {{ material grey file {} }}\n",
        Syntax::Notes.key(&name),
        Syntax::Notes.values(&Datum::Word(file)).concat()
    );
    Source::of_text(path, text, sets)
}
