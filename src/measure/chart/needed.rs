//! Pixels that take as many samples as they need, measured for `choose`.

use super::cost::Timing;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_core::world::material::Rgb;
use tabray_core::world::sample::Sampler;
use tabray_core::world::sensor::Adaptive;
use tabray_tools::sampling::traced;

/// The least and the greatest numbers of samples that are compared.
const ADAPTIVE: [[u32; 2]; 5] = [[4, 16], [4, 64], [4, 256], [16, 1024], [64, 4096]];

/// The approximate number of rays of all choices together for a pixel that is measured alone, with the probes around
/// it.
pub(super) const RAYS: u32 = 120;

/// The measured cost and colours of a choice.
pub(super) struct MeasuredChoice {
    /// The least and the greatest number of samples.
    pub limits: [u32; 2],
    /// The colours of the pixels as they are shown, and their numbers of samples.
    pub colours: Vec<Rgb>,
    pub samples: Vec<u64>,
    /// The CPU time of its packets.
    pub timing: Timing,
}

/// Measures the choices whose greatest number of samples is at most `most`.
pub(super) fn measure(
    model: &Model,
    threads: &Renderer,
    pixels: &[[usize; 2]],
    most: u32,
) -> Vec<MeasuredChoice> {
    let mut plan = plan(model);
    let choices = ADAPTIVE.into_iter().filter(|[_, own]| *own <= most);
    choices
        .map(|limits| {
            set(&mut plan, limits);
            let (colours, samples) = colours(threads, &plan, pixels);
            MeasuredChoice { limits, colours, samples, timing: Timing::begun(&plan, threads, None) }
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

/// Returns the colours of pixels as they are shown, and their numbers of samples.
pub(super) fn colours(threads: &Renderer, plan: &Plan, pixels: &[[usize; 2]]) -> (Vec<Rgb>, Vec<u64>) {
    let display = plan.camera.display();
    let (colours, samples) = traced::apart(threads, plan, pixels);
    (colours.into_iter().map(|colour| display.shown(colour)).collect(), samples)
}
