//! The text of a scene, which has no file.

use tabray_editor::{self as editor, Text, View};
use tabray_lang::registry::Registry;

/// The name of the scene in messages.
pub const NAME: &str = "scene";

/// Replaces the system's error about a file with advice: a page has only the files that it was given.
pub fn without_files(message: &str) -> String {
    message.replace(
        "operation not supported on this platform",
        "it is not on the page: drop it there, or choose it by `open`",
    )
}

/// Reads a text as an editor does.
pub fn view(registry: &Registry, text: &str) -> View {
    editor::read(registry, NAME, Text::new(text))
}
