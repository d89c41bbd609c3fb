//! How many samples each pixel must at least take, where pixels take as many as they seem to need.
//!
//! A pixel that takes too few samples to meet a highlight does not know of it. Other samples of other pixels do, and the
//! error of the image is measured by these.

use super::error::{Measured, PixelError};
use super::right::{self, SCRAMBLES};
use super::strata::Strata;
use super::traced;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::world::sensor::Adaptive;

/// The factor by which the least number of samples is raised, and the greatest number to which it is.
const FACTOR: u32 = 4;
const HIGHEST: u32 = 1024;

/// One pixel in this many is looked at, and one is drawn, and the least and the greatest numbers of these.
const LOOKED_AT: (usize, [usize; 2]) = (8, [1 << 11, 1 << 17]);
const DRAWN: (usize, [usize; 2]) = (32, [256, 2048]);

/// The part of the greatest error below which an error is likely to be kept, and worth more pixels rather than more samples,
/// up to this many times as many.
const LIKELY: f64 = 0.8;
const MORE: usize = 8;

/// The least number of samples of each of the two images that count as right. Pixels that take more are compared with as
/// many.
const RIGHT: u32 = 32;

/// What an image is like with a least number of samples.
pub struct Raised {
    /// The least number of samples.
    pub least: u32,
    /// The root mean square error of the image, where 1 is white.
    pub error: Measured,
    /// The number of pixels on which it was measured.
    pub pixels: usize,
}

/// Raises the least number of samples of a plan until the error of its image is at most `most`, with a confidence of 95 %,
/// or no higher number is left. Returns the last one.
pub fn raise(plan: &mut Plan, threads: &Renderer, adaptive: Adaptive, most: f64) -> Raised {
    let count = |(part, [least, most]): (usize, [usize; 2])| {
        (plan.camera.pixels[0] * plan.camera.pixels[1] / part).clamp(least, most)
    };
    let (looked_at, wanted, mut least) = (count(LOOKED_AT), count(DRAWN), plan.camera.samples);
    plan.set_adaptive(None);
    let strata = Strata::new(plan, threads, looked_at, [&[], &[]]);
    let mut drawn = strata.drawn();
    drawn.draw(wanted);
    loop {
        plan.set_adaptive(None);
        let rights = right::pairs(threads, plan, &drawn.pixels, (RIGHT.max(least), SCRAMBLES));
        plan.camera.samples = least;
        plan.set_adaptive(Some(adaptive));
        let colours = traced::shown(threads, plan, &drawn.pixels);
        let pixels = colours.iter().zip(&rights);
        let errors: Vec<_> = pixels.map(|(colour, right)| PixelError::new(*colour, *right)).collect();
        let error = drawn.rms(&errors);
        let is_open = error.most > most;
        if is_open && error.mean <= LIKELY * most && errors.len() < strata.count().min(MORE * wanted) {
            drawn.draw(2 * errors.len());
        } else if is_open && least * FACTOR <= HIGHEST.min(adaptive.most / 2) {
            least *= FACTOR;
        } else {
            return Raised { least, error, pixels: errors.len() };
        }
    }
}
