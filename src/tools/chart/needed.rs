//! Pixels that take as many samples as they need, measured for `choose`.

use super::cost::Timing;
use super::pictures::ADAPTIVE;
use std::ops::Range;
use tabray_core::parallel;
use tabray_core::render::observer::{Count, DynObserver, TraceObserver};
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::trace::{Scratch, Tracer};
use tabray_core::scene::model::Model;
use tabray_core::simd::cpu::Cpu;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::Sampler;
use tabray_core::world::sensor::Adaptive;

/// About how many rays all choices take of a pixel that is measured alone, with the probes around it.
pub(super) const RAYS: u32 = 120;

/// The measured cost and colours of a choice.
pub(super) struct MeasuredChoice {
    /// The least and the greatest number of samples.
    pub limits: [u32; 2],
    /// The colours of the pixels as they are shown.
    pub colours: Vec<Rgb>,
    /// The mean number of rays from the viewer for a pixel: its samples, and its part of the probes.
    pub rays: f64,
    /// The CPU time of its packets.
    pub timing: Timing,
}

/// Measures the choices whose greatest number of samples is at most `most`. The rays are those of the first pixels, so many of
/// which are spread over the image.
pub(super) fn measure(
    model: &Model,
    threads: &Renderer,
    (pixels, spread): (&[[usize; 2]], usize),
    most: u32,
) -> Vec<MeasuredChoice> {
    let mut plan = plan(model);
    let choices = ADAPTIVE.into_iter().filter(|[_, own]| *own <= most);
    choices
        .map(|limits| {
            set(&mut plan, limits);
            let (mut all, samples) = colours(threads, &plan, &pixels[..spread]);
            all.extend(colours(threads, &plan, &pixels[spread..]).0);
            let timing = Timing::begun(&plan, threads, None);
            // Tiles differ in their samples, and there are fewer of them than pixels.
            MeasuredChoice { limits, colours: all, rays: samples + timing.probes(), timing }
        })
        .collect()
}

/// Times a choice as exactly as is useful.
pub(super) fn refine(model: &Model, threads: &Renderer, limits: [u32; 2], timing: &mut Timing) {
    let mut plan = plan(model);
    set(&mut plan, limits);
    while timing.refine(&plan, threads, None) {}
}

pub(super) fn plan(model: &Model) -> Plan<'_> {
    let mut plan = Plan::new(model);
    plan.camera.sampler = Sampler::Sobol;
    plan
}

/// Lets pixels take these numbers of samples.
pub(super) fn set(plan: &mut Plan, [least, most]: [u32; 2]) {
    plan.camera.samples = least;
    plan.set_adaptive(Some(Adaptive { most, error: None }));
}

/// Counts samples.
#[derive(Default)]
struct Samples(u64);

impl TraceObserver for Samples {
    const SEES: bool = false;

    fn count(&mut self, count: Count) {
        if let Count::Sampled(samples) = count {
            self.0 += u64::from(samples);
        }
    }
}

/// Returns the colours of pixels and the mean of their numbers of samples.
pub(super) fn colours(threads: &Renderer, plan: &Plan, pixels: &[[usize; 2]]) -> (Vec<Rgb>, f64) {
    // Pixels that lie far apart share no probes.
    let part = |range: Range<usize>| -> Vec<_> {
        let mut scratch = Scratch::default();
        let one = |pixel: &[usize; 2]| {
            let mut samples = Samples::default();
            let mut observer = DynObserver::<false>(&mut samples);
            let mut tracer = Tracer::new(plan, Cpu::best(), &mut scratch, &mut observer);
            let colour = plan.camera.display().shown(tracer.pixels(&[*pixel]).get(0));
            (colour, samples.0)
        };
        pixels[range].iter().map(one).collect()
    };
    let all = threads.run(|| parallel::map_ranges(pixels.len(), 8, &part));
    let samples = all.iter().map(|(_, samples)| *samples).sum::<u64>() as f64;
    (all.iter().map(|(colour, _)| *colour).collect(), samples / pixels.len().max(1) as f64)
}
