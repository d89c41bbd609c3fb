//! Quadratic polynomials along a ray.

use glam::DVec3;
use tabray_world::geometry::aabb::{larger, smaller};

/// The polynomial `a s^2 + 2 b s + c`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quadratic {
    pub a: f64,
    pub b: f64,
    pub c: f64,
}

impl Quadratic {
    /// Returns the squared distance from the y axis, at `s` along a ray from a point.
    #[inline(always)]
    pub fn around(from: DVec3, dir: DVec3) -> Self {
        Self {
            a: dir.x * dir.x + dir.z * dir.z,
            b: from.x * dir.x + from.z * dir.z,
            c: from.x * from.x + from.z * from.z,
        }
    }

    /// Returns the value at a place.
    #[inline(always)]
    pub fn at(&self, s: f64) -> f64 {
        (self.a * s + 2.0 * self.b) * s + self.c
    }

    /// Returns the polynomial minus a constant.
    #[inline(always)]
    pub fn lowered(&self, by: f64) -> Self {
        Self { c: self.c - by, ..*self }
    }

    /// Returns the polynomial times a constant.
    #[inline(always)]
    pub fn times(&self, by: f64) -> Self {
        Self { a: by * self.a, b: by * self.b, c: by * self.c }
    }

    /// Returns the places between which the polynomial is negative, and its discriminant, which is negative if there
    /// are none. `a` must be positive, and `inverse_a` is its reciprocal.
    #[inline(always)]
    pub fn between(&self, inverse_a: f64) -> (f64, f64, f64) {
        let discriminant = self.b * self.b - self.a * self.c;
        let root = if discriminant > 0.0 { discriminant } else { 0.0 }.sqrt();
        ((-self.b - root) * inverse_a, (root - self.b) * inverse_a, discriminant)
    }

    /// Returns the first place between `from` and `to` where the polynomial is not positive, computed without
    /// cancellation, and whether there is one. The polynomial must be positive at `from`.
    #[inline(always)]
    pub fn first_not_positive(&self, from: f64, to: f64) -> (f64, bool) {
        let Self { a, b, c } = *self;
        let discriminant = b * b - a * c;
        let root = if discriminant > 0.0 { discriminant } else { 0.0 }.sqrt();
        let s = if b > 0.0 { -(b + root) } else { c } / if b > 0.0 { a } else { root - b };
        // A polynomial that opens downward or is linear stays negative from there on.
        let is_there =
            if a > 0.0 { (discriminant >= 0.0) & (s >= from) & (s <= to) } else { self.at(to) <= 0.0 };
        (smaller(larger(s, from), to), is_there)
    }

    /// Returns the next place where the polynomial is positive, after a place where it is not, or `to` if that comes
    /// first.
    pub fn next_positive(&self, from: f64, to: f64) -> f64 {
        let Self { a, b, c } = *self;
        if a <= 0.0 {
            return to;
        }
        let root = (b * b - a * c).max(0.0).sqrt();
        let s = if b < 0.0 { (root - b) / a } else { c / (-b - root) };
        // The comparison is false for NaN, which gives `to`.
        if s < to { s.max(from) } else { to }
    }
}
