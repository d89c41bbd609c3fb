//! What the searches for the hits of rays cost beyond plain rays.

use super::context::Tracer;
use crate::geometry::ray::Side;
use crate::geometry::ray_packet::RayPacket;
use crate::render::limits::MAX_RAYS;
use crate::render::observer::TraceObserver;
use crate::render::plan::CostlyObjects;

/// The number of rays of a pixel from which on searches are charged where a scene has one costly shape, as searches are
/// made again to be counted. Of several shapes, each has its share, since a ray may be searched for in all of them.
const UNCOUNTED: u32 = 16;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Charges some of a packet's rays for the searches in shapes where these may take as long as many plain rays.
    ///
    /// All such shapes of the scene count, those too that lie behind a ray's hit or are not needed for the image, so
    /// that the charge depends on the ray alone.
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
