//! Pixels with several samples.
//!
//! Where nothing bounds the light that rays may return, a pixel whose first sample uses up its ray budget is off by an
//! unknown amount, whatever its other samples return. They then get a small part of the budget, so that such a pixel
//! costs about as much as one with a single sample.

use super::context::Tracer;
use super::ray_group::RayGroup;
use super::scratch::{PrimaryScratch, Scratch};
use crate::geometry::ray_packet::PACKET_SIZE;
use crate::render::limits::MAX_RAYS;
use crate::render::observer::TraceObserver;
use crate::render::plan::Plan;
use crate::world::material::Rgb;

/// The number of rays that a further sample may cost in a pixel that is off by an unknown amount.
pub(super) const REST: u32 = MAX_RAYS as u32 / 100;

/// Tells whether nothing bounds the light that rays may return.
pub(super) fn is_unbounded(plan: &Plan) -> bool {
    plan.depth.as_ref().is_some_and(|depth| !depth.most.is_finite())
}

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Computes the colours of pixels with several samples as [`pixels`](Self::pixels) does.
    pub(super) fn sampled(&mut self, pixels: &[[usize; 2]], primary: &mut PrimaryScratch) {
        let (camera, depth) = (&self.plan.camera, self.plan.depth.as_ref());
        let samples = camera.samples as usize;
        let firsts = if is_unbounded(self.plan) { self.firsts(pixels, primary) } else { Vec::new() };
        let PrimaryScratch { group, seen, colours } = primary;
        let mut colours = colours.resized(pixels.len());
        let (mut sum, mut missing, mut count) = (Rgb::ZERO, 0.0, 0);
        while count < samples * pixels.len() {
            let len = PACKET_SIZE.min(samples * pixels.len() - count);
            let Scratch { places: [x, y], samples: drawn, .. } = &mut *self.scratch;
            camera.scatter(self.cpu, pixels, count..count + len, drawn, [&mut x[..len], &mut y[..len]]);
            let is_first = |at: usize| !firsts.is_empty() && at % samples == 0;
            let mut lanes = 0;
            for lane in (0..len).filter(|lane| !is_first(count + lane)) {
                (x[lanes], y[lanes], drawn[lanes]) = (x[lane], y[lane], drawn[lane]);
                lanes += 1;
            }
            drawn.truncate(lanes);
            if lanes > 0 {
                group.look(self.cpu, camera, depth, &mut self.scratch.places, lanes);
                let budgets = group.ray_budget.iter_mut();
                let rest = (count..count + len).filter(|at| !is_first(*at));
                for (budget, at) in budgets.zip(rest).filter(|_| !firsts.is_empty()) {
                    *budget = if firsts[at / samples].1 == f64::INFINITY { REST } else { *budget };
                }
                self.colours(group, seen);
            }
            let mut lane = 0;
            for _ in 0..len {
                if is_first(count) {
                    let (colour, lacks) = firsts[count / samples];
                    sum += colour;
                    missing += lacks;
                } else {
                    sum += seen.get(lane);
                    missing += self.missing(lane);
                    lane += 1;
                }
                count += 1;
                if count % samples == 0 {
                    colours.set(count / samples - 1, sum / f64::from(camera.samples));
                    self.cut(missing / f64::from(camera.samples));
                    (sum, missing) = (Rgb::ZERO, 0.0);
                }
            }
        }
    }

    /// Computes the colour of each pixel's first sample, and a bound on the light that it lacks.
    fn firsts(&mut self, pixels: &[[usize; 2]], primary: &mut PrimaryScratch) -> Vec<(Rgb, f64)> {
        let (camera, depth) = (&self.plan.camera, self.plan.depth.as_ref());
        let mut firsts = Vec::with_capacity(pixels.len());
        for pixels in pixels.chunks(PACKET_SIZE) {
            let Scratch { places: [x, y], samples: drawn, .. } = &mut *self.scratch;
            drawn.clear();
            for (lane, (place, sample)) in
                pixels.iter().filter_map(|[column, row]| camera.places(*column, *row).next()).enumerate()
            {
                (x[lane], y[lane]) = (place.x, place.y);
                drawn.extend(sample);
            }
            let group: &mut RayGroup = &mut primary.group;
            group.look(self.cpu, camera, depth, &mut self.scratch.places, pixels.len());
            self.colours(group, &mut primary.seen);
            firsts.extend((0..pixels.len()).map(|lane| (primary.seen.get(lane), self.missing(lane))));
        }
        firsts
    }
}
