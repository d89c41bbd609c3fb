//! Pixels that take more samples where their colour is less certain.
//!
//! A pixel first takes [`Film::samples`] samples, and then twice as many again and again, by the sampler's sequence,
//! until [`Estimate::error`] is small enough. That depends on the pixel's own samples and on probes at the corners of the
//! pixel and of the eight around it, and so not on tiles, threads, or the part of the image that is rendered. A pixel that
//! ends with N samples has the colour that it has in an image of N samples per pixel.
//!
//! Probes add nothing to colours. They are where samples never are: a straight edge that crosses a pixel separates its
//! corners, and the shadow of one that crosses a light separates points of the light's rim, to each of which the rays of
//! some probe go.
//!
//! [`Film::samples`]: crate::world::film::Film::samples

use super::arrays::VectorList;
use super::context::Tracer;
use super::estimate::{AdaptiveScratch, Around, Estimate, Found, Wanted};
use super::ray_group::RayGroup;
use super::sampled;
use super::scratch::{PrimaryScratch, Scratch};
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::features::FEATURE_SAMPLES;
use crate::render::observer::{Count, TraceObserver};
use crate::world::film::Adaptive;
use crate::world::sample::{self, Sample};
use std::mem::take;

/// How many estimated errors the error of a pixel may be, where it is limited.
const CONFIDENCE: f64 = 2.0;

/// How many times its standard error the mean of a pixel's samples may be off, where its error is limited, for each
/// of [`CONFIDENCE`]: few blocks of samples tell little of rare ones.
const DOUBT: f64 = 1.5;

/// The estimated error, where 1 is white, up to which one sample would be enough where no error is limited. It grows with
/// the root of the number of samples: so the samples go where each lowers the mean square error of the image most.
const BALANCED: f64 = 0.25 / 255.0;

/// The number of samples that a pixel takes at least if anything crosses it, even where all that is known has one colour.
const CROSSED_SAMPLES: u32 = 16;

/// The number of corners of a pixel and of those around it, along each axis.
const AROUND: usize = 4;

/// Returns which point of the rim of lights the probe at a corner goes to: one of 16, all of which are around each pixel.
/// Those at the corners of a pixel are in different quarters.
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

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Computes the colours of pixels, given by column and row, each with as many samples as it needs.
    pub(super) fn adaptive_pixels(
        &mut self,
        pixels: &[[usize; 2]],
        adaptive: Adaptive,
        primary: &mut PrimaryScratch,
    ) {
        let PrimaryScratch { group, seen, colours, adaptive: scratch } = primary;
        let mut colours = colours.resized(pixels.len());
        let AdaptiveScratch { probes, grid, estimates, active, batch } = scratch;
        self.scratch.trails.is_on = true;
        let mut rays = Rays { tracer: self, group, seen, batch: take(batch) };
        rays.begin(pixels, probes, grid, estimates);
        active.clear();
        active.extend(0..pixels.len() as u32);
        let mut goal = rays.tracer.plan.camera.samples;
        let gain = rays.tracer.plan.camera.gain();
        let is_unbounded = sampled::is_unbounded(rays.tracer.plan);
        while !active.is_empty() {
            let wanted = |of: u32, index, ray_budget| {
                let pixel = pixels[of as usize].map(|side| side as f64);
                Wanted { of, pixel, index, ray_budget }
            };
            if is_unbounded {
                // What a sample may cost depends on those before it.
                for index in 0..goal {
                    for of in &*active {
                        let Estimate { count, missing, .. } = estimates[*of as usize];
                        if count <= index {
                            let budget = (missing == f64::INFINITY).then_some(sampled::REST);
                            rays.want(wanted(*of, index, budget), &mut |of, found| {
                                estimates[of].add(found, goal);
                            });
                        }
                    }
                    rays.trace(&mut |of, found| estimates[of].add(found, goal));
                }
            } else {
                for of in &*active {
                    for index in estimates[*of as usize].count..goal {
                        rays.want(wanted(*of, index, None), &mut |of, found| {
                            estimates[of].add(found, goal);
                        });
                    }
                }
                rays.trace(&mut |of, found| estimates[of].add(found, goal));
            }
            let limit = most_error(adaptive, goal);
            let doubt = if adaptive.error.is_some() { DOUBT } else { 1.0 };
            active.retain(|of| {
                let (estimate, pixel) = (&mut estimates[*of as usize], pixels[*of as usize]);
                // More samples do not help a pixel that is off by an unknown amount.
                let goes_on = goal < adaptive.most
                    && estimate.missing != f64::INFINITY
                    && (estimate.error(gain, doubt) > limit
                        || goal < CROSSED_SAMPLES && estimate.is_crossed()
                        || goal < FEATURE_SAMPLES && rays.is_feature(pixel, estimate.distance()));
                if goes_on {
                    estimate.join();
                }
                goes_on
            });
            goal *= 2;
        }
        *batch = rays.batch;
        self.scratch.trails.is_on = false;
        for (pixel, estimate) in estimates.iter().enumerate() {
            colours.set(pixel, estimate.colour());
            self.cut(estimate.missing / f64::from(estimate.count));
            self.observer.count(Count::Sampled(estimate.count));
        }
    }
}

/// Collects rays until there is a packet of them.
struct Rays<'r, 'm, 'w, W> {
    tracer: &'r mut Tracer<'m, 'w, W>,
    group: &'r mut RayGroup,
    seen: &'r mut VectorList,
    batch: Vec<Wanted>,
}

impl<W: TraceObserver> Rays<'_, '_, '_, W> {
    /// Takes the probes at the corners of pixels and of those around them, and starts the pixels' estimates.
    fn begin(
        &mut self,
        pixels: &[[usize; 2]],
        probes: &mut Vec<[usize; 2]>,
        grid: &mut Vec<Around>,
        estimates: &mut Vec<Estimate>,
    ) {
        let [left, low] = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis]).min().unwrap_or(0));
        let [right, high] = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis]).max().unwrap_or(0));
        // Corners are counted from one below and to the left of the image: nothing else shows what lies there.
        let wide = right - left + AROUND;
        let place = |[x, y]: [usize; 2]| (y - low) * wide + x - left;
        grid.clear();
        grid.resize(wide * (high - low + AROUND), Around::default());
        probes.clear();
        let mut is_wanted = vec![false; grid.len()];
        for [x, y] in pixels {
            (*y..y + AROUND).for_each(|y| is_wanted[place([*x, y])..][..AROUND].fill(true));
        }
        // In rows, so that neighbours are traced together however the pixels are ordered.
        for (index, _) in is_wanted.iter().enumerate().filter(|(_, is_wanted)| **is_wanted) {
            probes.push([index % wide + left, index / wide + low]);
        }
        for corners in probes.chunks(PACKET_SIZE) {
            self.probe(corners, |corner, found| grid[place(corner)] = Around::from(&found));
        }
        // Each place gets what is found there and at the next, and then what there and at the next two have: so it has
        // what is found at four of a row, and then in four rows.
        for step in [1, 2, wide, 2 * wide] {
            for from in 0..grid.len() - step {
                let next = grid[from + step];
                grid[from].include(&next);
            }
        }
        estimates.clear();
        estimates.extend(pixels.iter().map(|pixel| Estimate::new(grid[place(*pixel)])));
    }

    /// Traces probes at corners, and reports what each found.
    fn probe(&mut self, corners: &[[usize; 2]], mut found: impl FnMut([usize; 2], Found)) {
        let Self { tracer, group, seen, .. } = self;
        let (len, camera) = (corners.len(), &tracer.plan.camera);
        let is_unbounded = sampled::is_unbounded(tracer.plan);
        let Scratch { places: [x, y], samples, are_probes, .. } = &mut *tracer.scratch;
        samples.clear();
        for (lane, [column, row]) in corners.iter().enumerate() {
            (x[lane], y[lane]) = (*column as f64 - 1.5, *row as f64 - 1.5);
            samples.push(Sample { sampler: camera.sampler, index: 0, pixel: rim_point(*column, *row) });
        }
        *are_probes = true;
        tracer.look(group, len);
        if is_unbounded {
            group.ray_budget.fill(sampled::REST);
        }
        tracer.colours(group, seen);
        tracer.scratch.are_probes = false;
        for (lane, corner) in corners.iter().enumerate() {
            found(*corner, self.found(lane));
        }
    }

    /// Returns what the ray of a lane found.
    #[inline]
    fn found(&self, lane: usize) -> Found {
        let trails = &self.tracer.scratch.trails;
        let (mark, distance) = (trails.marks[lane], trails.distances[lane]);
        Found { colour: self.seen.get(lane), missing: self.tracer.missing(lane), mark, distance }
    }

    /// Tells whether the bounds of a small object, no farther than a distance, reach into a pixel.
    fn is_feature(&self, pixel: [usize; 2], distance: f64) -> bool {
        let features = self.tracer.plan.features.as_ref();
        features.is_some_and(|features| features.any_at(pixel, distance))
    }

    /// Adds a ray, and traces the rays once there is a packet of them. `found` is told what each found.
    #[inline]
    fn want(&mut self, wanted: Wanted, found: &mut impl FnMut(usize, &Found)) {
        self.batch.push(wanted);
        if self.batch.len() == PACKET_SIZE {
            self.trace(found);
        }
    }

    /// Traces the rays that wait.
    fn trace(&mut self, found: &mut impl FnMut(usize, &Found)) {
        let Self { tracer, group, seen, batch } = self;
        let (len, camera) = (batch.len(), &tracer.plan.camera);
        if len == 0 {
            return;
        }
        let Scratch { places, samples, .. } = &mut *tracer.scratch;
        let sampler = camera.sampler;
        let sample = |&Wanted { pixel: [x, y], index, .. }: &Wanted| Sample {
            sampler,
            index,
            pixel: camera.seed(x as i64, y as i64),
        };
        samples.clear();
        samples.extend(batch.iter().map(sample));
        let [x, y] = &mut *places;
        sample::jitters(tracer.cpu, samples, &mut x[..len], &mut y[..len]);
        for (lane, wanted) in batch.iter().enumerate() {
            x[lane] += wanted.pixel[0];
            y[lane] += wanted.pixel[1];
        }
        tracer.look(group, len);
        for (budget, wanted) in group.ray_budget.iter_mut().zip(&*batch) {
            *budget = wanted.ray_budget.unwrap_or(*budget);
        }
        tracer.colours(group, seen);
        for lane in 0..len {
            found(self.batch[lane].of as usize, &self.found(lane));
        }
        self.batch.clear();
    }
}
