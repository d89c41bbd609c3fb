//! The errors that numbers of samples leave in an image, measured on some of its pixels.
//!
//! The pixels are drawn from strata: those whose samples differ most are drawn most often, and none is left out. Each
//! is compared with samples that no render takes.

pub mod error;
pub mod places;
pub mod raise;
pub mod right;
pub mod strata;
pub mod traced;

use tabray_core::render::plan::Plan;
use tabray_core::world::sample::Sampler;
use tabray_core::world::sensor::Adaptive;

/// Numbers of samples per pixel.
#[derive(Clone, Copy, Debug)]
pub struct Samples {
    /// The distribution of the samples.
    pub sampler: Sampler,
    /// The number of samples, or the least of the numbers.
    pub samples: u32,
    /// The rule by which pixels take more samples.
    pub adaptive: Option<Adaptive>,
}

impl Samples {
    /// Gives a plan these numbers.
    pub fn set(self, plan: &mut Plan) {
        (plan.camera.samples, plan.camera.sampler) = (self.samples, self.sampler);
        plan.set_adaptive(self.adaptive);
    }
}
