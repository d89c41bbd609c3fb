//! What the searches for the hits of rays cost beyond plain rays.

use super::context::Tracer;
use crate::geometry::ray::Side;
use crate::geometry::ray_packet::RayPacket;
use crate::render::limits::MAX_RAYS;
use crate::render::observer::TraceObserver;

/// The number of rays of a pixel from which on searches are charged: they are made again to be counted.
const UNCOUNTED: u32 = 16;

impl<W: TraceObserver> Tracer<'_, '_, W> {
    /// Charges some of a packet's rays for the searches in shapes where these may take as long as many plain rays.
    ///
    /// All such shapes of the scene count, those too that lie behind a ray's hit or are not needed for the image, so
    /// that the charge depends on the ray alone.
    pub(super) fn charge_searches(
        &self,
        rays: RayPacket,
        left: Option<(usize, &[Side])>,
        lanes: impl Iterator<Item = usize>,
        ray_budget: &mut [u32],
    ) {
        if self.plan.costly.is_empty() {
            return;
        }
        for lane in lanes {
            for index in &self.plan.costly {
                if ray_budget[lane] == 0 || ray_budget[lane] > MAX_RAYS as u32 - UNCOUNTED {
                    break;
                }
                let side = left.filter(|(object, _)| object == index).map(|(_, sides)| sides[lane]);
                let shape = self.model.objects[*index].shape.packets();
                ray_budget[lane] = ray_budget[lane].saturating_sub(shape.search_cost(&rays.get(lane), side));
            }
        }
    }
}
