//! The text of a scene, which has no file.

use tabray_lang::editor::{self, Text, View};
use tabray_lang::registry::Registry;

/// What messages call the scene.
pub const NAME: &str = "scene";

/// Reads a text as an editor does.
pub fn view(registry: &Registry, text: &str) -> View {
    editor::read(registry, NAME, Text::new(text))
}
