//! A quick measurement of the effects of accuracy and samples on a scene, for a choice among them.
//!
//! Errors are measured against other samples, on pixels drawn from all strata of the image, and on all pixels that may
//! show things smaller than the gaps between samples, unless these are too many. The pixels depend on the scene alone, and
//! so does their number, unless time runs out.

use super::candidate::Load;
use super::confirm::{self, Known, Plans};
use super::data::{Family, Panel, Point, Subject, WrongHits};
use super::goal::{Estimate, Estimates, Goal, Small};
use super::needed;
use super::progress::Progress;
use super::right::Colours;
use super::sampled::{self, Errors};
use super::small::SmallThings;
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
use tabray_tools::sampling::error::PixelError;
use tabray_tools::sampling::places::Draw;
use tabray_tools::sampling::right::Right;
use tabray_tools::sampling::strata::{Drawn, Strata};
use tabray_tools::threads::renderer_with;

/// A part of a measurement: numbers of samples to choose from.
#[derive(Clone, Copy)]
pub(super) struct Stage {
    samples: &'static [u32],
    /// The number of samples that they are compared with.
    against: u32,
}

pub(super) const STAGES: [Stage; 4] = [
    Stage { samples: &[1, 2, 4, 8, 16, 32, 64], against: 256 },
    Stage { samples: &[128, 256], against: 1024 },
    Stage { samples: &[512, 1024], against: 4096 },
    Stage { samples: &[2048, 4096], against: 8192 },
];

impl Stage {
    /// Returns the number of rays that one pixel costs: the samples of each choice, and the true ones.
    fn rays_of_pixel(self, accuracies: usize) -> u32 {
        self.samples.iter().sum::<u32>() * accuracies as u32 + self.against + needed::RAYS
    }
}

/// The least and the greatest numbers of rays that a stage may take, and the fraction of the image's rays between them.
const RAYS: [f64; 2] = [2e6, 8e6];
const PART: f64 = 0.25;

/// The number of pixels by which others are drawn.
const LOOKED_AT: usize = 1 << 17;

/// The greatest numbers of samples of pixels that may show small things: for what is measured, and for bounds.
const SMALL: [usize; 2] = [1_500_000, 4_000_000];

/// The number of samples that an image must need for pixels with different numbers of them to be a choice.
const ADAPTIVE_FROM: u32 = 16;

/// The number of pixels that are measured before the first check whether they suffice, and before a check of the
/// time.
const FIRST: usize = 1024;
const FEWEST: usize = 128;

/// Measures the scene's own accuracy with several numbers of samples, and the accuracies that are clearly faster. If
/// bounds are to be certain, the choices that are likely to meet the goal get one. A render begins with work of this CPU
/// time, in seconds.
///
/// # Errors
/// Returns the errors of `load` and of starting threads, and `Interrupted` if `progress` breaks off before enough is
/// known.
pub fn estimates(
    load: Load,
    goal: (Goal, bool),
    beginning: f64,
    progress: &mut dyn Progress,
) -> io::Result<Estimates> {
    estimates_by(load, goal, (beginning, 1.0), progress)
}

/// Measures as [`estimates`] does, with this part of the usual work.
fn estimates_by(
    load: Load,
    (goal, is_certain): (Goal, bool),
    (beginning, effort): (f64, f64),
    progress: &mut dyn Progress,
) -> io::Result<Estimates> {
    let part = |usual: usize| (usual as f64 * effort) as usize;
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
    let mut truth = plan(models[right].1);
    let wanted = (goal.error(), is_certain);
    let mut small = SmallThings::find(&truth, &threads, wanted, (confirm::FEWEST, effort), progress)?;
    small.measure(&mut truth, &threads, (goal.error(), part(SMALL[usize::from(is_certain)])), progress)?;
    let found = small.pixels();
    let special = if small.is_measured() { [&found[..], &[]] } else { [&[], &found[..]] };
    let strata = Strata::new(&mut truth, &threads, part(LOOKED_AT), special);
    let mut study = Study { threads, models: &models, right, kept, timings, goal, is_certain, effort };
    let mut last = None;
    for stage in STAGES {
        let estimates = study.measure(stage, (&strata, &small), progress)?;
        let is_met = match goal {
            Goal::Error { most, .. } => {
                let is_hopeless = is_certain && estimates.small.missed > most;
                is_hopeless || estimates.all.iter().any(|one| one.bound <= most)
            }
            Goal::None => true,
            Goal::Time { .. } => {
                let met = goal.first_meeting(&estimates.all[..stage.samples.len()]);
                met.is_none_or(|met| Some(&met.samples) < stage.samples.last())
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

/// Compares accuracies and numbers of samples together, as [`estimates`] measures them with this part of the usual work.
///
/// # Errors
/// Returns the errors of [`estimates`].
pub(super) fn panel(load: Load, effort: f64, progress: &mut dyn Progress) -> io::Result<Panel> {
    let model = load(None)?;
    let Sensor { samples, pixels: [width, height], .. } = model.camera.value;
    let estimates = estimates_by(load, (Goal::None, false), (0.0, effort), progress)?;
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
        title: "the whole image: accuracy and samples".to_owned(),
        note: format!("{most} of {pixels} pixels, against {against} samples"),
        subject: Subject::Whole,
        points: estimates.all.iter().map(point).collect(),
    })
}

/// The pixels that were drawn and measured so far.
struct MeasuredPixels<'m> {
    /// The plan whose colours count as right.
    truth: Plan<'m>,
    /// Their errors for each accuracy, and the place of that of the truth among these.
    errors: Vec<Errors>,
    as_right: Option<usize>,
    rights: Vec<Right>,
    /// Whether time has run out.
    is_short: bool,
}

impl MeasuredPixels<'_> {
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
        for pixels in pixels[self.rights.len()..].chunks(FEWEST) {
            if self.is_short {
                break;
            }
            let mut colours = Colours { threads, pixels, progress };
            let found = colours.right_and_errors(&mut self.truth, against / 2, samples)?;
            let (rights, expected): (Vec<_>, Vec<_>) = found.into_iter().unzip();
            self.add(&mut colours, samples, plans, rights)?;
            // The accuracy of the right colours.
            if let Some(errors) = self.as_right.and_then(|place| self.errors.get_mut(place)) {
                errors.expect(samples, &expected);
            }
            self.is_short = progress.is_late();
        }
        Ok(())
    }

    /// Measures pixels whose right colours are known.
    fn add(
        &mut self,
        colours: &mut Colours,
        samples: &[u32],
        plans: &mut [Plan],
        rights: Vec<Right>,
    ) -> io::Result<()> {
        for (plan, errors) in plans.iter_mut().zip(&mut self.errors) {
            let choices = samples.iter().map(|samples| colours.of(plan, *samples));
            errors.add(&choices.collect::<io::Result<Vec<_>>>()?, &rights);
        }
        self.rights.extend(rights);
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
    is_certain: bool,
    /// The part of the usual work that is done, at most 1.
    effort: f64,
}

impl Study<'_> {
    /// Measures pixels that take as many samples as they need, with the scene's own accuracy.
    fn needed(
        &mut self,
        (accuracy, model): (Accuracy, &Model),
        (drawn, small): (&Drawn, &SmallThings),
        right: &[Right],
        most: u32,
    ) -> Vec<Estimate> {
        let mut measured = needed::measure(model, &self.threads, &drawn.pixels[..right.len()], most);
        let estimate = |one: &mut needed::MeasuredChoice| {
            let (mut errors, [samples, most]) = (Errors::new(1), one.limits);
            errors.add(&[take(&mut one.colours)], right);
            // Tiles differ in their samples, and there are fewer of them than pixels.
            let rays = drawn.mean(one.samples.iter().map(|samples| *samples as f64)) + one.timing.probes();
            let cost = self.timings.cost_of(rays, &one.timing);
            Estimate {
                samples,
                most: Some(most),
                rays,
                cost,
                ..self.estimate(accuracy, (drawn, small), errors.of(0))
            }
        };
        let mut estimates: Vec<_> = measured.iter_mut().map(estimate).collect();
        let met = self.goal.first_meeting(&estimates).map(|met| met.most);
        for (one, estimate) in measured.iter_mut().zip(&mut estimates) {
            if met == Some(estimate.most) || self.goal.is_none() && self.effort == 1.0 {
                needed::refine(model, &self.threads, one.limits, &mut one.timing);
                estimate.cost = self.timings.cost_of(estimate.rays, &one.timing);
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
            if met == Some(estimate.samples) || self.goal.is_none() && self.effort == 1.0 {
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
        (strata, small): (&Strata, &SmallThings),
        progress: &mut dyn Progress,
    ) -> io::Result<Estimates> {
        let (goal, Stage { samples, against }) = (self.goal, stage);
        let mut plans: Vec<_> = self.kept.iter().map(|index| plan(self.models[*index].1)).collect();
        for (index, plan) in self.kept.clone().iter().zip(&mut plans) {
            self.time(*index, samples, plan, progress)?;
        }
        let own = self.models[0];
        let [width, height] = own.1.camera.value.pixels;
        let all = width * height;
        let mut drawn = strata.drawn();
        let mut pixels = MeasuredPixels {
            truth: plan(self.models[self.right].1),
            errors: vec![Errors::new(samples.len()); plans.len()],
            as_right: self.kept.iter().position(|index| *index == self.right),
            rights: Vec::new(),
            is_short: false,
        };
        // The pixels that may show small things are all measured, unless they are too many.
        let alone = drawn.pixels.len();
        let mut colours = Colours { threads: &self.threads, pixels: &drawn.pixels, progress };
        pixels.add(&mut colours, samples, &mut plans, if alone > 0 { small.right() } else { Vec::new() })?;
        let of_pixel = f64::from(stage.rays_of_pixel(plans.len()));
        let most = |picture: u32| {
            let rays = self.effort * (PART * f64::from(picture) * all as f64).clamp(RAYS[0], RAYS[1]);
            (alone + (rays / of_pixel) as usize).min(strata.count())
        };
        // Of a small image, all pixels are measured.
        let mut next = if most(0) == strata.count() { most(0) } else { most(0).min(alone + FIRST) };
        loop {
            let before = drawn.pixels.len();
            drawn.draw(next);
            progress.more((drawn.pixels.len() - before) * of_pixel as usize / 10);
            pixels.measure(&self.threads, stage, &mut plans, &drawn.pixels, progress)?;
            let mut estimates = self.estimates(samples, (&drawn, small), &pixels.errors);
            let fixed = &estimates[..samples.len()];
            let picture = goal.first_meeting(fixed).map_or(samples[samples.len() - 1], |met| met.samples);
            if !pixels.is_short && next < most(picture) && !goal.is_clear(fixed) {
                next = (2 * next).min(most(picture));
                continue;
            }
            if !pixels.is_short && picture >= ADAPTIVE_FROM {
                estimates.extend(self.needed(
                    own,
                    (&drawn, small),
                    &pixels.rights,
                    samples[samples.len() - 1],
                ));
                let _ = progress.done(0);
            }
            let missed = &small.missed();
            if self.is_certain && !self.is_all(pixels.rights.len(), small) {
                // What is measured is not certain.
                estimates.iter_mut().for_each(|one| one.bound = f64::INFINITY);
                let draw = &Draw::new([width, height], small.pixels());
                let known = Known { errors: &pixels.errors[0], samples, small, missed, draw };
                let plans = Plans { threads: &self.threads, model: own.1, truth: &mut pixels.truth };
                pixels.is_short |= confirm::confirm(goal, plans, &known, &mut estimates, progress)?;
            }
            let of_accuracy = estimates[..plans.len() * samples.len()].chunks_mut(samples.len());
            for ((index, plan), estimates) in self.kept.clone().iter().zip(&mut plans).zip(of_accuracy) {
                self.refine(*index, estimates, plan, progress);
            }
            let small = Small {
                pixels: missed.pixels.len(),
                missed: missed.error(all),
                is_left_out: small.is_left_out(),
            };
            let is_short = pixels.is_short;
            return Ok(Estimates { all: estimates, own: own.0, pixels: all, small, against, is_short });
        }
    }

    /// Estimates each number of samples of each accuracy, from the errors of the pixels that were drawn.
    fn estimates(
        &self,
        samples: &[u32],
        (drawn, small): (&Drawn, &SmallThings),
        errors: &[Errors],
    ) -> Vec<Estimate> {
        let of_accuracy = |(index, errors): (&usize, &Errors)| {
            let choice = |(place, samples): (usize, &u32)| Estimate {
                samples: *samples,
                rays: f64::from(*samples),
                cost: self.timings.cost(*index, *samples),
                ..self.estimate(self.models[*index].0, (drawn, small), errors.of(place))
            };
            samples.iter().enumerate().map(choice).collect::<Vec<_>>()
        };
        self.kept.iter().zip(errors).flat_map(of_accuracy).collect()
    }

    /// Tells whether so many measured pixels are all of the image, so that nothing is left to be confirmed.
    fn is_all(&self, pixels: usize, small: &SmallThings) -> bool {
        let [width, height] = self.models[0].1.camera.value.pixels;
        small.is_measured() && pixels == width * height
    }

    /// Estimates the error of a choice; its samples and its cost are yet to be told.
    fn estimate(
        &self,
        accuracy: Accuracy,
        (drawn, small): (&Drawn, &SmallThings),
        errors: &[PixelError],
    ) -> Estimate {
        let error = if self.goal.is_worst() { drawn.percentile(errors) } else { drawn.rms(errors) };
        Estimate {
            accuracy,
            samples: 0,
            most: None,
            rays: 0.0,
            cost: Cost::default(),
            error: error.mean,
            bound: if self.is_certain && self.is_all(errors.len(), small) {
                sampled::bound_of_all(errors, &small.missed(), self.goal.is_worst())
            } else {
                error.most
            },
            worst: errors.iter().map(|error| error.worst).fold(0.0, f64::max),
            pixels: errors.len(),
        }
    }
}
