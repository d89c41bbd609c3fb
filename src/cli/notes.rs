//! Without a command: the notes' program, a filter from a scene to its dump and its picture.

use super::output::Output;
use super::size::Part;
use super::{Failure, input, interrupt, render};
use crate::accuracy::Accuracy;
use crate::dump;
use crate::picture::Format;
use crate::registry::Registry;
use crate::render::Renderer;
use std::io::Write;
use std::path::Path;

pub fn run(registry: &Registry) -> Result<(), Failure> {
    let standard = Path::new("-");
    let output = Output::open(standard)?;
    let model = input::load(registry, standard, Some(Accuracy::Classic))?;
    interrupt::catch()?;
    let _ = write!(std::io::stderr(), "{}", dump::notes(&model));
    let whole = Part::whole(&model.camera.value);
    render::picture(&model, &whole, &Renderer::new(0)?, Format::Ppm, standard, output, None)
}
