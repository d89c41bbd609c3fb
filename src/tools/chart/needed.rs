//! Pixels that take as many samples as they need, measured for `choose`.

use super::pictures::ADAPTIVE;
use super::places::Pixels;
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::parallel;
use crate::render::bytes::shown;
use crate::render::observer::{Count, DynObserver, RayKind, TraceObserver};
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::render::tiles::{self, TILE, TOGETHER};
use crate::render::trace::{Scratch, Tracer};
use crate::scene::model::Model;
use crate::simd::cpu::Cpu;
use crate::tools::bench::clock;
use crate::world::film::Adaptive;
use crate::world::material::Rgb;
use crate::world::sample::Sampler;
use std::hint::black_box;
use std::ops::Range;

/// About how many rays all choices take of a pixel that is measured alone, with the probes around it.
pub(super) const RAYS: u32 = 120;

/// The number of times that a choice is timed, after a first time that does not count.
const ROUNDS: usize = 2;

/// The measured cost and colours of a choice.
pub(super) struct MeasuredChoice {
    /// The least and the greatest number of samples.
    pub limits: [u32; 2],
    /// The colours of the pixels as they are shown.
    pub colours: Vec<Rgb>,
    /// The mean number of rays from the viewer for a pixel: its samples, and its part of the probes.
    pub rays: f64,
    /// The CPU time of one thread for a pixel in the mean, in seconds.
    pub seconds: f64,
}

/// Measures the choices whose greatest number of samples is at most `most`.
pub(super) fn measure(
    model: &Model,
    threads: &Renderer,
    pixels: &Pixels,
    timed: &[Pixels],
    most: u32,
) -> Vec<MeasuredChoice> {
    let mut plan = Plan::new(model);
    plan.camera.sampler = Sampler::Sobol;
    let wide: Vec<_> = timed.iter().map(|tile| widened(&plan, tile)).collect();
    let choices = ADAPTIVE.into_iter().filter(|[_, own]| *own <= most);
    choices
        .map(|[least, most]| {
            plan.camera.samples = least;
            plan.set_adaptive(Some(Adaptive { most, error: None }));
            let (colours, samples) = colours(threads, &plan, pixels);
            // Tiles differ in their samples, and there are fewer of them than pixels.
            let (of_sample, probes) = threads.run(|| (of_sample(&plan, &wide), probes(&plan, &wide)));
            MeasuredChoice {
                limits: [least, most],
                colours,
                rays: samples + probes,
                seconds: samples * of_sample,
            }
        })
        .collect()
}

/// Counts samples, and all rays from the viewer.
#[derive(Default)]
struct Samples {
    samples: u64,
    primary: u64,
}

impl TraceObserver for Samples {
    const SEES: bool = false;

    fn count(&mut self, count: Count) {
        match count {
            Count::Sampled(samples) => self.samples += u64::from(samples),
            Count::Rays(RayKind::Primary, rays) => self.primary += rays as u64,
            _ => {}
        }
    }
}

/// Returns the colours of pixels and the mean of their numbers of samples.
fn colours(threads: &Renderer, plan: &Plan, pixels: &Pixels) -> (Vec<Rgb>, f64) {
    // Pixels that lie far apart share no probes.
    let part = |range: Range<usize>| -> Vec<_> {
        let mut scratch = Scratch::default();
        let one = |pixel: &[usize; 2]| {
            let mut samples = Samples::default();
            let mut observer = DynObserver::<false>(&mut samples);
            let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut observer);
            let colour = shown(tracer.pixels(&[*pixel]).get(0));
            (colour, samples.samples)
        };
        pixels[range].iter().map(one).collect()
    };
    let all = threads.run(|| parallel::map_ranges(pixels.len(), 8, &part));
    let samples = all.iter().map(|(_, samples)| *samples).sum::<u64>() as f64;
    (all.iter().map(|(colour, _)| *colour).collect(), samples / pixels.len() as f64)
}

/// Returns the pixels of as many tiles as a render traces together, beside and with the given one.
fn widened(plan: &Plan, tile: &Pixels) -> Pixels {
    let [width, height] = plan.camera.pixels;
    let [left, low] = [0, 1].map(|axis| tile.iter().map(|pixel| pixel[axis]).min().unwrap_or(0));
    let left = left / (TILE * TOGETHER) * TILE * TOGETHER;
    let mut pixels = Vec::new();
    for left in (left..width.min(left + TILE * TOGETHER)).step_by(TILE) {
        tiles::list(left..width.min(left + TILE), low..height.min(low + TILE), &mut pixels);
    }
    pixels
}

/// Returns the CPU time of one thread for a sample, in seconds, with its part of the probes.
fn of_sample(plan: &Plan, tiles: &[Pixels]) -> f64 {
    let mut scratch = Scratch::default();
    let mut round = || {
        let mut samples = Samples::default();
        let start = clock::now();
        for tile in tiles {
            let mut observer = DynObserver::<false>(&mut samples);
            black_box(Tracer::new(plan, Cpu::best(), &mut scratch, &mut observer).pixels(tile));
        }
        (clock::now() - start).as_secs_f64() / samples.samples as f64
    };
    round();
    (0..ROUNDS).map(|_| round()).fold(f64::INFINITY, f64::min)
}

/// Returns the number of probes per pixel where these tiles are traced, each with those around it.
fn probes(plan: &Plan, tiles: &[Pixels]) -> f64 {
    let (mut scratch, mut samples) = (Scratch::default(), Samples::default());
    for tile in tiles {
        let mut observer = DynObserver::<false>(&mut samples);
        Tracer::new(plan, Cpu::best(), &mut scratch, &mut observer).pixels(tile);
    }
    let pixels: usize = tiles.iter().map(Vec::len).sum();
    samples.primary.saturating_sub(samples.samples) as f64 / pixels as f64
}

/// Returns how many tiles of a measurement by fixed numbers are timed here: about as many rays.
pub(super) fn timed(tiles: &[Pixels]) -> &[Pixels] {
    let pixels: usize = tiles.iter().map(Vec::len).sum();
    let few = pixels.div_ceil(4 * PACKET_SIZE * TOGETHER).clamp(1, tiles.len());
    &tiles[..few]
}
