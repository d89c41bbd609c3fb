//! Pixels that take more samples where their colour is less certain.
//!
//! A pixel first takes [`Camera::samples`] samples, and then twice as many again and again, by the sampler's sequence,
//! until [`Estimate::error`] is small enough. That depends on the pixel's own samples and on the first ones of the eight
//! pixels around it, and so not on tiles, threads, or the part of the image that is rendered. A pixel that ends with N
//! samples has the colour that it has in an image of N samples per pixel.
//!
//! [`Camera::samples`]: crate::world::camera::Camera::samples

use super::arrays::VectorList;
use super::context::Tracer;
use super::estimate::{AdaptiveScratch, Estimate, First, Found, Wanted};
use super::ray_group::RayGroup;
use super::sampled;
use super::scratch::{PrimaryScratch, Scratch};
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::features::FEATURE_SAMPLES;
use crate::render::observer::{Count, TraceObserver};
use crate::world::camera::Adaptive;
use crate::world::sample::{self, Sample};
use std::mem::take;

/// How many estimated errors the error of a pixel may be, where it is limited.
const CONFIDENCE: f64 = 2.0;

/// The estimated error, where 1 is white, up to which one sample would be enough where no error is limited. It grows with
/// the root of the number of samples: so the samples go where each lowers the mean square error of the image most.
const BALANCED: f64 = 0.25 / 255.0;

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
        let AdaptiveScratch { firsts, grid, estimates, active, batch } = scratch;
        self.scratch.trails.is_on = true;
        let mut rays = Rays { tracer: self, group, seen, batch: take(batch) };
        rays.begin(pixels, firsts, grid, estimates);
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
                for index in 1..goal {
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
            active.retain(|of| {
                let (estimate, pixel) = (&mut estimates[*of as usize], pixels[*of as usize]);
                // More samples do not help a pixel that is off by an unknown amount.
                let goes_on = goal < adaptive.most
                    && estimate.missing != f64::INFINITY
                    && (estimate.error(gain) > limit
                        || goal < FEATURE_SAMPLES && rays.is_feature(pixel, estimate.distance));
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
    /// Takes the first samples of pixels and of those around them, and starts the pixels' estimates.
    fn begin(
        &mut self,
        pixels: &[[usize; 2]],
        firsts: &mut Vec<First>,
        grid: &mut Vec<u32>,
        estimates: &mut Vec<Estimate>,
    ) {
        let [left, low] = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis]).min().unwrap_or(0));
        let [right, high] = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis]).max().unwrap_or(0));
        // The grid has a margin of one pixel, which may lie outside of the image: nothing else shows what lies there.
        let wide = right - left + 3;
        let place = |[x, y]: [usize; 2]| (y - low) * wide + x - left;
        // From the place in the grid at the lower left of a pixel.
        let around = |[x, y]: [usize; 2]| (y..y + 3).flat_map(move |y| (x..x + 3).map(move |x| [x, y]));
        grid.clear();
        grid.resize(wide * (high - low + 3), 0);
        firsts.clear();
        for pixel in pixels {
            for pixel in around(*pixel) {
                grid[place(pixel)] = 1;
            }
        }
        // In rows, so that neighbours are traced together however the pixels are ordered.
        for (index, wanted) in grid.iter_mut().enumerate().filter(|(_, wanted)| **wanted != 0) {
            let pixel = [(index % wide + left) as f64 - 1.0, (index / wide + low) as f64 - 1.0];
            firsts.push(First { pixel, found: Found::default() });
            *wanted = firsts.len() as u32;
        }
        for of in 0..firsts.len() {
            let wanted = Wanted { of: of as u32, pixel: firsts[of].pixel, index: 0, ray_budget: None };
            self.want(wanted, &mut |of, found| firsts[of].found = *found);
        }
        self.trace(&mut |of, found| firsts[of].found = *found);
        let first = |pixel| &firsts[grid[place(pixel)] as usize - 1].found;
        estimates.clear();
        estimates.extend(pixels.iter().map(|pixel| {
            let mut estimate = Estimate::new(first(pixel.map(|side| side + 1)));
            around(*pixel).for_each(|other| estimate.compare(first(other)));
            estimate
        }));
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
        group.look(tracer.cpu, camera, tracer.plan.depth.as_ref(), places, len);
        for (budget, wanted) in group.ray_budget.iter_mut().zip(&*batch) {
            *budget = wanted.ray_budget.unwrap_or(*budget);
        }
        tracer.colours(group, seen);
        for (lane, wanted) in batch.iter().enumerate() {
            let trails = &tracer.scratch.trails;
            let (mark, distance) = (trails.marks[lane], trails.distances[lane]);
            let (colour, missing) = (seen.get(lane), tracer.missing(lane));
            found(wanted.of as usize, &Found { colour, missing, mark, distance });
        }
        batch.clear();
    }
}
