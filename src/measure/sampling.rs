//! Measures the cost of numbers of samples per pixel, and the errors that they leave in an image.

use serde::{Deserialize, Serialize};
use std::ops::Range;
use tabray_core::parallel;
use tabray_core::render::observer::RayKind;
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::RayStats;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::tiles::{self, TILE, TOGETHER};
use tabray_core::render::trace::{Scratch, Tracer};
use tabray_core::scene::model::Model;
use tabray_core::simd::cpu::Cpu;
use tabray_core::world::display::Display;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::{SCRAMBLE, Sampler};
use tabray_tools::clock;
use tabray_tools::sampling::Samples;

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

/// Renders the colours of a model on all threads, with enough samples per pixel to count as true.
pub fn truth(renderer: &Renderer, model: &mut Model, samples: u32) -> Vec<Rgb> {
    let camera = &mut model.camera.value;
    (camera.samples, camera.adaptive, camera.sampler) = (samples, None, Sampler::Sobol);
    camera.scramble = SCRAMBLE;
    let plan = Plan::new(model);
    let all = tiles(plan.camera.pixels, 1);
    let render = |tile: usize| {
        let mut colours = Vec::new();
        let mut scratch = Scratch::default();
        trace(&plan, &mut scratch, &mut RayStats::default(), &all[tile], &mut colours);
        colours
    };
    let colours: Vec<_> = renderer.run(|| parallel::map(all.len(), render));
    model.camera.value.scramble = 0;
    colours.concat()
}

/// Measures numbers of samples, by turns, against the colours that [`truth`] returns.
pub fn measure(model: &mut Model, all: &[Samples], truth: &[Rgb], rounds: usize) -> Vec<Measured> {
    let mut measured: Vec<Option<Measured>> = vec![None; all.len()];
    for _ in 0..rounds {
        for (choice, measured) in all.iter().zip(&mut measured) {
            let camera = &mut model.camera.value;
            (camera.samples, camera.adaptive) = (choice.samples, choice.adaptive);
            camera.sampler = choice.sampler;
            let (mut colours, mut scratch, mut rays) = (Vec::new(), Scratch::default(), RayStats::default());
            let start = clock::now();
            let plan = Plan::new(model);
            let together = if choice.adaptive.is_some() { TOGETHER } else { 1 };
            for tile in tiles(plan.camera.pixels, together) {
                trace(&plan, &mut scratch, &mut rays, &tile, &mut colours);
            }
            let seconds = (clock::now() - start).as_secs_f64();
            let measured = measured.get_or_insert_with(|| {
                let rays = rays.rays(RayKind::Primary) as f64 / colours.len() as f64;
                compare(&plan.camera.display(), &colours, truth, rays)
            });
            measured.seconds = measured.seconds.min(seconds);
        }
    }
    measured.into_iter().flatten().collect()
}

fn compare(display: &Display, colours: &[Rgb], truth: &[Rgb], rays: f64) -> Measured {
    let (mut errors, mut squares) = (Vec::new(), 0.0);
    for (colour, truth) in colours.iter().zip(truth) {
        let off = 255.0 * (display.shown(*colour) - display.shown(*truth)).abs();
        squares += off.length_squared();
        errors.push(off.max_element());
    }
    let rms = (squares / (3 * errors.len()) as f64).sqrt();
    let worst = errors.iter().copied().fold(0.0, f64::max);
    let within = LEVELS
        .map(|level| errors.iter().filter(|error| **error <= level).count() as f64 / errors.len() as f64);
    Measured { seconds: f64::INFINITY, rays, rms, worst, within }
}

/// Lists the tiles of an image, by their columns and rows.
fn tiles([width, height]: [usize; 2], together: usize) -> Vec<[Range<usize>; 2]> {
    let wide = TILE * together;
    let side = |from: usize, end: usize, size: usize| from..end.min(from + size);
    let rows = (0..height).step_by(TILE);
    rows.flat_map(|low| {
        (0..width).step_by(wide).map(move |left| [side(left, width, wide), side(low, height, TILE)])
    })
    .collect()
}

fn trace(
    plan: &Plan,
    scratch: &mut Scratch,
    rays: &mut RayStats,
    [columns, rows]: &[Range<usize>; 2],
    colours: &mut Vec<Rgb>,
) {
    let mut pixels = Vec::new();
    for left in columns.clone().step_by(TILE) {
        tiles::list(left..columns.end.min(left + TILE), rows.clone(), &mut pixels);
    }
    let mut tracer = Tracer::new(plan, Cpu::best(), scratch, rays);
    let seen = tracer.pixels(&pixels);
    colours.extend((0..pixels.len()).map(|pixel| seen.get(pixel)));
}
