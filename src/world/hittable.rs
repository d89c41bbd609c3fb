//! Shapes: the traits that a plugin implements, each for one ray.
//!
//! [`Hittable`] is all that a shape needs. What is faster, and what can be proven, is opted into:
//! [`Bracketed`] and [`Certified`], which [`Shape`](crate::world::shape::Shape) is told of.

use crate::geometry::aabb::Aabb;
use crate::geometry::ray::{Bracket, Ray, RayRange, Side};
use crate::geometry::roots::Method;
use crate::numeric::double_double::DoubleDouble;
use crate::world::certify::Equation;
use crate::world::coincidence;
use glam::DVec3;

/// A shape that rays can hit. Shapes do not change while a picture is made.
///
/// A plugin implements `distance` and `normal`, and of the others what it knows better than their defaults, each of which
/// is right for every shape.
pub trait Hittable: Send + Sync {
    /// The distance from the ray's origin to its first hit of the shape within the span, or
    /// [`MISS`](crate::geometry::ray::MISS).
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64;

    /// The unit normal of the shape at a point of it.
    fn normal(&self, at: DVec3) -> DVec3;

    /// A box that holds all of it; nothing where there is none.
    fn bounds(&self) -> Option<Aabb> {
        None
    }

    /// Whether a ray that leaves it on this side may meet it again. Where it may not, it is not asked. A plane is never
    /// met again, a ball only from inside; `true` is never wrong, as long as [`distance`](Self::distance) heeds
    /// `range.origin_side`.
    fn can_hit_itself(&self, _leaving: Side) -> bool {
        true
    }

    /// Whether both its sides are lit: then its normal is turned to the side that a ray comes from. A plane shows
    /// one side.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// How its hits are found, in a few words, for the plan of a scene.
    fn method(&self) -> String {
        "its own distance".to_owned()
    }

    /// Whether no part of it lies in a region, which may be without an end. A shape without bounds may know better than
    /// they tell; `false` is never wrong.
    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.bounds().is_some_and(|bounds| !bounds.overlaps(region))
    }

    /// A point and the unit normal of the plane that all of it lies in, if there is one: rays that leave it stay on their
    /// side of that. `None` is never wrong.
    fn plane(&self) -> Option<[DVec3; 2]> {
        None
    }

    /// How far from a point all of it is, at least, in world units; nothing where its bounds tell as much.
    fn clearance(&self, _from: DVec3) -> Option<f64> {
        None
    }

    /// How large the coordinates are that its hits are computed from, in world units: its own, not the ray's.
    fn reach(&self) -> f64 {
        self.bounds().map_or(0.0, |bounds| bounds.low.abs().max(bounds.high.abs()).max_element())
    }
}

/// A shape whose [`distance`](Hittable::distance) is dear, and which knows quickly about where it is.
///
/// Plain arithmetic without branches says which shape a ray may meet first, several rays at a time, and the rest is
/// computed for that shape alone.
pub trait Bracketed: Hittable {
    /// Between which distances [`distance`](Hittable::distance) is.
    ///
    /// Where the ray may start on the shape, that is where the shape touches the origin within the span's
    /// `origin_error`, it is a bracket without a certain end.
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket;

    /// What [`distance`](Hittable::distance) gives for a ray whose hit a bracket has found for certain, to the last bit, or
    /// NaN where that takes more than plain arithmetic. Of other rays it need not tell that they miss. `leaves` is the
    /// side of the shape that the ray starts on, if it does.
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64;
}

/// A shape that is the solutions of an equation: what is certain about its hits can be proven.
pub trait Certified: Hittable + Equation {
    /// Whether a point lies on its surface, but for an error of so many world units and for what rounding makes of the
    /// shape's own numbers. Rays that start there leave it.
    fn touches(&self, at: DVec3, error: f64) -> bool {
        coincidence::touches(self, at, error)
    }

    /// The distance of the hit at about this one, in twice the precision: it tells which of two surfaces that lie
    /// together is nearer. Nothing where it is not to be had.
    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        coincidence::distance(self, ray, distance)
    }
}

/// A shape whose hits are the roots of a function along a ray, which other methods find as well.
pub trait Searched: Certified {
    /// The distance by another method of finding roots, to be compared with it.
    fn distance_by(&self, method: Method, ray: &Ray, range: &RayRange) -> f64;
}
