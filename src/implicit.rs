//! Shapes that are one formula: the points where f(x, y, z) = 0.
//!
//! A plugin gives the formula, once, for every number type, and a box around it. The rest follows:
//! [`taylor`](crate::roots::taylor) finds what a ray meets first and proves that nothing lies before, and [`Dual`]
//! numbers give the normal.

use crate::bounds::Bounds;
use crate::certify::{self, Enclosure, Equation};
use crate::coincidence;
use crate::dual::Dual;
use crate::frame::Frame;
use crate::geometry::{Body, Hittable, MISS, Ray, Span};
use crate::interval::Interval;
use crate::number::Number;
use crate::roots::Method;
use crate::roots::taylor::Line;
use crate::twofold::{Twofold, two_product, two_sum};
use glam::DVec3;

/// A shape by its formula, in coordinates of its own.
pub trait Implicit: Send + Sync {
    /// Below 0 inside of the shape, above 0 outside, and 0 on it.
    fn value<N: Number>(&self, at: [N; 3]) -> N;

    /// The low and the high corner of a box around the shape. What lies outside of it is cut off, and a shape that is
    /// cut shows its inside.
    fn bounds(&self) -> [DVec3; 2];
}

impl Body {
    /// An object by its formula, that looks like its material.
    pub fn implicit(formula: impl Implicit + 'static, frame: Frame) -> Self {
        let [low, high] = formula.bounds();
        Self::plain(ImplicitShape { formula, frame, low, high })
    }
}

/// A shape whose hits and normals are found by its formula.
struct ImplicitShape<T> {
    formula: T,
    frame: Frame,
    low: DVec3,
    high: DVec3,
}

impl<T: Implicit> Hittable for ImplicitShape<T> {
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.first_hit(Method::Taylor, ray, within)
    }

    fn distance_by(&self, method: Method, ray: &Ray, within: &Span) -> Option<f64> {
        Some(self.first_hit(method, ray, within))
    }

    /// Along the formula's gradient. Where that vanishes or does not exist, as at the tip of a cone, the normal
    /// points away from the shape's origin, and in the origin along its y.
    fn normal(&self, at: DVec3) -> DVec3 {
        let at = self.frame.point(at);
        let slope = |axis: usize| {
            let along =
                |own: usize| if own == axis { Dual::variable(at[own]) } else { Dual::constant(at[own]) };
            self.formula.value([along(0), along(1), along(2)]).slope
        };
        let normal =
            direction(DVec3::new(slope(0), slope(1), slope(2))).or(direction(at)).unwrap_or(DVec3::Y);
        self.frame.axes * normal
    }

    fn bounds(&self) -> Option<Bounds> {
        let own = Bounds { low: self.low, high: self.high };
        Some(self.frame.bounds(&own))
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        coincidence::touches(self, at, error)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<Twofold> {
        coincidence::distance(self, ray, distance)
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn method(&self) -> String {
        "its first root isolated by bounds that certainly hold, then polished".to_owned()
    }

    fn certify(&self, ray: &Ray) -> Enclosure {
        certify::first_hit(self, ray)
    }
}

impl<T: Implicit> ImplicitShape<T> {
    /// From the point of the ray that is closest to the shape's origin, so that a shape far away is met as exactly
    /// as a near one.
    fn first_hit(&self, method: Method, ray: &Ray, within: &Span) -> f64 {
        let closest = (self.frame.origin - ray.origin).dot(ray.dir);
        let base = self.frame.direction(offset(ray, closest, self.frame.origin));
        let dir = self.frame.direction(ray.dir);
        let (mut near, mut far) = (within.near - closest, within.far - closest);
        for axis in 0..3 {
            let (base, dir) = (base[axis], dir[axis]);
            if dir != 0.0 {
                let (one, other) = ((self.low[axis] - base) / dir, (self.high[axis] - base) / dir);
                near = near.max(one.min(other));
                far = far.min(one.max(other));
            } else if base < self.low[axis] || base > self.high[axis] {
                return MISS;
            }
        }
        let line = OnRay { formula: &self.formula, base, dir };
        let shortest = 4.0 * f64::EPSILON * near.abs().max(far.abs());
        match method.first_root(&line, near..far, shortest, within.leaves) {
            Some(root) => within.keep(closest + root),
            None => MISS,
        }
    }
}

impl<T: Implicit> Equation for ImplicitShape<T> {
    fn value<N: Number>(&self, at: [N; 3]) -> N {
        self.formula.value(self.frame.point_of(at))
    }

    fn kept(&self, at: [Interval; 3]) -> Interval {
        let own = self.frame.point_of(at);
        let inside = |axis: usize| {
            let (low, high) = (Interval::constant(self.low[axis]), Interval::constant(self.high[axis]));
            (own[axis] - low).min(high - own[axis])
        };
        inside(0).min(inside(1)).min(inside(2))
    }
}

/// The unit vector along a vector, however short or long, that has a direction.
fn direction(vector: DVec3) -> Option<DVec3> {
    (vector / vector.abs().max_element()).try_normalize()
}

/// A formula along a ray.
struct OnRay<'s, T> {
    formula: &'s T,
    base: DVec3,
    dir: DVec3,
}

impl<T: Implicit> Line for OnRay<'_, T> {
    fn at<N: Number>(&self, t: N) -> N {
        let along = |axis: usize| N::constant(self.base[axis]) + N::constant(self.dir[axis]) * t;
        self.formula.value([along(0), along(1), along(2)])
    }
}

/// The point at a distance along a ray, as seen from another one: rounded as one operation is, however far away the
/// ray's origin is.
fn offset(ray: &Ray, distance: f64, from: DVec3) -> DVec3 {
    let along = |axis: usize| {
        let (way, way_low) = two_product(distance, ray.dir[axis]);
        let (place, place_low) = two_sum(ray.origin[axis], way);
        let (offset, offset_low) = two_sum(place, -from[axis]);
        offset + (way_low + place_low + offset_low)
    };
    DVec3::new(along(0), along(1), along(2))
}
