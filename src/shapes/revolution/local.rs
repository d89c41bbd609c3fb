//! A ray clipped to a surface's bounding cylinder and counted from a base near it, so that nothing far away is left
//! in the arithmetic.

use super::quadratic::Quadratic;
use crate::geometry::frame::{self, BLUR, Frame};
use crate::geometry::ray::{Ray, RayRange};
use crate::geometry::roots::taylor::Stretch;
use crate::numeric::scalar::Scalar;
use glam::DVec3;
use std::ops::Range;

/// The part of a ray that is inside of a bounding cylinder.
#[derive(Clone, Debug)]
pub struct Local {
    /// The base.
    pub origin: DVec3,
    /// The ray's direction.
    pub dir: DVec3,
    /// How far rounding may have moved the base.
    pub blur: f64,
    /// Where the ray begins and ends, along it from the base.
    pub from: f64,
    pub to: f64,
    /// Where it is between the surface's ends for certain.
    pub inner: Range<f64>,
    /// How far the base is from the ray's origin.
    pub base: f64,
    /// Where the search ends, from the ray's origin: only what lies before that is of interest.
    pub far: f64,
    /// The ray in the world, and where the surface stands there.
    pub ray: Ray,
    pub frame: Frame,
}

impl Local {
    /// Clips a ray of the world to heights from 0 to `height` and to `widest` around a frame's y.
    #[inline(always)]
    pub fn new(frame: &Frame, ray: &Ray, range: &RayRange, height: f64, widest: f64) -> Option<Self> {
        let Ray { origin, dir } = frame.ray(ray);
        let a = dir.x * dir.x + dir.z * dir.z;
        // Far away the next distance is farther on than what is to be told apart: these ends only say where the base
        // lies, and all others are counted from there. Where the span ends has no part in it, so that a hit is the same
        // in every span that holds it.
        let (mut near, mut far) = (range.near, f64::INFINITY);
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
        // Moved in the world and turned then: what is turned is as small as the surface.
        let moved = frame.direction(frame.from_origin(ray, base));
        let blur = frame::blur(moved, base);
        let mut stretch = Stretch::from(range.near - base..f64::INFINITY);
        stretch.cut((moved.y, dir.y), [0.0, height], blur, 2.0 * (height + widest));
        let (mut from, mut to) = (stretch.outer.start, stretch.outer.end);
        // A hair more than is needed: rounding must not cut anything off.
        let widest = widest + 2.0 * (blur + BLUR * (height + widest));
        let widest = widest * widest * (1.0 + 1e-9);
        let inside = Quadratic::around(moved, dir).lowered(widest);
        if a > 1e-30 {
            let (inward, outward, room) = inside.between(1.0 / a);
            if room < 0.0 {
                return None;
            }
            from = from.max(inward);
            to = to.min(outward);
        } else if inside.c > 0.0 {
            return None;
        }
        if from > to || (to - from).is_nan() || base + from >= range.far {
            return None;
        }
        let (far, inner) = (range.far, stretch.inner);
        Some(Self { origin: moved, dir, blur, from, to, inner, base, far, ray: *ray, frame: *frame })
    }

    /// The height at a place along the ray.
    #[inline(always)]
    pub fn height(&self, along: f64) -> f64 {
        self.origin.y + along * self.dir.y
    }

    /// A coordinate of the place along the ray. Its bounds, where a number has any, hold that of the ray which this one
    /// was rounded from.
    #[inline(always)]
    pub fn place<N: Scalar>(&self, axis: usize, along: N) -> N {
        N::about(self.origin[axis], self.blur) + along * N::about(self.dir[axis], BLUR)
    }

    /// A coordinate of the place along this ray, and of no other.
    #[inline(always)]
    pub fn own_place<N: Scalar>(&self, axis: usize, along: N) -> N {
        N::constant(self.origin[axis]) + along * N::constant(self.dir[axis])
    }

    /// How far rounding may have moved any point of this part of the ray.
    #[inline(always)]
    pub fn moved(&self) -> f64 {
        self.blur + BLUR * self.from.abs().max(self.to.abs())
    }

    /// What full precision is along this part of the ray.
    #[inline(always)]
    pub fn tolerance(&self) -> f64 {
        2.0 * f64::EPSILON * self.from.abs().max(self.to.abs())
    }
}
