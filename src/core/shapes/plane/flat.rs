//! Shapes that are a plane or a part of one, for packets of rays.

use super::surface::Plane;
use crate::geometry::ray::{Bracket, Ray, RayBall, RayRange, Side};
use crate::geometry::ray_packet::RayPacket;
use crate::world::accuracy::{Accuracy, AccuracyTag, Bounded};
use crate::world::hittable::{Bracketed, Shape};
use crate::world::packets::shape::ScalarIntersect;

/// A bracketed shape that is a plane or a part of one.
pub trait Flat: Bracketed {
    /// The accuracy of hits with the plane.
    type Accuracy: Bounded;

    /// Returns the plane.
    fn flat(&self) -> Plane<Self::Accuracy>;

    /// Tells whether eight rays certainly miss the shape, if that is faster to find than their brackets.
    #[inline(always)]
    fn is_missed_by(&self, _rays: RayPacket) -> bool {
        false
    }
}

/// The strategy of shapes that are found by their brackets and refined by their plane, eight rays at a time.
pub struct ByPlane;

impl<T: Flat> Shape<T> {
    /// Returns the shape, found by its brackets and refined by its plane.
    pub fn flat(self) -> Shape<T, ByPlane> {
        self.by()
    }
}

impl<T: Flat, P> ScalarIntersect for Shape<T, ByPlane, P> {
    type Author = T;

    #[inline(always)]
    fn author(&self) -> &T {
        &self.shape
    }

    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        self.shape.t_bounds(ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.shape.refine(ray, origin_side)
    }

    #[inline(always)]
    fn is_missed_by(&self, rays: RayPacket) -> bool {
        self.shape.is_missed_by(rays)
    }

    /// Refines by the plane alone: a certain hit is in the plane, regardless of cut-outs.
    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, out: &mut [f64]) {
        let plane = self.shape.flat();
        match T::Accuracy::ACCURACY {
            // With a normal along an axis, each dot product has one term, and nothing cancels.
            Accuracy::Draft | Accuracy::Exact if plane.is_upright => plane.refine_plain(rays, out),
            Accuracy::Draft | Accuracy::Exact => plane.refine_compensated(rays, out),
            _ => out.fill(f64::NAN),
        }
    }
}
