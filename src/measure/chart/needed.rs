//! Pixels that take as many samples as they need, measured for `choose`.

use super::cost::Timing;
use super::pictures::ADAPTIVE;
use super::traced;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::Sampler;
use tabray_core::world::sensor::Adaptive;

/// The approximate number of rays of all choices together for a pixel that is measured alone, with the probes around
/// it.
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

/// Measures the choices whose greatest number of samples is at most `most`. The rays are those of the first `spread`
/// pixels, which are spread over the image.
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

/// Sets the least and the greatest number of samples of a pixel.
pub(super) fn set(plan: &mut Plan, [least, most]: [u32; 2]) {
    plan.camera.samples = least;
    plan.set_adaptive(Some(Adaptive { most, error: None }));
}

/// Returns the colours of pixels as they are shown, and the mean of their numbers of samples.
pub(super) fn colours(threads: &Renderer, plan: &Plan, pixels: &[[usize; 2]]) -> (Vec<Rgb>, f64) {
    let display = plan.camera.display();
    let (colours, samples) = traced::apart(threads, plan, pixels);
    let shown = colours.into_iter().map(|colour| display.shown(colour)).collect();
    (shown, samples as f64 / pixels.len().max(1) as f64)
}
