//! The colours of pixels, and the right ones that these are compared with.

use super::progress::Progress;
use super::traced;
use std::io;
use std::ops::ControlFlow;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::SCRAMBLE;

/// The seeds of the samples of the two images whose mean counts as right. They share no samples with a render or with
/// each other.
pub(super) const SCRAMBLES: [u32; 2] = [SCRAMBLE ^ 0x2545_f491, SCRAMBLE ^ 0x9e6c_63d0];

/// The colours of a pixel in two images of independent samples.
pub(super) type Right = [Rgb; 2];

/// The colours of some pixels, computed on all threads.
pub(super) struct Colours<'c> {
    pub threads: &'c Renderer,
    pub pixels: &'c [[usize; 2]],
    pub progress: &'c mut dyn Progress,
}

impl Colours<'_> {
    /// Computes the pixels with a number of samples.
    pub fn of(&mut self, plan: &mut Plan, samples: u32) -> io::Result<Vec<Rgb>> {
        plan.camera.samples = samples;
        let colours = traced::shown(self.threads, plan, self.pixels);
        match self.progress.done(self.pixels.len() * samples as usize / 10) {
            ControlFlow::Continue(()) => Ok(colours),
            ControlFlow::Break(()) => Err(io::ErrorKind::Interrupted.into()),
        }
    }

    /// Computes the right colours, with this many samples in each of the two images.
    pub fn right(&mut self, plan: &mut Plan, samples: u32) -> io::Result<Vec<Right>> {
        let own = plan.camera.scramble;
        let mut image = |scramble| {
            plan.camera.scramble = own ^ scramble;
            self.of(plan, samples)
        };
        let images = SCRAMBLES.map(&mut image);
        plan.camera.scramble = own;
        let [one, other] = images;
        Ok(one?.into_iter().zip(other?).map(|(one, other)| [one, other]).collect())
    }
}
