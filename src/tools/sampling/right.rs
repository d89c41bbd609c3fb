//! The colours of pixels that others are compared with.

use super::traced;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::SCRAMBLE;

/// The seeds of the samples of the two images whose mean counts as right. They share no samples with a render or with
/// each other.
pub const SCRAMBLES: [u32; 2] = [SCRAMBLE ^ 0x2545_f491, SCRAMBLE ^ 0x9e6c_63d0];

/// The colours of a pixel in two images of independent samples.
pub type Right = [Rgb; 2];

/// Computes pixels of two images with these seeds and a number of samples in each, as they are shown.
pub fn pairs(
    threads: &Renderer,
    plan: &mut Plan,
    pixels: &[[usize; 2]],
    (samples, seeds): (u32, [u32; 2]),
) -> Vec<Right> {
    let (own, count) = (plan.camera.scramble, plan.camera.samples);
    plan.camera.samples = samples;
    let [one, other] = seeds.map(|seed| {
        plan.camera.scramble = own ^ seed;
        traced::shown(threads, plan, pixels)
    });
    (plan.camera.scramble, plan.camera.samples) = (own, count);
    one.into_iter().zip(other).map(|(one, other)| [one, other]).collect()
}
