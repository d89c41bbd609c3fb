//! Scripts of surf 1.0.6: assignments, and drawing commands. The first `draw_surface` gives the picture.
//!
//! A picture shows x and y from -10 to 10 along its shorter side, from a viewer at positive z. A surface is moved by
//! its origin, rotated around y, x and z, in this order, and then reduced by its scale. A body in the picture's own
//! coordinates cuts it.

mod script;
mod shown;

use super::notes::Notes;
use super::picture::Picture;
use script::{Script, without_comments};

/// Reads a script.
pub fn read(text: &str, notes: &mut Notes) -> Option<Picture> {
    Script::read(&without_comments(text), notes).picture()
}
