//! Pixels that take more samples where their colour is less certain.
//!
//! A pixel first takes [`Sensor::samples`] samples, and then twice as many again and again, by the sampler's sequence,
//! until [`Estimate::error`] is small enough. That depends on the pixel's own samples and on probes at the corners of
//! the pixel and of the eight around it, and therefore not on tiles, threads, or the part of the image that is
//! rendered. A pixel that ends with N samples has the colour that it has in an image of N samples per pixel.
//!
//! Probes add nothing to colours. They go through points that no sample goes through: a straight edge that crosses a
//! pixel separates its corners, and a shadow edge that crosses a light separates points of the light's rim, to which
//! the probes' rays go.
//!
//! Where the camera has alpha, what is [clear](super::alpha) counts as a channel of its own.
//!
//! [`Sensor::samples`]: tabray_world::sensor::Sensor::samples

use super::arrays::VectorList;
use super::context::{PrimaryScratch, Scratch, Tracer};
use super::estimate::{AdaptiveScratch, Estimate, RayResults, RaySummary, SampleRun};
use super::path_hash::PathHashes;
use super::ray_group::RayGroup;
use super::{is_measured, sampled};
use crate::features::FEATURE_SAMPLES;
use crate::observer::Count;
use std::mem::take;
use std::ops::Range;
use tabray_world::display::Display;
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::sample;
use tabray_world::sensor::Adaptive;

/// The error of a pixel as a multiple of its estimate, if the error is limited.
const CONFIDENCE: f64 = 2.0;

/// The factor of the standard error of a pixel's mean, if its error is limited, per unit of [`CONFIDENCE`]: few
/// blocks of samples tell little about rare colours.
const DOUBT: f64 = 1.5;

/// If no error is limited, the estimated error, where 1 is white, up to which one sample is enough. It grows with the
/// square root of the number of samples: so samples go where each lowers the mean square error of the image most.
const BALANCED: f64 = 0.25 / 255.0;

/// The least number of samples of a pixel that an edge crosses, even if all its samples and probes have one colour.
const CROSSED_SAMPLES: u32 = 16;

/// The number of corners of a pixel and of the eight around it, along each axis.
const AROUND: usize = 4;

/// Returns the number of the point on the rim of lights to which the probe at a corner goes: one of 16, all of which
/// are around each pixel. The points of the four corners of a pixel are in different quarters.
fn rim_point(column: usize, row: usize) -> u32 {
    let quarter = |column: usize, row: usize| (2 * (row & 1) + ((row + column) & 1)) as u32;
    4 * quarter(column, row) + quarter(column >> 1, row >> 1)
}

/// Returns the estimated error at which a pixel takes no more samples, where 1 is white.
fn most_error(adaptive: Adaptive, samples: u32) -> f64 {
    match adaptive.error {
        Some(error) => error / CONFIDENCE,
        None => BALANCED * f64::from(samples).sqrt(),
    }
}

impl Tracer<'_, '_> {
    /// Tells whether areas, a sun or a sky light the scene.
    fn is_light_spread_out(&self) -> bool {
        let lights = &self.model.lights;
        self.plan.needs.lights.iter().any(|index| lights[*index].value.emitter().is_some())
    }

    /// Computes the colours of pixels, given by column and row, each with as many samples as it needs.
    pub(super) fn adaptive_pixels(
        &mut self,
        pixels: &[[usize; 2]],
        adaptive: Adaptive,
        primary: &mut PrimaryScratch,
    ) {
        let PrimaryScratch { group, seen, colours, alpha, adaptive: scratch } = primary;
        let mut colours = colours.resized(pixels.len());
        let AdaptiveScratch { probes, grids, estimates, clear, active, runs } = scratch;
        let (camera, features) = (&self.plan.camera, self.plan.features.as_ref());
        let has_features = features.is_some_and(|features| features.count() != Some(0));
        let is_unbounded = sampled::is_unbounded(self.plan);
        // Tells whether a pixel goes on after a number of samples, whatever their colours are.
        let is_short = |estimate: &Estimate, pixel: &[usize; 2], count: u32| {
            let has_feature = || features.is_some_and(|all| all.any_at(*pixel, estimate.distance()));
            count < CROSSED_SAMPLES && estimate.has_several_paths()
                || count < FEATURE_SAMPLES && has_feature()
        };
        self.scratch.path_hashes.is_on = true;
        let mut rays = Rays { tracer: self, group, seen, is_unbounded, clear, runs: take(runs) };
        let is_careful = adaptive.error.is_some() && rays.tracer.is_light_spread_out();
        rays.begin(pixels, probes, grids, estimates, is_careful);
        let next_goal = |estimate: &Estimate, pixel: &[usize; 2], mut goal: u32| {
            // If nothing bounds the light, a pixel may end with the first number of samples.
            while !is_unbounded && goal < adaptive.most && is_short(estimate, pixel, goal) {
                goal *= 2;
            }
            goal
        };
        for (estimate, pixel) in estimates.iter_mut().zip(pixels) {
            estimate.set_goal(next_goal(estimate, pixel, camera.samples));
        }
        rays.clear.iter_mut().zip(&*estimates).for_each(|(clear, of)| clear.set_goal(of.goal));
        active.clear();
        active.extend(0..pixels.len() as u32);
        let (display, doubt) = (camera.display(), if adaptive.error.is_some() { DOUBT } else { 1.0 });
        let next_error = |estimate: &mut Estimate, clear: &mut Option<&mut Estimate>| {
            let of_clear = |clear: &mut &mut Estimate| clear.next_error(&Display::LINEAR, doubt);
            estimate.next_error(&display, doubt).max(clear.as_mut().map_or(0.0, of_clear))
        };
        while !active.is_empty() {
            // The objects that a pixel's rays have met matter only while all rays have met the same ones, or for small
            // objects.
            for has_several_paths in [false, true] {
                rays.tracer.scratch.path_hashes.is_on = has_features || !has_several_paths;
                rays.take_samples(active, pixels, has_several_paths, estimates);
            }
            active.retain(|of| {
                let (estimate, pixel) = (&mut estimates[*of as usize], &pixels[*of as usize]);
                let mut clear = rays.clear.get_mut(*of as usize);
                let goal = estimate.goal;
                // More samples do not help a pixel that is off by an unknown amount.
                let goes_on = goal < adaptive.most
                    && estimate.missing != f64::INFINITY
                    && (is_short(estimate, pixel, goal)
                        || next_error(estimate, &mut clear) > most_error(adaptive, goal));
                if goes_on {
                    estimate.set_goal(next_goal(estimate, pixel, 2 * goal));
                    clear.into_iter().for_each(|clear| clear.set_goal(estimate.goal));
                }
                goes_on
            });
        }
        *runs = rays.runs;
        alpha.extend(rays.clear.iter().map(|clear| 1.0 - clear.colour().x));
        self.scratch.path_hashes.is_on = false;
        for (pixel, estimate) in estimates.iter().enumerate() {
            colours.set(pixel, estimate.colour());
            self.cut(estimate.missing / f64::from(estimate.count));
            self.observer.count(Count::Sampled(estimate.count));
            if estimate.count > 1 && is_measured(pixels[pixel]) {
                self.report_noise(&display, estimate.halves(), [estimate.count as usize / 2; 2]);
            }
        }
    }
}

/// A buffer that collects samples until they fill a packet.
struct Rays<'r, 'm, 'w> {
    tracer: &'r mut Tracer<'m, 'w>,
    group: &'r mut RayGroup,
    seen: &'r mut VectorList,
    /// Whether nothing bounds the light that rays may return.
    is_unbounded: bool,
    /// The estimates of what is clear of pixels; empty where the camera has no alpha.
    clear: &'r mut Vec<Estimate>,
    /// The samples that wait.
    runs: Vec<SampleRun>,
}

impl Rays<'_, '_, '_> {
    /// Takes the probes at the corners of pixels and of those around them, and starts the pixels' estimates.
    fn begin(
        &mut self,
        pixels: &[[usize; 2]],
        probes: &mut Vec<[usize; 2]>,
        grids: &mut [Vec<RaySummary>; 2],
        estimates: &mut Vec<Estimate>,
        is_careful: bool,
    ) {
        let [left, low] = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis]).min().unwrap_or(0));
        let [right, high] = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis]).max().unwrap_or(0));
        // Corners are counted from one pixel below and to the left of the image, where only probes look.
        let wide = right - left + AROUND;
        let place = |[x, y]: [usize; 2]| (y - low) * wide + x - left;
        let count = wide * (high - low + AROUND);
        let has_alpha = self.tracer.plan.camera.alpha;
        let grids = &mut grids[..if has_alpha { 2 } else { 1 }];
        for grid in grids.iter_mut() {
            grid.clear();
            grid.resize(count, RaySummary::default());
        }
        probes.clear();
        let mut is_wanted = vec![false; count];
        for [x, y] in pixels {
            (*y..y + AROUND).for_each(|y| is_wanted[place([*x, y])..][..AROUND].fill(true));
        }
        // In rows, so that neighbours are traced together however the pixels are ordered.
        for (index, _) in is_wanted.iter().enumerate().filter(|(_, is_wanted)| **is_wanted) {
            probes.push([index % wide + left, index / wide + low]);
        }
        for corners in probes.chunks(PACKET_SIZE) {
            self.probe(corners, |channel, corner, found| grids[channel][place(corner)] = found);
        }
        // Each place first includes the results of the next place, and then the results collected two places on. So it
        // has the results of four places in a row, and after the same steps by rows, of four rows.
        for grid in grids.iter_mut() {
            for step in [1, 2, wide, 2 * wide] {
                for from in 0..grid.len() - step {
                    let next = grid[from + step];
                    grid[from].include(&next);
                }
            }
        }
        estimates.resize(pixels.len(), Estimate::default());
        let least = self.tracer.plan.camera.samples;
        for (estimate, pixel) in estimates.iter_mut().zip(pixels) {
            estimate.begin(grids[0][place(*pixel)], least, is_careful);
        }
        self.clear.resize(if has_alpha { pixels.len() } else { 0 }, Estimate::default());
        for (clear, pixel) in self.clear.iter_mut().zip(pixels) {
            clear.begin(grids[1][place(*pixel)], least, is_careful);
        }
    }

    /// Traces probes at corners, and reports the results of each: 0 with its colour and, where the camera has alpha, 1 with
    /// what is clear.
    fn probe(&mut self, corners: &[[usize; 2]], mut report: impl FnMut(usize, [usize; 2], RaySummary)) {
        let Self { tracer, group, seen, is_unbounded, .. } = self;
        let (len, camera) = (corners.len(), &tracer.plan.camera);
        let Scratch { places: [x, y], samples, are_probes, .. } = &mut *tracer.scratch;
        samples.begin(camera.sampler);
        for (lane, [column, row]) in corners.iter().enumerate() {
            (x[lane], y[lane]) = (*column as f64 - 1.5, *row as f64 - 1.5);
            samples.extend(rim_point(*column, *row), 0..1);
        }
        *are_probes = true;
        tracer.fill_primary(group, len);
        if *is_unbounded {
            group.ray_budget.fill(sampled::REST);
        }
        tracer.colours(group, seen);
        tracer.scratch.are_probes = false;
        let all = [Some(self.found(0..len)), camera.alpha.then(|| self.found_clear(0..len))];
        for (channel, found) in all.into_iter().flatten().enumerate() {
            let each = corners.iter().enumerate();
            each.for_each(|(lane, corner)| report(channel, *corner, RaySummary::of(&found, lane)));
        }
    }

    /// Returns the results of the rays of some lanes.
    #[inline]
    fn found(&self, lanes: Range<usize>) -> RayResults<'_> {
        let PathHashes { is_on, marks, distances, .. } = &self.tracer.scratch.path_hashes;
        let recorded = if *is_on { lanes.clone() } else { 0..0 };
        RayResults {
            colours: self.seen.view(lanes.end).part(lanes),
            marks: &marks[recorded.clone()],
            distances: &distances[recorded],
        }
    }

    /// Returns what is clear of the rays of some lanes, in place of their colours.
    fn found_clear(&self, lanes: Range<usize>) -> RayResults<'_> {
        let colours = self.tracer.clear(lanes.end).part(lanes.clone());
        RayResults { colours, ..self.found(lanes) }
    }

    /// Traces the samples that active pixels lack, either of the pixels where rays have hit different surfaces, or of
    /// the others.
    fn take_samples(
        &mut self,
        active: &[u32],
        pixels: &[[usize; 2]],
        has_several_paths: bool,
        estimates: &mut [Estimate],
    ) {
        loop {
            let mut lacks_more = false;
            for of in active {
                let estimate = &estimates[*of as usize];
                if estimate.count < estimate.goal && estimate.has_several_paths() == has_several_paths {
                    // The cost that a sample may have depends on the samples before it, if nothing bounds the light.
                    let end = if self.is_unbounded { estimate.count + 1 } else { estimate.goal };
                    let ray_budget = (estimate.missing == f64::INFINITY).then_some(sampled::REST);
                    lacks_more |= end < estimate.goal;
                    self.take_run(*of, pixels[*of as usize], estimate.count..end, ray_budget, estimates);
                }
            }
            self.trace(estimates);
            if !lacks_more {
                return;
            }
        }
    }

    /// Adds samples of a pixel to those that wait, and traces these once there is a packet of them.
    #[inline]
    fn take_run(
        &mut self,
        of: u32,
        pixel: [usize; 2],
        mut samples: Range<u32>,
        ray_budget: Option<u32>,
        estimates: &mut [Estimate],
    ) {
        while !samples.is_empty() {
            let first = self.waiting();
            let count = samples.len().min(PACKET_SIZE - first);
            let middle = samples.start + count as u32;
            let (samples_here, lanes) = (samples.start..middle, first..first + count);
            self.runs.push(SampleRun { of, pixel, samples: samples_here, lanes, ray_budget });
            samples.start = middle;
            if self.waiting() == PACKET_SIZE {
                self.trace(estimates);
            }
        }
    }

    /// Returns the number of samples that wait.
    #[inline]
    fn waiting(&self) -> usize {
        self.runs.last().map_or(0, |run| run.lanes.end)
    }

    /// Traces the samples that wait.
    fn trace(&mut self, estimates: &mut [Estimate]) {
        let len = self.waiting();
        if len == 0 {
            return;
        }
        let Self { tracer, group, seen, runs, .. } = self;
        let camera = &tracer.plan.camera;
        let Scratch { places, samples: drawn, .. } = &mut *tracer.scratch;
        drawn.begin(camera.sampler);
        for SampleRun { pixel: [x, y], samples, .. } in &*runs {
            drawn.extend(camera.seed(*x as i64, *y as i64), samples.clone());
        }
        let [x, y] = &mut *places;
        sample::jitters(tracer.cpu, drawn, &mut x[..len], &mut y[..len]);
        for SampleRun { pixel: [column, row], lanes, .. } in &*runs {
            x[lanes.clone()].iter_mut().for_each(|x| *x += *column as f64);
            y[lanes.clone()].iter_mut().for_each(|y| *y += *row as f64);
        }
        tracer.fill_primary(group, len);
        for SampleRun { lanes, ray_budget, .. } in &*runs {
            if let Some(budget) = ray_budget {
                group.ray_budget[lanes.clone()].fill(*budget);
            }
        }
        tracer.colours(group, seen);
        let mut clear = take(self.clear);
        for SampleRun { of, lanes, .. } in &self.runs {
            let estimate = &mut estimates[*of as usize];
            estimate.add(&self.found(lanes.clone()));
            if let Some(clear) = clear.get_mut(*of as usize) {
                clear.add(&self.found_clear(lanes.clone()));
            }
            if self.tracer.scratch.any_missing {
                // One after the other, so that the sum does not depend on the packets.
                let missing = lanes.clone().map(|lane| self.tracer.missing(lane));
                estimate.missing = missing.fold(estimate.missing, |sum, one| sum + one);
            }
        }
        *self.clear = clear;
        self.runs.clear();
    }
}
