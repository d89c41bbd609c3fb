//! Scenes for rays only: they need no camera.

use super::build::NO_CAMERA;
use super::report::Report;
use crate::syntax::Syntax;
use std::ffi::OsStr;
use std::path::Path;
use tabray_core::scene::value::Datum;

/// The name of the camera that is added to a scene without one. No answer depends on it.
pub const UNUSED_CAMERA: &str = "a camera that is not used";

const CAMERA: &str =
    "look_at \"a camera that is not used\" { pixeldim 1 1 position 0 0 1 target 0 0 0 angle 40 }";
const CAMERA_IN_TOML: &str = "[look_at.\"a camera that is not used\"]
pixeldim = [1, 1]
position = [0, 0, 1]
target = [0, 0, 0]
angle = 40";

/// Returns the text of a scene for queries of rays. It consists of the mesh in a file, whose name is relative to the
/// scene's folder.
pub fn mesh_for_rays(file: &Path) -> String {
    let text = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (name, file) = (text(file.file_stem()), Datum::Word(text(file.file_name())));
    let (name, file) = (Syntax::Notes.key(&name), Syntax::Notes.values(&file).concat());
    format!("{CAMERA}\nmaterial grey {{ }}\nmesh {name} {{ material grey file {file} }}\n")
}

/// A scene of one object, whose shape the caller replaces.
pub const ONE_OBJECT: &str = "material grey { }  sphere shape { material grey  center 0 0 0  radius 1 }";

/// Returns the text of a scene with a camera added.
pub fn with_camera(bytes: &[u8], syntax: Syntax) -> Vec<u8> {
    let camera = if syntax == Syntax::Toml { CAMERA_IN_TOML } else { CAMERA };
    [bytes, b"\n", camera.as_bytes()].concat()
}

impl Report<'_> {
    /// Tells whether one of the faults is that the scene has no camera.
    pub fn lacks_camera(&self) -> bool {
        self.faults().iter().any(|fault| fault.message == NO_CAMERA)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_has_its_name_in_both_syntaxes() {
        for text in [CAMERA, CAMERA_IN_TOML] {
            assert!(text.contains(&format!("\"{UNUSED_CAMERA}\"")), "{text}");
        }
    }
}
