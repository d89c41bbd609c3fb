//! Confirms the choice that is likely to meet a goal, on enough pixels to be certain.
//!
//! A bound that holds whatever the unmeasured pixels contain needs many measured pixels. Few samples in each suffice,
//! in addition to those of the choice itself, since their noise is as often too high as too low.

use super::estimate::STAGES;
use super::goal::{Estimate, Goal};
use super::needed;
use super::progress::Progress;
use super::right::Colours;
use super::sampled::{Errors, Image, doubt_of_each};
use super::small::{Missed, SmallThings};
use super::timings;
use std::io;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::model::Model;
use tabray_tools::sampling::places::Draw;

/// The part of the greatest error that an estimate must be below to be worth confirming.
const LIKELY: f64 = 0.9;

/// A choice with different numbers of samples is worth taking if its rays are at most this part of those of the fixed
/// choice.
const GAIN: f64 = 0.8;

/// The number of pixels that are measured at once, and the fraction by which their number grows before the bound is
/// computed again.
const AT_ONCE: usize = 4096;
const AGAIN: f64 = 0.5;

/// The numbers of samples of each of the two images that count as right, the part of the greatest mean square that
/// their noise may add to a bound, and the pixels after which a mean that is too large ends a measurement.
const RIGHT: [u32; 4] = [4, 8, 16, 32];
const NOISE: f64 = 0.1;
const HOPELESS: usize = 16_384;

/// The least number of samples of a measured pixel: those that count as right, and one of its own.
pub(super) const FEWEST: u32 = 2 * RIGHT[0] + 1;

/// The maximum number of rays from the viewer in a measurement whose goal is not the error, as a part of the image's.
const PART: f64 = 0.5;

/// The maximum number of choices that are measured in each stage.
const TRIES: usize = 2;

/// Returns the first choice that is likely to meet a goal, among those of one accuracy by ascending samples.
fn likely(goal: Goal, estimates: &[Estimate]) -> Option<&Estimate> {
    match goal {
        Goal::Error { most, .. } => estimates.iter().find(|one| one.error <= LIKELY * most),
        _ => goal.first_meeting(estimates),
    }
}

/// Returns the number of pixels after which the bound is computed again.
fn after(count: usize) -> usize {
    count + (AGAIN * count as f64) as usize
}

/// Returns the maximum number of times that the bound is computed for this many pixels.
fn looks(pixels: usize) -> usize {
    std::iter::successors(Some(AT_ONCE), |count| Some(after(*count)))
        .take_while(|count| *count < pixels)
        .count()
        + 1
}

/// The measurements made before a choice is confirmed.
pub(super) struct Known<'k> {
    /// The errors of the scene's own accuracy on some pixels, for each number of samples.
    pub errors: &'k Errors,
    pub samples: &'k [u32],
    pub small: &'k SmallThings,
    pub missed: &'k Missed,
    /// The other pixels.
    pub draw: &'k Draw,
}

/// The renderer and the plans of a confirmation.
pub(super) struct Plans<'p, 'm> {
    pub threads: &'p Renderer,
    /// The scene, with its own accuracy.
    pub model: &'p Model,
    /// The plan whose colours count as right.
    pub truth: &'p mut Plan<'m>,
}

/// Confirms the estimate that is likely to meet a goal: first the one with different numbers of samples, if it is
/// cheaper. Tells whether time has run out.
pub(super) fn confirm(
    goal: Goal,
    mut plans: Plans,
    known: &Known,
    estimates: &mut [Estimate],
    progress: &mut dyn Progress,
) -> io::Result<bool> {
    let fixed = &estimates[..known.samples.len()];
    let first = likely(goal, fixed).map(|first| (first.rays, first.samples));
    let is_cheaper = |one: &Estimate| first.is_none_or(|(rays, _)| one.rays <= GAIN * rays);
    let adaptive: Vec<_> = estimates.iter().copied().filter(|one| one.most.is_some()).collect();
    let cheaper = likely(goal, &adaptive).filter(|one| is_cheaper(one)).map(|one| one.most);
    let cheaper = cheaper.and_then(|most| estimates.iter().position(|one| one.most == most));
    let fixed = first.map_or(known.samples.len(), |(_, samples)| {
        known.samples.iter().position(|one| *one == samples).unwrap_or(known.samples.len())
    });
    for index in cheaper.into_iter().chain(fixed..known.samples.len()).take(TRIES) {
        let is_late = confirm_one(goal, &mut plans, known, &mut estimates[index], progress)?;
        let is_met = match goal {
            Goal::Error { most, .. } => estimates[index].bound <= most,
            Goal::Time { .. } | Goal::None => true,
        };
        if is_late || is_met {
            return Ok(is_late);
        }
    }
    Ok(false)
}

fn confirm_one(
    goal: Goal,
    plans: &mut Plans,
    known: &Known,
    estimate: &mut Estimate,
    progress: &mut dyn Progress,
) -> io::Result<bool> {
    let (wanted, is_error) = match goal {
        Goal::Error { most, .. } => (most, true),
        Goal::Time { .. } | Goal::None => (estimate.error, false),
    };
    let Known { small, missed, draw, .. } = known;
    let noise = |samples: &u32| {
        let place = known.samples.iter().position(|one| one == samples);
        0.5 * place.map_or(0.0, |place| known.errors.fourth(place))
    };
    let right = RIGHT.into_iter().find(|samples| noise(samples) <= NOISE * wanted * wanted);
    let right = right.unwrap_or(RIGHT[RIGHT.len() - 1]);
    let Plans { threads, model, truth } = plans;
    let threads = *threads;
    let mut plan = if estimate.most.is_some() { needed::plan(model) } else { timings::plan(model) };
    let samples = estimate.samples;
    if let Some(most) = estimate.most {
        needed::set(&mut plan, [samples, most]);
    }
    let is_adaptive = estimate.most.is_some();
    let mut chosen = |pixels: &[[usize; 2]], progress: &mut dyn Progress| {
        if is_adaptive {
            return Ok(needed::colours(threads, &plan, pixels).0);
        }
        Colours { threads, pixels, progress }.of(&mut plan, samples)
    };
    let mut of_small = Errors::new(1);
    if small.is_measured() {
        of_small.add(&[chosen(&small.pixels(), progress)?], &small.right());
    }
    let image = Image { all: draw.all(), small: &of_small, missed };
    let of_pixel = estimate.rays + f64::from(2 * right);
    let most =
        if is_error { draw.rest() } else { (PART * estimate.rays * draw.all() as f64 / of_pixel) as usize };
    // All but one: the samples that count as right are too few for statements about a wholly known image.
    let pixels = draw.first(most.min(draw.rest() - 1));
    let doubt = doubt_of_each(STAGES.len() * TRIES * looks(pixels.len()));
    let (mut errors, mut next) = (Errors::new(1), AT_ONCE);
    for part in pixels.chunks(AT_ONCE) {
        progress.more((part.len() as f64 * of_pixel / 10.0) as usize);
        let colours = chosen(part, progress)?;
        let right = Colours { threads, pixels: part, progress }.right(truth, right)?;
        errors.add(&[colours], &right);
        let count = errors.pixels();
        let (is_late, is_last) = (progress.is_late(), count == pixels.len());
        if count < next && !is_late && !is_last {
            continue;
        }
        next = after(count);
        let [error, bound] = errors.bounds(0, image, goal.is_worst(), doubt);
        if bound < estimate.bound {
            (estimate.error, estimate.bound) = (error, bound);
            estimate.pixels = count + missed.pixels.len();
        }
        let is_hopeless = count >= HOPELESS && error > wanted;
        if is_late || is_error && (bound <= wanted || is_hopeless) {
            return Ok(is_late);
        }
    }
    Ok(false)
}
