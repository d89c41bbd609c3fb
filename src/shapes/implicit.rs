//! Shapes that are one formula: the points where f(x, y, z) = 0.
//!
//! A plugin gives the formula, once, for every number type, and a box around it. The rest follows:
//! [`taylor`] isolates what a ray meets first by interval arithmetic, and [`Dual`]
//! numbers give the normal.

use crate::geometry::bounds::Bounds;
use crate::geometry::frame::{BLUR, Frame};
use crate::geometry::ray::{MISS, Ray, Side, Span};
use crate::geometry::roots::{Method, taylor, twice};
use crate::geometry::sight::Line;
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use crate::numeric::number::Number;
use crate::world::body::Body;
use crate::world::certify::Equation;
use crate::world::hittable::{Certified, Hittable, Searched};
use crate::world::shape::Shape;
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
        Self::plain(Shape::new(ImplicitShape { formula, frame, low, high }).searched())
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

    fn is_two_sided(&self) -> bool {
        true
    }

    fn method(&self) -> String {
        "its first root isolated by interval arithmetic, then polished".to_owned()
    }
}

impl<T: Implicit> Certified for ImplicitShape<T> {}

impl<T: Implicit> Searched for ImplicitShape<T> {
    fn distance_by(&self, method: Method, ray: &Ray, within: &Span) -> f64 {
        self.first_hit(method, ray, within)
    }
}

impl<T: Implicit> ImplicitShape<T> {
    /// From the point of the ray that is closest to the shape's origin, so that a shape far away is met as exactly
    /// as a near one. The ray is looked at from its origin, or where it comes into the box, to where it leaves the box,
    /// wherever the span ends: a hit is the same in every span that holds it.
    fn first_hit(&self, method: Method, ray: &Ray, within: &Span) -> f64 {
        let closest = (self.frame.origin - ray.origin).dot(ray.dir);
        let base = self.frame.direction(self.frame.from_origin(ray, closest));
        let dir = self.frame.direction(ray.dir);
        let (mut start, mut end) = (-closest, f64::INFINITY);
        for axis in 0..3 {
            let (base, dir) = (base[axis], dir[axis]);
            if dir != 0.0 {
                let (one, other) = ((self.low[axis] - base) / dir, (self.high[axis] - base) / dir);
                start = start.max(one.min(other));
                end = end.min(one.max(other));
            } else if base < self.low[axis] || base > self.high[axis] {
                return MISS;
            }
        }
        let line = OnRay { shape: self, base, dir, ray, closest };
        let shortest = 4.0 * f64::EPSILON * start.abs().max(end.abs());
        match method.first_root(&line, start..end, closest, within, shortest) {
            Some(root) => within.keep(closest + root),
            None => MISS,
        }
    }
}

impl<T: Implicit> Equation for ImplicitShape<T> {
    fn own<N: Number>(&self, line: Line<N>) -> Line<N> {
        self.frame.line(line)
    }

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        self.formula.value(at)
    }

    fn kept<N: Number>(&self, at: [N; 3]) -> N {
        let inside = |axis: usize| {
            let (low, high) = (N::constant(self.low[axis]), N::constant(self.high[axis]));
            (at[axis] - low).min(high - at[axis])
        };
        inside(0).min(inside(1)).min(inside(2))
    }

    fn extent(&self) -> [DVec3; 2] {
        [self.low, self.high]
    }
}

/// The unit vector along a vector, however short or long, that has a direction.
fn direction(vector: DVec3) -> Option<DVec3> {
    (vector / vector.abs().max_element()).try_normalize()
}

/// A formula along a ray.
struct OnRay<'s, T> {
    shape: &'s ImplicitShape<T>,
    /// The ray in the shape's own coordinates, from its point closest to the shape's origin.
    base: DVec3,
    dir: DVec3,
    /// The ray in the world, and how far along it that point is.
    ray: &'s Ray,
    closest: f64,
}

impl<T: Implicit> taylor::Line for OnRay<'_, T> {
    fn at<N: Number>(&self, t: N) -> N {
        // Bounds hold the values along the ray which this one was rounded from.
        let blur = BLUR * self.base.abs().element_sum();
        let along = |axis: usize| N::about(self.base[axis], blur) + N::about(self.dir[axis], BLUR) * t;
        self.shape.formula.value([along(0), along(1), along(2)])
    }

    /// Twice the precision, from the ray in the world, tells nearly all touches from misses.
    fn undecided(&self, piece: Interval, leaves: Option<Side>, hidden: f64) -> Option<f64> {
        let exact = self.shape.frame.exactly(self.ray, self.closest);
        twice::first_root(|t| self.shape.formula.value(exact.along(t)), piece, leaves, hidden)
    }
}
