//! Any shape, whatever it has opted into.

use crate::geometry::ray::{Bracket, Ray, RayRange, Side};
use crate::geometry::ray_packet::{Nearest, RayPacket};
use crate::geometry::sight::Sight;
use crate::simd::cpu::Cpu;
use crate::world::certify::{Enclosure, Precision};
use crate::world::hittable::Hittable;
use crate::world::packets::shape::{PacketShape, Packets, Proofs};
use crate::world::shape::Shape;
use glam::DVec3;
use std::ops::Deref;

/// Any shape, as the objects of a scene have one. What [`Hittable`] says of it can be asked of it.
pub struct AnyShape(Box<dyn PacketShape>);

impl AnyShape {
    /// What packets of rays ask.
    pub(crate) fn packets(&self) -> &dyn PacketShape {
        &*self.0
    }

    /// Between which distances its distance is, as far as that is known quickly.
    pub fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        self.0.t_bounds(ray, range)
    }

    /// The distance of a hit that [`t_bounds`](Self::t_bounds) has found for certain, or NaN where that takes more than
    /// plain arithmetic.
    pub fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.0.refine_one(ray, origin_side)
    }

    /// Whether a point lies on its surface, but for an error of so many world units.
    pub fn touches(&self, at: DVec3, error: f64) -> bool {
        self.0.touches(at, error)
    }

    /// What is certain about the first hit of a ray. Of a shape without an equation nothing is.
    pub fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        self.0.certify(sight, precision)
    }

    /// Compares its hits by a packet's rays with the nearest so far, and tells whether any is in doubt. `sides` are those
    /// of this shape that the rays leave, if they do; `id` is its index in the scene and 1.
    pub fn closest_hits(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        id: u64,
        nearest: Nearest,
    ) -> bool {
        self.0.closest_hits(cpu, rays, sides, id, nearest)
    }
}

impl Deref for AnyShape {
    type Target = dyn Hittable;

    fn deref(&self) -> &Self::Target {
        self.0.hittable()
    }
}

/// A shape that has opted into nothing.
impl<T: Hittable + 'static> From<T> for AnyShape {
    fn from(shape: T) -> Self {
        Shape::new(shape).into()
    }
}

impl<T: Hittable + 'static, S: 'static, P: 'static> From<Shape<T, S, P>> for AnyShape
where
    Shape<T, S, P>: Packets + Proofs,
{
    fn from(shape: Shape<T, S, P>) -> Self {
        Self(Box::new(shape))
    }
}
