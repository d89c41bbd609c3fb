//! Measures the cost of numbers of samples per pixel, and the errors that they leave in an image.

use crate::chart::{Difference, difference};
use serde::{Deserialize, Serialize};
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_core::world::display::Display;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::{SCRAMBLE, Sampler};
use tabray_tools::sampling::Samples;
use tabray_tools::sampling::traced::{self, Image};

/// The cost and the error of a number of samples. Errors are in levels of 1/255, of shown colours that are not
/// rounded to levels.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measured {
    /// The CPU time of one thread, in seconds: the least of some rounds.
    pub seconds: f64,
    /// The mean number of primary rays per pixel.
    pub rays: f64,
    /// The root of the mean square of the errors of all channels.
    pub rms: f64,
    /// The largest error of a pixel, that of its worst channel.
    pub worst: f64,
    /// The fractions of the pixels whose errors are at most 1, 2, 4 and 8 levels.
    pub within: [f64; LEVELS.len()],
}

/// The errors in levels for which [`Measured::within`] counts pixels.
pub const LEVELS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

/// Renders the colours of a model with enough samples per pixel to count as true.
pub fn truth(threads: &Renderer, model: &Model, samples: u32) -> Vec<Rgb> {
    let mut plan = Plan::new(model);
    Samples { sampler: Sampler::Sobol, samples, adaptive: None }.set(&mut plan);
    plan.camera.scramble = SCRAMBLE;
    traced::image(threads, &plan).colours
}

/// Measures numbers of samples, by turns, against the colours that [`truth`] returns.
pub fn measure(
    thread: &Renderer,
    model: &Model,
    all: &[Samples],
    truth: &[Rgb],
    rounds: usize,
) -> Vec<Measured> {
    let mut measured: Vec<Option<Measured>> = vec![None; all.len()];
    let mut plan = Plan::new(model);
    for _ in 0..rounds {
        for (choice, measured) in all.iter().zip(&mut measured) {
            choice.set(&mut plan);
            let image = traced::image(thread, &plan);
            let measured = measured.get_or_insert_with(|| compare(&plan.camera.display(), &image, truth));
            measured.seconds = measured.seconds.min(image.seconds);
        }
    }
    measured.into_iter().flatten().collect()
}

fn compare(display: &Display, image: &Image, truth: &[Rgb]) -> Measured {
    let Difference { rmse, worst, .. } = difference(display, &image.colours, truth);
    let count = truth.len() as f64;
    let off = |(colour, truth): (&Rgb, &Rgb)| {
        255.0 * (display.shown(*colour) - display.shown(*truth)).abs().max_element()
    };
    let errors: Vec<_> = image.colours.iter().zip(truth).map(off).collect();
    let within = LEVELS.map(|level| errors.iter().filter(|error| **error <= level).count() as f64 / count);
    let rays = image.primary as f64 / count;
    Measured { seconds: f64::INFINITY, rays, rms: 255.0 * rmse, worst: 255.0 * worst, within }
}
