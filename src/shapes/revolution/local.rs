//! A ray clipped to a surface's bounding cylinder and relative to a nearby base, which keeps the numbers small.

use super::quadratic::Quadratic;
use glam::DVec3;
use std::ops::Range;
use tabray_exact::roots::stretch::Stretch;
use tabray_exact::scalar::Scalar;
use tabray_world::geometry::frame::{self, BLUR, Frame};
use tabray_world::geometry::ray::{Ray, RayBall, RayRange};

/// The part of a ray in a bounding cylinder, in the surface's own coordinates and in world units.
#[derive(Clone, Debug)]
pub struct Local {
    /// The base.
    pub origin: DVec3,
    /// The ray's direction, a unit vector.
    pub dir: DVec3,
    /// A bound of the rounding error of each coordinate of the base, for all rays that the ray stands for.
    pub blur: f64,
    /// A bound of the rounding error of each component of the direction.
    pub turn: f64,
    /// The distances from the base at which the part begins and ends.
    pub from: f64,
    pub to: f64,
    /// The distances from the base between which the ray is certainly between the surface's ends.
    pub inner: Range<f64>,
    /// The distance of the base from the ray's origin.
    pub base: f64,
    /// The distance from the ray's origin at which the search ends.
    pub far: f64,
    /// The ray in world space, and the surface's frame.
    pub ray: RayBall,
    pub frame: Frame,
}

impl Local {
    /// Clips a ray in world space to heights from 0 to `height` and to the radius `widest` around a frame's y axis.
    #[inline(always)]
    pub fn new(frame: &Frame, ray: &RayBall, range: &RayRange, height: f64, widest: f64) -> Option<Self> {
        let Ray { origin, dir } = frame.ray(ray);
        let a = dir.x * dir.x + dir.z * dir.z;
        // Far from the ray's origin, ulps are larger than the details of the surface. These ends thus only place the
        // base, and all others are relative to it. The end of the range is not used, so that a hit is the same in each
        // range that contains it.
        let (mut near, mut far) = (range.near, f64::INFINITY);
        if dir.y != 0.0 {
            let (bottom, top) = (-origin.y / dir.y, (height - origin.y) / dir.y);
            near = near.max(bottom.min(top));
            far = far.min(bottom.max(top));
        }
        let closest = -(origin.x * dir.x + origin.z * dir.z) / a;
        // For a ray within 1e-15 of the axis direction, rounding determines the closest point.
        let base = if a > 1e-30 { closest.min(far).max(near) } else { near };
        if !base.is_finite() {
            return None;
        }
        // The offset is computed before the rotation, and so the rotated vector is as small as the surface.
        let moved = frame.direction(frame.from_origin(ray, base));
        let blur = frame::blur(moved, base) + ray.drift.origin + ray.drift.dir * base.abs();
        let turn = BLUR + ray.drift.dir;
        let mut stretch = Stretch::from(range.near - base..f64::INFINITY);
        stretch.cut((moved.y, dir.y), [0.0, height], [blur, turn], 2.0 * (height + widest));
        let (mut from, mut to) = (stretch.outer.start, stretch.outer.end);
        // The cylinder is widened so that rounding cuts nothing off.
        let widest = widest + 2.0 * (blur + turn * (height + widest));
        let widest = widest * widest * (1.0 + 1e-9);
        let inside = Quadratic::around(moved, dir).lowered(widest);
        if a > 1e-30 {
            let (inward, outward, discriminant) = inside.between(1.0 / a);
            if discriminant < 0.0 {
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
        Some(Self { origin: moved, dir, blur, turn, from, to, inner, base, far, ray: *ray, frame: *frame })
    }

    /// Returns the height at a place along the ray.
    #[inline(always)]
    pub fn height(&self, along: f64) -> f64 {
        self.origin.y + along * self.dir.y
    }

    /// Returns a coordinate of the place along the ray. An interval encloses the coordinate for all rays that may have
    /// been rounded to this one.
    #[inline(always)]
    pub fn place<N: Scalar>(&self, axis: usize, along: N) -> N {
        N::about(self.origin[axis], self.blur) + along * N::about(self.dir[axis], self.turn)
    }

    /// Returns a coordinate of the place along this ray alone.
    #[inline(always)]
    pub fn own_place<N: Scalar>(&self, axis: usize, along: N) -> N {
        N::constant(self.origin[axis]) + along * N::constant(self.dir[axis])
    }

    /// Returns a bound of the rounding error of each coordinate of any point on this part of the ray.
    #[inline(always)]
    pub fn moved(&self) -> f64 {
        self.blur + self.turn * self.from.abs().max(self.to.abs())
    }

    /// Returns the tolerance of full precision along this part of the ray: 2 EPSILON of its maximum distance from the
    /// base.
    #[inline(always)]
    pub fn tolerance(&self) -> f64 {
        2.0 * f64::EPSILON * self.from.abs().max(self.to.abs())
    }
}
