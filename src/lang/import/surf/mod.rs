//! Scripts of surf 1.0.6: assignments, and commands that draw. What the first `draw_surface` shows is the picture.
//!
//! A picture shows x and y from -10 to 10 in its shorter side, from a viewer at positive z. A surface is moved by its
//! origin, turned around y, x and z, in this order, and then made smaller by its scale; a body of the picture's own
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
