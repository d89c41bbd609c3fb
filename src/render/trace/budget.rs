//! Ray budgets: the costs of searches beyond plain rays, and bounds on the light that is missing where a budget is
//! used up or a path is too long.

use super::arrays::resized;
use super::context::Tracer;
use super::light;
use super::ray_group::{HitRecord, RayGroup};
use super::surface::Surface;
use crate::limits::{KEPT_DEPTH, KEPT_PART, MAX_RAYS};
use crate::observer::{Count, RayKind};
use crate::plan::CostlyObjects;
use crate::plan::depth::Branch;
use tabray_world::geometry::ray::Side;
use tabray_world::geometry::ray_packet::{PACKET_SIZE, RayPacket};
use tabray_world::material::Rgb;
use tabray_world::rules;

impl Tracer<'_, '_> {
    /// Starts primary rays with these ray budgets. They lack no light yet.
    pub(super) fn begin_missing(&mut self, budgets: &[u32]) {
        resized(&mut self.scratch.missing, budgets.len());
        if self.plan.depth.is_some() {
            self.scratch.kept.clear();
            self.scratch.kept.extend(budgets.iter().map(|budget| budget / KEPT_PART));
        }
        self.scratch.any_missing = false;
    }

    /// Keeps a part of the primary rays' budgets for the first reflections, which are traced after all rays transmitted
    /// at the same point. That does not change a ray that never uses up its budget.
    pub(super) fn keep_first_reflections(&mut self, group: &mut RayGroup) {
        if self.depth >= KEPT_DEPTH || self.plan.depth.is_none() {
            return;
        }
        for (budget, camera) in group.ray_budget[..group.len].iter_mut().zip(&group.camera) {
            *budget = (*budget).max(self.scratch.kept[usize::from(*camera)]);
        }
    }

    /// Returns a bound on the light that a primary ray lacks, in any channel.
    pub(super) fn missing(&self, camera: usize) -> f64 {
        if self.scratch.any_missing { self.scratch.missing[camera] } else { 0.0 }
    }

    /// Adds the light of rays that are not traced because their budget is used up.
    #[cold]
    pub(super) fn miss_beyond(&mut self, group: &RayGroup, hits: &HitRecord) {
        let Some(depth) = &self.plan.depth else { return };
        let beyond = depth.beyond(group.origin_object);
        for lane in (0..group.len).filter(|lane| hits.far[*lane] == 0.0) {
            self.miss(group, lane, beyond / group.travelled[lane]);
        }
    }

    /// Adds the direct light at the hits of rays whose budget is used up, since some of their shadow rays may not have
    /// been cast.
    pub(super) fn miss_shadows(&mut self, group: &RayGroup, surface: &Surface) {
        let Some(depth) = &self.plan.depth else { return };
        if light::fewest(self.cpu, &group.ray_budget[..group.len]) != 0 {
            return;
        }
        let own = depth.objects[surface.index].own;
        for lane in (0..group.len).filter(|lane| group.ray_budget[*lane] == 0) {
            self.miss(group, lane, own / surface.travelled[lane]);
        }
    }

    /// Notes that the bounds of a primary ray's colour are this many levels apart, as the image shows it.
    pub(super) fn miss_levels(&mut self, camera: usize, levels: f64) {
        if !self.scratch.any_missing {
            self.scratch.missing.fill(0.0);
        }
        self.scratch.missing[camera] += levels / 255.0;
        self.scratch.any_missing = true;
    }

    /// Notes the primary rays with paths that end at a surface because they are too long under the notes' rules, not
    /// because they could add too little.
    pub(super) fn end_far(
        &mut self,
        group: &RayGroup,
        surface: &Surface,
        continue_mask: &[u64],
        kind: RayKind,
        branch: &Branch,
    ) {
        let travelled = &surface.travelled[..group.padded()];
        let is_far = |lane: &usize| continue_mask[*lane] == 0 && rules::path_left(travelled[*lane]) < 0.0;
        if self.depth >= self.plan.max_depth || !(0..group.len).any(|lane| is_far(&lane)) {
            return;
        }
        let mut ends = vec![1; group.padded()];
        group.cull_faint(self.cpu, branch, travelled, &mut ends);
        let mirrors = |lane: usize| surface.look.is_some() || surface.specular.get(lane) != Rgb::ZERO;
        let matters = |lane: &usize| ends[*lane] != 0 && (kind == RayKind::Transmitted || mirrors(*lane));
        for lane in (0..group.len).filter(is_far).filter(matters) {
            let far = &mut self.scratch.far;
            far.resize(PACKET_SIZE, false);
            far[usize::from(group.camera[lane])] = true;
        }
    }

    /// Counts the primary rays with a path that was too long.
    pub(super) fn count_far(&mut self) {
        if !self.scratch.far.is_empty() {
            let count = self.scratch.far.iter().filter(|is_far| **is_far).count();
            self.observer.count(Count::Far(count));
            self.scratch.far.clear();
        }
    }

    /// Adds an amount of light at the end of a ray, weighted by its path, to the light that its primary ray lacks.
    fn miss(&mut self, group: &RayGroup, lane: usize, light: f64) {
        if !self.scratch.any_missing {
            self.scratch.missing.fill(0.0);
        }
        let missing = &mut self.scratch.missing[usize::from(group.camera[lane])];
        let more = group.path_weight.map_or(f64::INFINITY, |path_weight| path_weight.weight * light);
        // A NaN bounds nothing.
        *missing = if more >= 0.0 { *missing + more } else { f64::INFINITY };
        self.scratch.any_missing = true;
    }
}

/// The number of rays of a pixel whose searches are not charged if a scene has one costly shape: charging repeats a
/// search in order to count its steps. Several shapes share this number, since a ray may be searched for in all of
/// them.
const UNCOUNTED: u32 = 16;

impl Tracer<'_, '_> {
    /// Charges some of a packet's rays for their searches in costly shapes.
    ///
    /// All costly shapes of the scene count, even those that lie behind a ray's hit or are not needed for the image:
    /// so the charge depends on the ray alone.
    pub(super) fn charge_searches(
        &mut self,
        rays: RayPacket,
        left: Option<(usize, &[Side])>,
        lanes: impl Iterator<Item = usize>,
        ray_budget: &mut [u32],
    ) {
        let Some(CostlyObjects { tree, count }) = &self.plan.costly else { return };
        let counted = 0..=MAX_RAYS as u32 - UNCOUNTED / count;
        for lane in lanes {
            let budget = &mut ray_budget[lane];
            if *budget == 0 || !counted.contains(budget) {
                continue;
            }
            let ray = rays.get(lane);
            tree.closest(self.cpu, &mut self.scratch.stack, &ray, f64::INFINITY, |index, t_max| {
                let side = left.filter(|(object, _)| *object == index).map(|(_, sides)| sides[lane]);
                *budget = budget.saturating_sub(self.model.objects[index].shape.search_cost(&ray, side));
                if *budget == 0 { -1.0 } else { t_max }
            });
        }
    }
}
