//! Planes, and shapes that are a part of one, for packets of rays.

use super::surface::Plane;
use tabray_world::accuracy::{Accuracy, NotClassic};
use tabray_world::geometry::ray_packet::RayPacket;

impl<A: NotClassic> Plane<A> {
    /// Writes the distances of certain hits of a part of the plane, eight rays at a time: a certain hit is in the
    /// plane, regardless of cut-outs. Writes NaN where a distance takes more than plain arithmetic.
    #[inline(always)]
    pub fn refine_each(&self, rays: RayPacket, out: &mut [f64]) {
        match A::ACCURACY {
            // With a normal along an axis, each dot product has one term, and nothing cancels.
            Accuracy::Draft | Accuracy::Exact if self.is_upright => self.refine_plain(rays, out),
            Accuracy::Draft | Accuracy::Exact => self.refine_compensated(rays, out),
            _ => out.fill(f64::NAN),
        }
    }
}
