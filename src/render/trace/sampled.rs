//! Pixels with several samples, where nothing bounds the light that rays may return.
//!
//! A pixel is then off by an unknown amount as soon as one of its samples uses up its ray budget, whatever the others
//! return. So the samples after it get a small part of the budget, and the pixel costs about as much as a pixel with
//! a single sample. If pixels differ in their numbers of samples, such a pixel takes only the first number. The
//! budget of a sample depends on the samples before it, so these are traced first.

use super::context::{PrimaryScratch, Scratch, Tracer};
use crate::limits::MAX_RAYS;
use crate::plan::Plan;
use crate::tiles::TILE;
use tabray_world::geometry::ray_packet::PACKET_SIZE;
use tabray_world::material::Rgb;

/// The number of rays that a sample may cost in a pixel that is off by an unknown amount.
pub(super) const REST: u32 = MAX_RAYS as u32 / 100;

/// Tells whether nothing bounds the light that rays may return.
pub(super) fn is_unbounded(plan: &Plan) -> bool {
    plan.depth.as_ref().is_some_and(|depth| !depth.most.is_finite())
}

/// The number of pixels that measurements trace together where samples are traced one by one: few enough that many
/// samples do not take too long, and enough that a packet takes hardly longer than a part of a larger one.
const SINGLY: usize = 64;

impl Tracer<'_, '_> {
    /// Returns the number of pixels whose rays are traced together: those of a packet, those of several tiles where
    /// pixels differ in their numbers of samples, or `SINGLY` where samples are traced one by one.
    pub fn pixels_together(&self) -> usize {
        let camera = &self.plan.camera;
        match camera.adaptive {
            Some(_) => self.tiles_together() * TILE * TILE,
            None if is_unbounded(self.plan) => SINGLY,
            None => (PACKET_SIZE / camera.samples as usize).max(1),
        }
    }

    /// Computes the colours of pixels sample by sample.
    pub(super) fn one_by_one(&mut self, pixels: &[[usize; 2]], primary: &mut PrimaryScratch) {
        let camera = &self.plan.camera;
        let PrimaryScratch { group, seen, colours, alpha, .. } = primary;
        let mut colours = colours.resized(pixels.len());
        for (pixels, first) in pixels.chunks(PACKET_SIZE).zip((0..).step_by(PACKET_SIZE)) {
            let len = pixels.len();
            let mut sums = vec![(Rgb::ZERO, 0.0); len];
            let mut clear = vec![0.0; if camera.alpha { len } else { 0 }];
            for index in 0..camera.samples {
                let Scratch { places: [x, y], samples: drawn, .. } = &mut *self.scratch;
                camera.scatter_each(self.cpu, pixels, index, drawn, [&mut x[..len], &mut y[..len]]);
                self.fill_primary(group, len);
                for (budget, (_, missing)) in group.ray_budget.iter_mut().zip(&sums) {
                    *budget = if *missing == f64::INFINITY { REST } else { *budget };
                }
                self.colours(group, seen);
                for (lane, (sum, missing)) in sums.iter_mut().enumerate() {
                    *sum += seen.get(lane);
                    *missing += self.missing(lane);
                }
                clear.iter_mut().zip(&self.scratch.clear).for_each(|(sum, one)| *sum += one);
            }
            for (lane, (sum, missing)) in sums.into_iter().enumerate() {
                colours.set(first + lane, sum / f64::from(camera.samples));
                self.cut(missing / f64::from(camera.samples));
            }
            alpha.extend(clear.iter().map(|clear| 1.0 - clear / f64::from(camera.samples)));
        }
    }
}
