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

/// Computes pixels as [`pairs`] does, each with the mean square error of a pixel of `fewer` samples, for several such
/// numbers, as fractions of 1 for white. A Sobol sequence falls into parts that are as even as a sequence of their length,
/// so that the samples of one image give many such pixels, which are compared with the other image.
pub fn pairs_and_errors(
    threads: &Renderer,
    plan: &mut Plan,
    pixels: &[[usize; 2]],
    (samples, seeds): (u32, [u32; 2]),
    fewer: &[u32],
) -> Vec<(Right, Vec<f64>)> {
    let (own, count) = (plan.camera.scramble, plan.camera.samples);
    plan.camera.samples = samples;
    let display = plan.camera.display();
    let [ones, others] = seeds.map(|seed| {
        plan.camera.scramble = own ^ seed;
        let plan = &*plan;
        traced::places(threads, plan, pixels, |[x, y]| {
            let places = plan.camera.places(x, y, samples);
            places.filter_map(|(place, sample)| Some((place, sample?))).collect()
        })
    });
    (plan.camera.scramble, plan.camera.samples) = (own, count);
    let mean = |colours: &[Rgb]| display.shown(colours.iter().sum::<Rgb>() / colours.len() as f64);
    let measured = |(one, other): (Vec<Rgb>, Vec<Rgb>)| {
        let right = [mean(&one), mean(&other)];
        // The other image is not exact either.
        let noise = 0.5 * (right[0] - right[1]).length_squared() / 3.0;
        let square = |fewer: &u32| {
            let parts = one.chunks(*fewer as usize).map(|part| mean(part) - right[1]);
            let parts = parts.chain(other.chunks(*fewer as usize).map(|part| mean(part) - right[0]));
            let squares: Vec<_> = parts.map(|off| off.length_squared() / 3.0).collect();
            squares.iter().sum::<f64>() / squares.len() as f64 - noise
        };
        (right, fewer.iter().map(square).collect())
    };
    ones.into_iter().zip(others).map(measured).collect()
}
