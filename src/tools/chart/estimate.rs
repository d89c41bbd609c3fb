//! A quick measurement of the effects of accuracy and samples on a scene, to choose from.
//!
//! Errors are measured on pixels that are drawn at random, against more samples, and on all pixels that may show what is
//! smaller than what is between samples; they are given with an upper bound that holds with a stated confidence. Which
//! pixels, and how many, depends on the scene alone unless time runs out.

use super::candidate::Load;
use super::confirm::{self, Known, Plans};
use super::data::{Family, Panel, Point, Subject, WrongHits};
use super::goal::{Estimate, Estimates, Goal, Small};
use super::needed;
use super::places::Draw;
use super::progress::Progress;
use super::right::{Colours, Right};
use super::sampled::{Errors, Image, doubt_of_each};
use super::small::{Missed, SmallThings};
use super::times::Times;
use super::timings::{self, Cost, Timings, plan};
use crate::threads::renderer_with;
use std::io;
use std::mem::take;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::choice::Choice;
use tabray_core::scene::model::Model;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::sensor::Sensor;

/// The numbers of samples to choose from, and the number of samples that they are compared with.
const STAGES: [(&[u32], u32); 2] = [(&[1, 2, 4, 8, 16, 32, 64], 256), (&[128, 256], 1024)];

/// The least ratio of the number of samples of the reference to that of an adaptive choice.
const MORE: u32 = 4;

/// The rays that a measurement may always take, and twice as many for the worst pixels; else it may take this fraction of
/// those of the image that it is about.
const MIN_RAYS: f64 = 1e6;
const PART: f64 = 0.5;

/// The number of samples that an image must need for pixels with different numbers of them to be a choice.
const ADAPTIVE_FROM: u32 = 16;

/// The bounds among which one is looked for while choices are compared, at most.
const COMPARED: usize = 128;

/// The numbers of pixels that are measured before it is asked whether they suffice: at first, and when time runs out.
const FIRST: usize = 1024;
const FEWEST: usize = 128;

/// Measures the scene's own accuracy with several numbers of samples, and the accuracies that are clearly faster. A render begins
/// with work of this CPU time, in seconds.
///
/// # Errors
/// Those of `load`, and those of starting threads; `Interrupted` if `progress` breaks off before enough is known.
pub fn estimates(
    load: Load,
    goal: Goal,
    beginning: f64,
    progress: &mut dyn Progress,
) -> io::Result<Estimates> {
    let threads = renderer_with(0)?;
    let model = load(None)?;
    let own = model.camera.value.accuracy;
    let timings = Timings::new(&model, &threads, beginning);
    let mut study = Study { threads, own, kept: vec![0], timings, goal };
    let mut others = Vec::new();
    // The notes' methods lose hits, and are no choice for a scene that does not ask for them.
    for accuracy in [Accuracy::Exact, Accuracy::Draft] {
        if accuracy != own {
            others.push((accuracy, load(Some(accuracy))?));
        }
    }
    let models: Vec<_> =
        [(own, &model)].into_iter().chain(others.iter().map(|(own, model)| (*own, model))).collect();
    let compared: Vec<_> = others.iter().map(|(_, model)| model).collect();
    let gains = timings::gains(&model, &compared, &study.threads);
    study.kept.extend((1..models.len()).filter(|index| gains[index - 1]));
    // The most exact of the accuracies is the truth.
    let right = if matches!(own, Accuracy::Exact | Accuracy::Strict) { 0 } else { 1 };
    let truth = plan(models[right].1);
    let [width, height] = truth.camera.pixels;
    let is_whole = (width * height) as f64 * f64::from(of_pixel(STAGES[0], study.kept.len())) <= MIN_RAYS;
    let seen = if is_whole { STAGES[0].1 } else { confirm::FEWEST };
    let mut small = match goal {
        Goal::None => SmallThings::none(truth.camera.display()),
        _ => SmallThings::find(&truth, &study.threads, goal.error(), seen),
    };
    small.measure(&truth, &study.threads, goal.error(), progress)?;
    let mut last = None;
    for (samples, against) in STAGES {
        let estimates = study.measure((&models, right), &small, samples, against, progress)?;
        let is_met = match goal {
            Goal::Error { most, .. } => {
                let is_hopeless = estimates.small.missed > most;
                is_hopeless || estimates.all.iter().any(|one| one.bound <= most)
            }
            Goal::None => true,
            Goal::Time { .. } => {
                let met = goal.first_meeting(&estimates.all[..samples.len()]);
                met.is_some_and(|met| met.samples < samples[samples.len() - 1])
            }
        };
        let before = last.replace(estimates);
        if let (Some(before), Some(last)) = (before, &mut last) {
            last.all.extend(before.all);
            last.is_short |= before.is_short;
        }
        if is_met || last.as_ref().is_some_and(|last| last.is_short) {
            break;
        }
    }
    let mut estimates = last.ok_or(io::ErrorKind::Interrupted)?;
    estimates.all.sort_by_key(|one| (one.accuracy != own, one.accuracy.to_string(), one.most, one.samples));
    // A choice that was measured twice counts as it was with more samples.
    estimates.all.dedup_by_key(|one| (one.accuracy, one.most, one.samples));
    Ok(estimates)
}

/// Returns the number of rays that one pixel costs: the samples of each choice, and the true ones.
fn of_pixel((samples, against): (&[u32], u32), accuracies: usize) -> u32 {
    samples.iter().sum::<u32>() * accuracies as u32 + against + needed::RAYS
}

/// Compares accuracies and numbers of samples together, as [`estimates`] measures them.
///
/// # Errors
/// Those of [`estimates`].
pub(super) fn panel(load: Load, progress: &mut dyn Progress) -> io::Result<Panel> {
    let model = load(None)?;
    let Sensor { samples, pixels: [width, height], .. } = model.camera.value;
    let estimates = estimates(load, Goal::None, 0.0, progress)?;
    let all = (width * height) as f64;
    let point = |one: &Estimate| {
        let seconds = one.cost.tracing.mean / all;
        Point {
            name: format!("{} {}", one.accuracy.option().name, one.numbers()),
            family: match (one.accuracy, one.most) {
                (_, Some(_)) => Family::Adaptive,
                (Accuracy::Classic, None) => Family::Notes,
                _ => Family::Own,
            },
            is_default: one.accuracy == estimates.own && one.most.is_none() && one.samples == samples,
            times: Times { least: seconds, median: seconds, rounds: 1, waited: 0.0 },
            error: one.error,
            worst: one.worst,
            wrong: WrongHits::default(),
            visible: None,
            changed: None,
            samples: one.most.unwrap_or(one.samples),
        }
    };
    Ok(Panel {
        title: "the whole image: accuracy and samples together".to_owned(),
        note: format!(
            "{} of {} pixels, against {} samples",
            estimates.all.iter().map(|one| one.pixels).max().unwrap_or(0),
            estimates.pixels,
            estimates.against
        ),
        subject: Subject::Whole,
        points: estimates.all.iter().map(point).collect(),
    })
}

/// The inputs and the state of a measurement.
struct Study {
    threads: Renderer,
    own: Accuracy,
    /// The indices of the scene's own accuracy, which is 0, and of those that are clearly faster.
    kept: Vec<usize>,
    timings: Timings,
    goal: Goal,
}

impl Study {
    /// Measures pixels that take as many samples as they need, with the scene's own accuracy.
    fn needed(
        &mut self,
        (accuracy, model): (Accuracy, &Model),
        pixels: &[[usize; 2]],
        right: &[Right],
        against: u32,
        (all, drawn, missed): (usize, usize, &Missed),
    ) -> Vec<Estimate> {
        let mut measured = needed::measure(model, &self.threads, (pixels, drawn), against / MORE);
        let estimate = |one: &mut needed::MeasuredChoice| {
            let (mut errors, mut small, [samples, most]) = (Errors::new(1), Errors::new(1), one.limits);
            let of_small = one.colours.split_off(drawn);
            errors.add(&[take(&mut one.colours)], &right[..drawn]);
            small.add(&[of_small], &right[drawn..]);
            let image = Image { all, small: &small, missed };
            let [error, bound] = errors.bounds(0, image, self.goal.is_worst(), doubt_of_each(COMPARED));
            let (rays, worst) = (one.rays, errors.worst(0).max(small.worst(0)));
            let cost = self.timings.cost_of(rays, &one.timing);
            let pixels = pixels.len();
            Estimate { accuracy, samples, most: Some(most), rays, cost, error, bound, worst, pixels }
        };
        let mut estimates: Vec<_> = measured.iter_mut().map(estimate).collect();
        let met = self.goal.first_meeting(&estimates).map(|met| met.most);
        for (one, estimate) in measured.iter_mut().zip(&mut estimates) {
            if met == Some(estimate.most) || self.goal.is_none() {
                needed::refine(model, &self.threads, one.limits, &mut one.timing);
                estimate.cost = self.timings.cost_of(one.rays, &one.timing);
            }
        }
        estimates
    }

    /// Times images of an accuracy, by its index: exactly the last one that is estimated to meet a goal of time.
    fn time(
        &mut self,
        index: usize,
        samples: &[u32],
        plan: &mut Plan,
        progress: &mut dyn Progress,
    ) -> io::Result<()> {
        self.timings.measure(index, samples, (plan, &self.threads), progress)?;
        let likely = |samples: &&u32| self.goal.is_likely(&self.timings.cost(index, **samples));
        if let Some(samples) = samples.iter().rfind(likely).copied() {
            let goes_on = |cost: &Cost| self.goal.is_likely(cost) && !progress.is_late();
            self.timings.refine((index, samples), (plan, &self.threads), goes_on);
        }
        Ok(())
    }

    /// Times the choice of an accuracy that meets the goal exactly, or all where there is no goal.
    fn refine(&mut self, index: usize, estimates: &mut [Estimate], plan: &mut Plan, progress: &dyn Progress) {
        let met = self.goal.first_meeting(estimates).map(|met| met.samples);
        for estimate in estimates {
            if met == Some(estimate.samples) || self.goal.is_none() {
                let choice = (index, estimate.samples);
                self.timings.refine(choice, (plan, &self.threads), |_| !progress.is_late());
                estimate.cost = self.timings.cost(index, estimate.samples);
            }
        }
    }

    fn measure(
        &mut self,
        (models, right): (&[(Accuracy, &Model)], usize),
        small: &SmallThings,
        samples: &[u32],
        against: u32,
        progress: &mut dyn Progress,
    ) -> io::Result<Estimates> {
        let goal = self.goal;
        let kept = self.kept.clone();
        let mut plans: Vec<_> = kept.iter().map(|index| plan(models[*index].1)).collect();
        for (index, plan) in kept.iter().zip(&mut plans) {
            self.time(*index, samples, plan, progress)?;
        }
        let mut truth = plan(models[right].1);
        let draw = Draw::new(models[0].1.camera.value.pixels, small.pixels());
        let (all, rest) = (draw.all(), draw.rest());
        // The pixels that may show small things are all measured.
        let mut of_small: Vec<Errors> = vec![Errors::new(samples.len()); kept.len()];
        if small.is_measured() {
            let pixels = small.pixels();
            for (plan, errors) in plans.iter_mut().zip(&mut of_small) {
                let mut colours = Colours { threads: &self.threads, pixels: &pixels, progress };
                let choices = samples.iter().map(|samples| colours.of(plan, *samples));
                errors.add(&choices.collect::<io::Result<Vec<_>>>()?, &small.right());
            }
        }
        let missed = &small.missed();
        let of_pixel = of_pixel((samples, against), kept.len());
        let most = |picture: u32| {
            let least = if goal.is_worst() { 2.0 * MIN_RAYS } else { MIN_RAYS };
            // What is to be confirmed is measured on more pixels later, with fewer samples.
            let part = if confirm::is_for(goal) { 0.0 } else { PART };
            let rays = (part * f64::from(picture) * all as f64).max(least);
            // A small image has fewer pixels than that.
            ((rays / f64::from(of_pixel)) as usize).max(FEWEST).min(rest)
        };
        let mut errors: Vec<Errors> = vec![Errors::new(samples.len()); kept.len()];
        let mut rights = Vec::new();
        let (mut next, mut is_short) = (FIRST, false);
        loop {
            let wanted = next.min(rest);
            if wanted == rest {
                errors.fill(Errors::new(samples.len()));
                rights.clear();
            }
            let pixels = draw.first(wanted);
            progress.more((wanted - errors[0].pixels()) * of_pixel as usize / 10);
            while errors[0].pixels() < wanted && !is_short {
                // Few enough that it is often asked whether time has run out.
                let from = errors[0].pixels();
                let part = &pixels[from..wanted.min(from + FEWEST)];
                let mut colours = Colours { threads: &self.threads, pixels: part, progress };
                let true_ones = colours.right(&mut truth, against / 2)?;
                for (plan, errors) in plans.iter_mut().zip(&mut errors) {
                    let choices = samples.iter().map(|samples| colours.of(plan, *samples));
                    let choices = choices.collect::<io::Result<Vec<_>>>()?;
                    errors.add(&choices, &true_ones);
                }
                rights.extend(true_ones);
                is_short = progress.is_late();
            }
            let measured = errors[0].pixels();
            let timings = &self.timings;
            let estimates =
                kept.iter().zip(errors.iter().zip(&of_small)).flat_map(|(index, (errors, small))| {
                    let image = Image { all, small, missed };
                    let choice = move |(place, samples): (usize, &u32)| {
                        let [error, bound] =
                            errors.bounds(place, image, goal.is_worst(), doubt_of_each(COMPARED));
                        Estimate {
                            accuracy: models[*index].0,
                            samples: *samples,
                            most: None,
                            rays: f64::from(*samples),
                            cost: timings.cost(*index, *samples),
                            error,
                            bound,
                            worst: errors.worst(place).max(small.worst(place)),
                            pixels: measured + missed.pixels.len(),
                        }
                    };
                    samples.iter().enumerate().map(choice)
                });
            let mut estimates: Vec<_> = estimates.collect();
            let is_all = measured == rest;
            let met = match is_all {
                true => goal.first_meeting(&estimates[..samples.len()]),
                false => confirm::likely(goal, &estimates[..samples.len()]),
            };
            let picture = met.map_or(samples[samples.len() - 1], |met| met.samples);
            if is_short || measured >= most(picture) {
                if !is_short && picture >= ADAPTIVE_FROM {
                    let right = [&rights[..], &small.right()].concat();
                    let pixels = [&pixels[..measured], &small.pixels()].concat();
                    let image = (all, measured, missed);
                    estimates.extend(self.needed(models[0], &pixels, &right, against, image));
                    let _ = progress.done(0);
                }
                if !is_short && !is_all {
                    let known = Known { errors: &errors[0], samples, small, missed, draw: &draw };
                    let plans = Plans { threads: &self.threads, model: models[0].1, truth: &mut truth };
                    is_short = confirm::confirm(goal, plans, &known, &mut estimates, progress)?;
                }
                let of_accuracy = estimates[..kept.len() * samples.len()].chunks_mut(samples.len());
                for ((index, plan), estimates) in kept.iter().zip(&mut plans).zip(of_accuracy) {
                    self.refine(*index, estimates, plan, progress);
                }
                let small = Small { pixels: missed.pixels.len(), missed: missed.error(all) };
                return Ok(Estimates {
                    all: estimates,
                    own: self.own,
                    pixels: all,
                    small,
                    against,
                    is_short,
                });
            }
            next = (2 * next).min(most(picture));
        }
    }
}
