//! A quick measurement of the effects of accuracy and samples on a scene, to choose from.

use super::candidate::Load;
use super::colours::difference;
use super::pictures::{self, Seen, TRUE_SAMPLES, TRUE_TESTS, count, each, render, tests, timed};
use super::places::{Pixels, spread};
use super::progress::Progress;
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::render::trace;
use crate::scene::choice::Choice;
use crate::tools::bench::clock;
use crate::world::accuracy::Accuracy;
use crate::world::sample::Sampler;
use std::io;
use std::ops::ControlFlow;

/// The numbers of samples to choose from.
const SAMPLES: [u32; 9] = [1, 2, 4, 8, 16, 32, 64, 128, 256];

/// The number of times that each choice is timed; the minimum counts.
const ROUNDS: usize = 3;

/// The work of measuring one choice, in units of [`Progress`].
const UNITS: usize = 100_000;

/// The cost and the error of an accuracy and a number of samples, with all sources of error together.
pub struct Estimate {
    /// The accuracy.
    pub accuracy: Accuracy,
    /// The number of samples per pixel, from a Sobol sequence.
    pub samples: u32,
    /// The CPU time of one thread for the whole image, in seconds.
    pub seconds: f64,
    /// The root of the mean square error of the colours, where 1 is white.
    pub rmse: f64,
}

/// Measures the accuracies, each with several numbers of samples, on a scene.
///
/// # Errors
/// Those of `load`, and those of starting threads; `Interrupted` if `progress` breaks off.
pub fn estimates(load: Load, progress: &mut dyn Progress) -> io::Result<Vec<Estimate>> {
    let (threads, thread) = (Renderer::new(0)?, Renderer::new(1)?);
    let accuracies = Accuracy::all();
    progress.more(TRUE_TESTS / 10 + accuracies.len() * SAMPLES.len() * UNITS);
    let exact = load(Some(Accuracy::Exact))?;
    let exact = Plan::new(&exact);
    let tests = tests(&exact, &threads);
    let size = exact.camera.pixels;
    let max_pixels = (TRUE_TESTS as f64 / 2.0 / (f64::from(TRUE_SAMPLES) * tests)) as usize;
    let pixels = spread(size, max_pixels.clamp(256, 4096));
    let timed = timed(size, tests);
    let scale = (size[0] * size[1]) as f64 / count(&timed) as f64;
    let right = whole(pictures::truth(&exact, &threads, &pixels, Seen::Picture, progress))?;
    let mut estimates = Vec::new();
    for accuracy in accuracies {
        let model = load(Some(accuracy))?;
        let mut plan = Plan::new(&model);
        plan.camera.sampler = Sampler::Sobol;
        for samples in SAMPLES {
            plan.camera.samples = samples;
            let colours = each(&threads, &pixels, |x, y| trace::pixel(&plan, x, y));
            let rmse = difference(&colours, &right).rmse;
            let rounds = (0..ROUNDS).map(|_| time(&thread, &plan, &timed));
            let seconds = scale * rounds.fold(f64::INFINITY, f64::min);
            estimates.push(Estimate { accuracy, samples, seconds, rmse });
            whole(progress.done(UNITS))?;
        }
    }
    Ok(estimates)
}

fn whole<T>(flow: ControlFlow<(), T>) -> io::Result<T> {
    match flow {
        ControlFlow::Continue(value) => Ok(value),
        ControlFlow::Break(()) => Err(io::ErrorKind::Interrupted.into()),
    }
}

/// Returns the CPU time that tiles take on one thread, in seconds.
fn time(thread: &Renderer, plan: &Plan, tiles: &[Pixels]) -> f64 {
    thread.run(|| {
        let start = clock::now();
        render(plan, tiles);
        (clock::now() - start).as_secs_f64()
    })
}
