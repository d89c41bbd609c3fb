//! A quick measurement of the effects of accuracy and samples on a scene, for a choice among them.
//!
//! Errors are measured against more samples, on pixels drawn at random and on all pixels that may show things smaller
//! than the gaps between samples. They are given with an upper bound that holds with a stated confidence. The choice
//! of the pixels and their number depend on the scene alone, unless time runs out.

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
use std::io;
use std::mem::take;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::scene::choice::Choice;
use tabray_core::scene::model::Model;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::sensor::Sensor;
use tabray_tools::threads::renderer_with;

/// A part of a measurement: numbers of samples to choose from.
#[derive(Clone, Copy)]
struct Stage {
    samples: &'static [u32],
    /// The number of samples that they are compared with.
    against: u32,
}

const STAGES: [Stage; 2] = [
    Stage { samples: &[1, 2, 4, 8, 16, 32, 64], against: 256 },
    Stage { samples: &[128, 256], against: 1024 },
];

impl Stage {
    /// Returns the number of rays that one pixel costs: the samples of each choice, and the true ones.
    fn rays_of_pixel(self, accuracies: usize) -> u32 {
        self.samples.iter().sum::<u32>() * accuracies as u32 + self.against + needed::RAYS
    }
}

/// The least ratio of the number of samples of the reference to that of an adaptive choice.
const MORE: u32 = 4;

/// The number of rays that a measurement may always take, doubled for the worst pixels. Otherwise it may take this
/// fraction of the image's rays.
const MIN_RAYS: f64 = 1e6;
const PART: f64 = 0.5;

/// The number of samples that an image must need for pixels with different numbers of them to be a choice.
const ADAPTIVE_FROM: u32 = 16;

/// The maximum number of bounds from which one is chosen while choices are compared.
const COMPARED: usize = 128;

/// The number of pixels that are measured before the first check whether they suffice, and before a check of the
/// time.
const FIRST: usize = 1024;
const FEWEST: usize = 128;

/// Measures the scene's own accuracy with several numbers of samples, and the accuracies that are clearly faster. A
/// render begins with work of this CPU time, in seconds.
///
/// # Errors
/// Returns the errors of `load` and of starting threads, and `Interrupted` if `progress` breaks off before enough is
/// known.
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
    let gains = timings::gains(&model, &compared, &threads);
    let kept: Vec<_> = (0..models.len()).filter(|index| *index == 0 || gains[index - 1]).collect();
    // The most exact of the accuracies is the truth.
    let right = if matches!(own, Accuracy::Exact | Accuracy::Strict) { 0 } else { 1 };
    let truth = plan(models[right].1);
    let [width, height] = truth.camera.pixels;
    let is_whole = (width * height) as f64 * f64::from(STAGES[0].rays_of_pixel(kept.len())) <= MIN_RAYS;
    let seen = if is_whole { STAGES[0].against } else { confirm::FEWEST };
    let mut small = match goal {
        Goal::None => SmallThings::none(truth.camera.display()),
        _ => SmallThings::find(&truth, &threads, goal.error(), seen),
    };
    small.measure(&truth, &threads, goal.error(), progress)?;
    let mut study = Study { threads, models: &models, right, kept, timings, goal };
    let mut last = None;
    for stage in STAGES {
        let estimates = study.measure(stage, &small, progress)?;
        let is_met = match goal {
            Goal::Error { most, .. } => {
                let is_hopeless = estimates.small.missed > most;
                is_hopeless || estimates.all.iter().any(|one| one.bound <= most)
            }
            Goal::None => true,
            Goal::Time { .. } => {
                let met = goal.first_meeting(&estimates.all[..stage.samples.len()]);
                met.is_some_and(|met| Some(&met.samples) < stage.samples.last())
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

/// Compares accuracies and numbers of samples together, as [`estimates`] measures them.
///
/// # Errors
/// Returns the errors of [`estimates`].
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
    let Estimates { pixels, against, .. } = estimates;
    let most = estimates.all.iter().map(|one| one.pixels).max().unwrap_or(0);
    Ok(Panel {
        title: "the whole image: accuracy and samples together".to_owned(),
        note: format!("{most} of {pixels} pixels, against {against} samples"),
        subject: Subject::Whole,
        points: estimates.all.iter().map(point).collect(),
    })
}

/// The pixels that were drawn and measured so far.
struct DrawnPixels<'m> {
    /// The plan whose colours count as right.
    truth: Plan<'m>,
    /// Their errors for each accuracy.
    errors: Vec<Errors>,
    rights: Vec<Right>,
    /// Whether time has run out.
    is_short: bool,
}

impl DrawnPixels<'_> {
    /// Measures the further ones of these pixels.
    fn measure(
        &mut self,
        threads: &Renderer,
        Stage { samples, against }: Stage,
        plans: &mut [Plan],
        pixels: &[[usize; 2]],
        progress: &mut dyn Progress,
    ) -> io::Result<()> {
        // Few enough that the time is checked often.
        for pixels in pixels[self.errors[0].pixels()..].chunks(FEWEST) {
            if self.is_short {
                break;
            }
            let mut colours = Colours { threads, pixels, progress };
            let rights = colours.right(&mut self.truth, against / 2)?;
            Errors::add_each(&mut self.errors, &mut colours, plans, samples, &rights)?;
            self.rights.extend(rights);
            self.is_short = progress.is_late();
        }
        Ok(())
    }
}

/// The inputs and the state of a measurement.
struct Study<'m> {
    threads: Renderer,
    /// The scene with its own accuracy, and with others.
    models: &'m [(Accuracy, &'m Model)],
    /// The index of the model whose colours count as right.
    right: usize,
    /// The indices of the scene's own accuracy, which is 0, and of those that are clearly faster.
    kept: Vec<usize>,
    timings: Timings,
    goal: Goal,
}

impl Study<'_> {
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

    /// Times images of an accuracy, by its index. The last one that is likely to meet a goal of time is timed
    /// exactly.
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

    /// Measures the choices of a stage, on as many pixels as it takes.
    fn measure(
        &mut self,
        stage: Stage,
        small: &SmallThings,
        progress: &mut dyn Progress,
    ) -> io::Result<Estimates> {
        let (goal, Stage { samples, against }) = (self.goal, stage);
        let mut plans: Vec<_> = self.kept.iter().map(|index| plan(self.models[*index].1)).collect();
        for (index, plan) in self.kept.clone().iter().zip(&mut plans) {
            self.time(*index, samples, plan, progress)?;
        }
        let own = self.models[0];
        let draw = Draw::new(own.1.camera.value.pixels, small.pixels());
        let (all, rest, missed) = (draw.all(), draw.rest(), &small.missed());
        let mut drawn = DrawnPixels {
            truth: plan(self.models[self.right].1),
            errors: vec![Errors::new(samples.len()); plans.len()],
            rights: Vec::new(),
            is_short: false,
        };
        // The pixels that may show small things are all measured.
        let mut of_small = drawn.errors.clone();
        if small.is_measured() {
            let mut colours = Colours { threads: &self.threads, pixels: &small.pixels(), progress };
            Errors::add_each(&mut of_small, &mut colours, &mut plans, samples, &small.right())?;
        }
        let of_pixel = stage.rays_of_pixel(plans.len());
        // A small image has fewer pixels than that.
        let most =
            |picture| ((self.goal_rays(picture, all) / f64::from(of_pixel)) as usize).max(FEWEST).min(rest);
        let mut next = FIRST;
        loop {
            let wanted = next.min(rest);
            if wanted == rest {
                drawn.errors.fill(Errors::new(samples.len()));
                drawn.rights.clear();
            }
            let pixels = draw.first(wanted);
            progress.more((wanted - drawn.errors[0].pixels()) * of_pixel as usize / 10);
            drawn.measure(&self.threads, stage, &mut plans, &pixels, progress)?;
            let measured = drawn.errors[0].pixels();
            let mut estimates = self.estimates(samples, &drawn.errors, &of_small, (all, missed));
            let is_all = measured == rest;
            let met = match is_all {
                true => goal.first_meeting(&estimates[..samples.len()]),
                false => confirm::likely(goal, &estimates[..samples.len()]),
            };
            let picture = met.map_or(samples[samples.len() - 1], |met| met.samples);
            if !drawn.is_short && measured < most(picture) {
                next = (2 * next).min(most(picture));
                continue;
            }
            if !drawn.is_short && picture >= ADAPTIVE_FROM {
                let right = [&drawn.rights[..], &small.right()].concat();
                let pixels = [&pixels[..measured], &small.pixels()].concat();
                estimates.extend(self.needed(own, &pixels, &right, against, (all, measured, missed)));
                let _ = progress.done(0);
            }
            if !drawn.is_short && !is_all {
                let known = Known { errors: &drawn.errors[0], samples, small, missed, draw: &draw };
                let plans = Plans { threads: &self.threads, model: own.1, truth: &mut drawn.truth };
                drawn.is_short = confirm::confirm(goal, plans, &known, &mut estimates, progress)?;
            }
            let of_accuracy = estimates[..plans.len() * samples.len()].chunks_mut(samples.len());
            for ((index, plan), estimates) in self.kept.clone().iter().zip(&mut plans).zip(of_accuracy) {
                self.refine(*index, estimates, plan, progress);
            }
            let small = Small { pixels: missed.pixels.len(), missed: missed.error(all) };
            let is_short = drawn.is_short;
            return Ok(Estimates { all: estimates, own: own.0, pixels: all, small, against, is_short });
        }
    }

    /// Returns the number of rays that a measurement of an image of this many pixels may take, if `samples` of each
    /// pixel meet the goal.
    fn goal_rays(&self, samples: u32, pixels: usize) -> f64 {
        let least = if self.goal.is_worst() { 2.0 * MIN_RAYS } else { MIN_RAYS };
        // A choice that is to be confirmed is measured later, on more pixels and with fewer samples.
        let part = if confirm::is_for(self.goal) { 0.0 } else { PART };
        (part * f64::from(samples) * pixels as f64).max(least)
    }

    /// Estimates each number of samples of each accuracy, from the errors of the pixels that were drawn and of those
    /// that may show small things.
    fn estimates(
        &self,
        samples: &[u32],
        errors: &[Errors],
        of_small: &[Errors],
        (all, missed): (usize, &Missed),
    ) -> Vec<Estimate> {
        let of_accuracy = |(index, (errors, small)): (&usize, (&Errors, &Errors))| {
            let (accuracy, image) = (self.models[*index].0, Image { all, small, missed });
            let choice = |(place, samples): (usize, &u32)| {
                let [error, bound] =
                    errors.bounds(place, image, self.goal.is_worst(), doubt_of_each(COMPARED));
                Estimate {
                    accuracy,
                    samples: *samples,
                    most: None,
                    rays: f64::from(*samples),
                    cost: self.timings.cost(*index, *samples),
                    error,
                    bound,
                    worst: errors.worst(place).max(small.worst(place)),
                    pixels: errors.pixels() + missed.pixels.len(),
                }
            };
            samples.iter().enumerate().map(choice).collect::<Vec<_>>()
        };
        self.kept.iter().zip(errors.iter().zip(of_small)).flat_map(of_accuracy).collect()
    }
}
