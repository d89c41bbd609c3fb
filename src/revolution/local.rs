//! A ray clipped to a surface's bounding cylinder and counted from a base near it, so that nothing far away is left
//! in the arithmetic.

use crate::geometry::{Ray, Span};
use crate::twofold::advance;
use glam::DVec3;

/// The part of a ray that is inside of a bounding cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// The base.
    pub origin: DVec3,
    /// The ray's direction.
    pub dir: DVec3,
    /// The squared distance from the axis is `a s^2 + 2 b s + c`, at `s` along the ray from the base.
    pub a: f64,
    pub b: f64,
    pub c: f64,
    /// Where it begins and ends, along the ray from the base.
    pub from: f64,
    pub to: f64,
    /// How far the base is from the ray's origin.
    pub base: f64,
}

impl Local {
    /// Clips a ray to heights from 0 to `height` and to `widest` around the axis.
    #[inline(always)]
    pub fn new(ray: &Ray, within: &Span, height: f64, widest: f64) -> Option<Self> {
        let Ray { origin, dir } = *ray;
        let a = dir.x * dir.x + dir.z * dir.z;
        // Far away the next distance is farther on than what is to be told apart: these ends only say where the base
        // lies, and all others are counted from there.
        let (mut near, mut far) = (within.near, within.far);
        if dir.y != 0.0 {
            let (bottom, top) = (-origin.y / dir.y, (height - origin.y) / dir.y);
            near = near.max(bottom.min(top));
            far = far.min(bottom.max(top));
        }
        let closest = -(origin.x * dir.x + origin.z * dir.z) / a;
        let base = if a > 1e-30 { closest.min(far).max(near) } else { near };
        if !base.is_finite() {
            return None;
        }
        let moved = DVec3::new(
            advance(origin.x, base, dir.x),
            advance(origin.y, base, dir.y),
            advance(origin.z, base, dir.z),
        );
        let b = moved.x * dir.x + moved.z * dir.z;
        let c = moved.x * moved.x + moved.z * moved.z;
        let (mut from, mut to) = (within.near - base, within.far - base);
        if dir.y != 0.0 {
            let (bottom, top) = (-moved.y / dir.y, (height - moved.y) / dir.y);
            from = from.max(bottom.min(top));
            to = to.min(bottom.max(top));
        } else if !(0.0..=height).contains(&moved.y) {
            return None;
        }
        // A hair more than is needed: rounding must not cut anything off.
        let widest = widest * widest * (1.0 + 1e-9);
        if a > 1e-30 {
            let room = b * b - a * (c - widest);
            if room < 0.0 {
                return None;
            }
            let root = room.sqrt();
            from = from.max((-b - root) / a);
            to = to.min((root - b) / a);
        } else if c > widest {
            return None;
        }
        if from > to || (to - from).is_nan() {
            return None;
        }
        Some(Self { origin: moved, dir, a, b, c, from, to, base })
    }

    /// The height at a place along the ray.
    #[inline(always)]
    pub fn height(&self, along: f64) -> f64 {
        self.origin.y + along * self.dir.y
    }

    /// The squared distance from the axis.
    #[inline(always)]
    pub fn around(&self, along: f64) -> f64 {
        let (x, z) = (self.origin.x + along * self.dir.x, self.origin.z + along * self.dir.z);
        x * x + z * z
    }

    /// What full precision is along this part of the ray.
    #[inline(always)]
    pub fn tolerance(&self) -> f64 {
        2.0 * f64::EPSILON * self.from.abs().max(self.to.abs())
    }
}
