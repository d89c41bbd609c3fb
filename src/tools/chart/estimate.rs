//! A quick measurement of the effects of accuracy and samples on a scene, to choose from.
//!
//! Errors are measured on pixels that are spread over the image, against more samples of the same sequence, and are given
//! with an upper bound that holds with a stated confidence. Which pixels, and how many, depends on the scene alone unless
//! time runs out.

use super::candidate::Load;
use super::data::{Family, Panel, Point, Subject, WrongHits};
use super::needed;
use super::pictures::{count, render, timed};
use super::places::{Pixels, spread};
use super::progress::Progress;
use super::sampled::{Colours, Errors};
use super::times::Times;
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::scene::choice::Choice;
use crate::scene::model::Model;
use crate::tools::bench::clock;
use crate::world::accuracy::Accuracy;
use crate::world::film::Film;
use crate::world::material::Rgb;
use crate::world::sample::Sampler;
use std::io;
use std::time::Instant;

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

/// The numbers of pixels that are measured before it is asked whether they suffice: at first, and when time runs out.
const FIRST: usize = 1024;
const FEWEST: usize = 128;

/// The number of times that each accuracy is timed, and the samples per pixel that are timed.
const ROUNDS: usize = 5;
const TIMED_SAMPLES: u32 = 4;

/// About how long a round may take, in seconds.
const ROUND: f64 = 0.05;

/// The most that another accuracy than the scene's may take of its time, in each round, to be a choice.
const GAIN: f64 = 0.8;

/// The goal of a choice.
#[derive(Clone, Copy)]
pub enum Goal {
    /// A maximum error.
    Error {
        /// The error, as a fraction of white.
        most: f64,
        /// Whether it is the 99.9th percentile of the pixels' errors, not their root mean square.
        worst: bool,
    },
    /// A maximum time, and the least error within it.
    Time {
        /// The time for the image on all cores, in seconds.
        most: f64,
        /// Whether the error is that of the worst pixels, as for an error.
        worst: bool,
    },
}

/// The cost and the error of an accuracy and a number of samples, with all sources of error together.
#[derive(Clone, Copy)]
pub struct Estimate {
    /// The accuracy.
    pub accuracy: Accuracy,
    /// The number of samples per pixel, from a Sobol sequence; the least where pixels take different ones.
    pub samples: u32,
    /// The greatest number of samples, where pixels take different ones.
    pub most: Option<u32>,
    /// The mean number of rays from the viewer for a pixel: its samples, and where pixels take different numbers, its part
    /// of the probes that decide on them.
    pub rays: f64,
    /// The CPU time of one thread for the whole image, in seconds.
    pub seconds: f64,
    /// The measured error, where 1 is white.
    pub error: f64,
    /// The upper bound of the error of the whole image, with a confidence of 99 %.
    pub bound: f64,
    /// The largest measured error of a pixel, where 1 is white.
    pub worst: f64,
}

/// Estimates, and what they rest on.
pub struct Estimates {
    /// The choices: those of the scene's own accuracy first, by ascending samples; those where pixels take different
    /// numbers follow the others of their accuracy.
    pub all: Vec<Estimate>,
    /// The scene's own accuracy.
    pub own: Accuracy,
    /// The number of pixels that were measured, and of all pixels.
    pub pixels: [usize; 2],
    /// The number of samples per pixel that the choices were compared with.
    pub against: u32,
    /// Whether time ran out, so that fewer pixels were measured than would be.
    pub is_short: bool,
}

impl Goal {
    /// Tells whether an error or a bound is that of the worst pixels.
    fn is_worst(self) -> bool {
        matches!(self, Self::Error { worst: true, .. } | Self::Time { worst: true, .. })
    }

    /// Returns the first choice that meets the goal, among those of one accuracy by ascending samples.
    pub fn first_meeting(self, estimates: &[Estimate], threads: usize) -> Option<&Estimate> {
        match self {
            Self::Error { most, .. } => estimates.iter().find(|one| one.bound <= most),
            Self::Time { most, .. } => estimates.iter().rfind(|one| one.seconds / threads as f64 <= most),
        }
    }
}

/// Measures the scene's own accuracy with several numbers of samples, and the accuracies that are clearly faster.
///
/// # Errors
/// Those of `load`, and those of starting threads; `Interrupted` if `progress` breaks off before enough is known.
pub fn estimates(load: Load, goal: Goal, progress: &mut dyn Progress) -> io::Result<Estimates> {
    let (threads, thread) = (Renderer::new(0)?, Renderer::new(1)?);
    let model = load(None)?;
    let own = model.camera.value.accuracy;
    let mut study = Study { threads, own, seconds: Vec::new(), goal };
    let mut others = Vec::new();
    // The notes' methods lose hits, and are no choice for a scene that does not ask for them.
    for accuracy in [Accuracy::Exact, Accuracy::Draft] {
        if accuracy != own {
            others.push((accuracy, load(Some(accuracy))?));
        }
    }
    let models: Vec<_> =
        [(own, &model)].into_iter().chain(others.iter().map(|(own, model)| (*own, model))).collect();
    study.seconds = times(&thread, &models, progress)?;
    // The most exact of the accuracies is the truth.
    let right = if matches!(own, Accuracy::Exact | Accuracy::Strict) { 0 } else { 1 };
    let mut last = None;
    for (samples, against) in STAGES {
        let estimates = study.measure(&models, right, samples, against, progress)?;
        let is_met =
            goal.first_meeting(&estimates.all[..samples.len()], study.cores()).is_some_and(
                |met| match goal {
                    Goal::Error { .. } => true,
                    Goal::Time { .. } => met.samples < samples[samples.len() - 1],
                },
            );
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
/// Those of [`estimates`].
pub(super) fn panel(load: Load, progress: &mut dyn Progress) -> io::Result<Panel> {
    let model = load(None)?;
    let Film { samples, pixels: [width, height], .. } = model.camera.value;
    // No choice but one without an error meets this, so that all numbers of samples are measured.
    let estimates = estimates(load, Goal::Error { most: 0.0, worst: false }, progress)?;
    let all = (width * height) as f64;
    let point = |one: &Estimate| {
        let seconds = one.seconds / all;
        Point {
            name: format!("{} {}", one.accuracy.option().name, one.numbers()),
            family: match (one.accuracy, one.most) {
                (_, Some(_)) => Family::Adaptive,
                (Accuracy::Classic, None) => Family::Notes,
                _ => Family::Own,
            },
            is_default: one.accuracy == estimates.own && one.most.is_none() && one.samples == samples,
            times: Times { least: seconds, median: seconds, rounds: ROUNDS, waited: 0.0 },
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
            estimates.pixels[0], estimates.pixels[1], estimates.against
        ),
        subject: Subject::Whole,
        points: estimates.all.iter().map(point).collect(),
    })
}

/// The inputs and the state of a measurement.
struct Study {
    threads: Renderer,
    own: Accuracy,
    /// For each accuracy, the times of each round: the CPU times of one thread for the whole image, in seconds, with one
    /// sample and for each of more.
    seconds: Vec<Vec<[f64; 2]>>,
    goal: Goal,
}

impl Study {
    fn cores(&self) -> usize {
        self.threads.run(rayon::current_num_threads)
    }

    /// Returns the time of an image by the accuracy of this index.
    fn time(&self, index: usize, samples: u32) -> f64 {
        let kind = usize::from(samples > 1);
        let least = self.seconds[index].iter().map(|round| round[kind]).fold(f64::INFINITY, f64::min);
        least * f64::from(samples)
    }

    /// Tells whether the accuracy of this index is clearly faster than the scene's own, in every round.
    fn gains(&self, index: usize) -> bool {
        let rounds = self.seconds[index].iter().zip(&self.seconds[0]);
        let mut pairs = rounds.flat_map(|(round, own)| round.iter().zip(own));
        pairs.all(|(time, own)| *time <= GAIN * own)
    }

    /// Measures pixels that take as many samples as they need, with the scene's own accuracy.
    fn needed(
        &self,
        (accuracy, model): (Accuracy, &Model),
        pixels: &Pixels,
        right: &[Rgb],
        against: u32,
        all: usize,
    ) -> Vec<Estimate> {
        let tiles = timed(model.camera.value.pixels, f64::INFINITY);
        let measured = needed::measure(model, &self.threads, pixels, needed::timed(&tiles), against / MORE);
        let estimate = |one: needed::MeasuredChoice| {
            let (mut errors, [samples, most]) = (Errors::new(1), one.limits);
            errors.add(&[one.colours], right);
            let [error, bound] = errors.bounds(0, most, against, all, self.goal.is_worst());
            let (seconds, worst) = (one.seconds * all as f64, errors.worst(0));
            Estimate { accuracy, samples, most: Some(most), rays: one.rays, seconds, error, bound, worst }
        };
        measured.into_iter().map(estimate).collect()
    }

    fn measure(
        &self,
        models: &[(Accuracy, &Model)],
        right: usize,
        samples: &[u32],
        against: u32,
        progress: &mut dyn Progress,
    ) -> io::Result<Estimates> {
        let kept: Vec<_> = (0..models.len()).filter(|index| *index == 0 || self.gains(*index)).collect();
        let plan = |index: usize| {
            let mut plan = Plan::for_picture(models[index].1);
            plan.camera.sampler = Sampler::Sobol;
            plan
        };
        let mut plans: Vec<_> = kept.iter().map(|index| plan(*index)).collect();
        let mut truth = (right != 0).then(|| plan(right));
        let size = models[0].1.camera.value.pixels;
        let all = size[0] * size[1];
        // One pixel costs the samples of each choice, and the true ones.
        let of_pixel = samples.iter().sum::<u32>() * kept.len() as u32 + against + needed::RAYS;
        let most = |picture: u32| {
            let least = if self.goal.is_worst() { 2.0 * MIN_RAYS } else { MIN_RAYS };
            let rays = (PART * f64::from(picture) * all as f64).max(least);
            // A small image has fewer pixels than that.
            ((rays / f64::from(of_pixel)) as usize).max(FEWEST).min(all)
        };
        let mut errors: Vec<Errors> = vec![Errors::new(samples.len()); kept.len()];
        let mut rights = Vec::new();
        let (mut next, mut is_short) = (FIRST, false);
        loop {
            let wanted = next.min(all);
            if wanted == all {
                errors.fill(Errors::new(samples.len()));
                rights.clear();
            }
            let pixels = spread(size, wanted);
            progress.more((wanted - errors[0].pixels()) * of_pixel as usize / 10);
            while errors[0].pixels() < wanted && !is_short {
                // Few enough that it is often asked whether time has run out.
                let from = errors[0].pixels();
                let part: Pixels = pixels[from..wanted.min(from + FEWEST)].to_vec();
                let mut colours = Colours { threads: &self.threads, pixels: &part, progress };
                let true_ones = colours.of(truth.as_mut().unwrap_or(&mut plans[0]), against)?;
                for (plan, errors) in plans.iter_mut().zip(&mut errors) {
                    let choices = samples.iter().map(|samples| colours.of(plan, *samples));
                    let choices = choices.collect::<io::Result<Vec<_>>>()?;
                    errors.add(&choices, &true_ones);
                }
                rights.extend(true_ones);
                is_short = progress.is_late();
            }
            let measured = errors[0].pixels();
            let estimates = kept.iter().zip(&errors).flat_map(|(index, errors)| {
                let choice = move |(place, samples): (usize, &u32)| {
                    let [error, bound] = errors.bounds(place, *samples, against, all, self.goal.is_worst());
                    Estimate {
                        accuracy: models[*index].0,
                        samples: *samples,
                        most: None,
                        rays: f64::from(*samples),
                        seconds: self.time(*index, *samples),
                        error,
                        bound,
                        worst: errors.worst(place),
                    }
                };
                samples.iter().enumerate().map(choice)
            });
            let mut estimates: Vec<_> = estimates.collect();
            let met = self.goal.first_meeting(&estimates[..samples.len()], self.cores());
            let picture = met.map_or(samples[samples.len() - 1], |met| met.samples);
            if is_short || measured >= most(picture) {
                if !is_short && picture >= ADAPTIVE_FROM {
                    let pixels: Pixels = pixels[..measured].to_vec();
                    estimates.extend(self.needed(models[0], &pixels, &rights, against, all));
                    let _ = progress.done(0);
                }
                let pixels = [measured, all];
                return Ok(Estimates { all: estimates, own: self.own, pixels, against, is_short });
            }
            next = (2 * next).min(most(picture));
        }
    }
}

impl Estimate {
    /// Returns the number of samples, as `--samples` takes it.
    pub fn numbers(&self) -> String {
        match self.most {
            Some(most) => format!("{}..{most}", self.samples),
            None => self.samples.to_string(),
        }
    }
}

/// Times each accuracy on some tiles, in turns.
fn times(
    thread: &Renderer,
    models: &[(Accuracy, &Model)],
    progress: &mut dyn Progress,
) -> io::Result<Vec<Vec<[f64; 2]>>> {
    let mut plans: Vec<_> = models.iter().map(|(_, model)| Plan::for_picture(model)).collect();
    let size = plans[0].camera.pixels;
    let mut tiles = timed(size, f64::INFINITY);
    // The first tile warms up the caches and tells how many of them are enough.
    let first = Instant::now();
    thread.run(|| render(&plans[0], &tiles[..1]));
    let of_round = (1.0 + f64::from(TIMED_SAMPLES)) * plans.len() as f64 * first.elapsed().as_secs_f64();
    tiles.truncate(((ROUND / of_round) as usize).max(1));
    let mut times = vec![Vec::new(); plans.len()];
    for round in 0..ROUNDS {
        for (plan, times) in plans.iter_mut().zip(&mut times) {
            plan.camera.sampler = Sampler::Sobol;
            let scale = (size[0] * size[1]) as f64 / count(&tiles) as f64;
            let own = [1, TIMED_SAMPLES].map(|samples| {
                plan.camera.samples = samples;
                thread.run(|| {
                    let start = clock::now();
                    render(plan, &tiles);
                    scale * (clock::now() - start).as_secs_f64() / f64::from(samples)
                })
            });
            times.push(own);
            if progress.done(0).is_break() {
                return Err(io::ErrorKind::Interrupted.into());
            }
        }
        if progress.is_late() || round > 0 && first.elapsed().as_secs_f64() > ROUNDS as f64 * ROUND {
            break;
        }
    }
    Ok(times)
}
