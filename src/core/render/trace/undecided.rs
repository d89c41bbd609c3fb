//! Camera rays whose search ended undecided: 237 bits do not tell whether they hit an object first.

use super::context::Tracer;
use super::hit_record::HitRecord;
use super::one_ray::in_world_units;
use super::ray_group::RayGroup;
use crate::render::observer::{Count, TraceObserver};
use crate::world::certify::Doubt;
use std::mem::take;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Notes the pixels of a packet whose undecided hits lie no farther than what their rays hit for certain. Of a shape
    /// without an equation nothing is decided, and its own distance counts.
    #[cold]
    pub(super) fn note_undecided(&mut self, group: &RayGroup, hits: &HitRecord) {
        let lanes = take(&mut self.scratch.undecided.lanes);
        if !group.looks || self.scratch.are_probes {
            return;
        }
        for (lane, index, from) in lanes {
            let shape = &self.model.objects[index].shape;
            let Some(sight) = self.start(group, lane).sight else { continue };
            if let Some(proven) = shape.proven()
                && shape.is_certified()
                && (hits.met[lane] == index as u64 + 1 || in_world_units(from, &sight) <= hits.far[lane])
            {
                let pixel = self.pixel_of(lane);
                self.scratch.undecided.pixels.push((pixel, index, Doubt::of(proven, &sight, from)));
            }
        }
    }

    /// Returns the number of the pixel of a primary ray.
    fn pixel_of(&self, lane: usize) -> u32 {
        let [x, y] = &self.scratch.places;
        match self.scratch.samples.get(lane) {
            Some(sample) => sample.pixel,
            None => self.plan.camera.seed(x[lane] as i64, y[lane] as i64),
        }
    }

    /// Reports each pixel that has been noted, once.
    #[cold]
    pub(super) fn report_undecided(&mut self) {
        let mut pixels = take(&mut self.scratch.undecided.pixels);
        pixels.sort_unstable();
        pixels.dedup_by_key(|(pixel, ..)| *pixel);
        for (_, object, doubt) in pixels {
            self.observer.count(Count::Undecided(object, doubt));
        }
    }
}
