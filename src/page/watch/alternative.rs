//! The image of a scene with a setting other than its own, to compare the two.

use super::frame::Frame;
use crate::display;
use std::io;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};
use tabray_core::render::plan::Plan;
use tabray_core::render::progressive::{self, Area};
use tabray_core::scene::choice::Choice;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::Sampler;
use tabray_lang::registry::Registry;
use tabray_tools::threads::renderer_with;

/// A setting that replaces that of the scene.
#[derive(Clone, Copy)]
pub enum Override {
    Accuracy(Accuracy),
    /// The number of samples in each pixel.
    Samples(u32),
}

impl Override {
    /// Finds an accuracy by its name, or a number of samples.
    pub fn named(name: &str) -> Option<Self> {
        let accuracy = Accuracy::all().into_iter().find(|accuracy| accuracy.option().name == name);
        let samples = || name.parse().ok().filter(|samples| (1..=Sampler::MAX_SAMPLES).contains(samples));
        accuracy.map(Self::Accuracy).or_else(|| samples().map(Self::Samples))
    }
}

/// Renders a scene with another setting: red, green and blue of each pixel, in rows from the top, as the parts of an image
/// have them.
///
/// # Errors
/// The faults that the scene has then, and `Interrupted` if `check` breaks.
pub fn image(
    registry: &Registry,
    frame: &Frame,
    setting: Override,
    check: impl Fn() -> ControlFlow<()> + Sync,
) -> io::Result<Vec<u8>> {
    let accuracy = match setting {
        Override::Accuracy(accuracy) => Some(accuracy),
        Override::Samples(_) => None,
    };
    let mut model = frame.load(registry, accuracy)?;
    let camera = &mut model.camera.value;
    if let Override::Samples(samples) = setting {
        camera.samples = samples;
        camera.adaptive = None;
    }
    let [width, height] = camera.pixels;
    if camera.pixels != frame.model.camera.value.pixels {
        let message = "the files of the scene have changed since";
        return Err(io::Error::new(io::ErrorKind::InvalidData, message));
    }
    let all = Mutex::new(vec![Rgb::ZERO; width * height]);
    let part = |area: Area, colours: Vec<Rgb>| {
        if !area.is_final {
            return;
        }
        let ([left, top], [wide, _]) = (area.corner, area.size);
        let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
        for (row, colours) in colours.chunks(wide).enumerate() {
            let start = (top + row) * width + left;
            all[start..start + wide].copy_from_slice(colours);
        }
    };
    let rendered = progressive::render(&renderer_with(0)?, &mut Plan::for_picture(&model), part, check);
    if rendered.is_break() {
        return Err(io::ErrorKind::Interrupted.into());
    }
    Ok(display::singles(&all.into_inner().unwrap_or_else(PoisonError::into_inner)))
}
