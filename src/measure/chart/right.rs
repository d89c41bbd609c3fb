//! The colours of pixels, and the right ones that these are compared with.

use super::progress::Progress;
use std::io;
use std::ops::ControlFlow;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::world::material::Rgb;
use tabray_tools::sampling::right::{self, Right, SCRAMBLES};
use tabray_tools::sampling::traced;

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
        self.counted(samples, colours)
    }

    /// Counts the samples of each pixel as done.
    fn counted<T>(&mut self, samples: u32, colours: T) -> io::Result<T> {
        match self.progress.done(self.pixels.len() * samples as usize / 10) {
            ControlFlow::Continue(()) => Ok(colours),
            ControlFlow::Break(()) => Err(io::ErrorKind::Interrupted.into()),
        }
    }

    /// Computes the right colours, with this many samples in each of the two images, and the mean square errors of pixels
    /// of fewer samples.
    pub fn right_and_errors(
        &mut self,
        plan: &mut Plan,
        samples: u32,
        fewer: &[u32],
    ) -> io::Result<Vec<(Right, Vec<f64>)>> {
        let found = right::pairs_and_errors(self.threads, plan, self.pixels, (samples, SCRAMBLES), fewer);
        self.counted(2 * samples, found)
    }

    /// Computes the right colours, with this many samples in each of the two images.
    pub fn right(&mut self, plan: &mut Plan, samples: u32) -> io::Result<Vec<Right>> {
        let colours = right::pairs(self.threads, plan, self.pixels, (samples, SCRAMBLES));
        self.counted(2 * samples, colours)
    }
}
