//! Hits of a quadric in plain arithmetic without branches, for many rays at once.

use super::surface::{DD_ERROR, OwnRay, Quadratic};
use glam::DVec3;
use tabray_exact::double_double::{two_product, two_sum};
use tabray_world::geometry::aabb::smaller;
use tabray_world::geometry::ray::RayError;

/// A ray's first hit in plain arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct QuickHit {
    /// Whether there certainly is no hit.
    pub is_missed: bool,
    /// Whether rounding could affect the hit, unless it is missed.
    pub is_unknown: bool,
    /// The distance of the hit if it is neither missed nor unknown, in world units.
    pub distance: f64,
    /// A bound of the distance's error, in world units.
    pub error: f64,
}

/// The polynomial `a t^2 + 2 b t + c` along a ray in plain arithmetic, and bounds of the errors.
struct RayPolynomial {
    /// The distance along the ray where `t` is 0.
    base: f64,
    /// The point at `t = 0`, and a bound of the error of each coordinate.
    at: DVec3,
    at_error: f64,
    a: f64,
    b: f64,
    c: f64,
    a_error: f64,
    b_error: f64,
    c_error: f64,
}

impl Quadratic {
    /// Computes the polynomial along a ray. The components of its origin and direction may have these errors.
    ///
    /// In units of 2^-53: the error of a point is 1. The error of a product of three factors and of its sums is 8, and
    /// the point enters it at most twice: less than 16. An error of the point or the direction adds to this, multiplied
    /// by the gradient.
    #[inline(always)]
    fn along(&self, ray: &OwnRay, origin_error: f64, dir_error: f64) -> RayPolynomial {
        const ROUNDING: f64 = 8.0 * f64::EPSILON;
        let OwnRay { from, dir } = *ray;
        let high = DVec3::new(from[0].high, from[1].high, from[2].high);
        let turned = self.square * dir;
        let (a, a_size) = (dir.dot(turned), self.sizes.dot(dir * dir));
        let slope = 0.5 * self.linear.dot(dir);
        // The errors below are valid for any base. If the chord has no midpoint, or a distant one, the base is the
        // point closest to the center.
        let is_bent = a.abs() > 1e-9 * a_size;
        let middle = -(high.dot(turned) + slope) / a;
        let base = if is_bent { middle } else { -high.dot(dir) };
        let along = |axis: usize| {
            let (product, product_low) = two_product(base, dir[axis]);
            let (sum, sum_low) = two_sum(from[axis].high, product);
            sum + (product_low + sum_low + from[axis].low)
        };
        let at = DVec3::new(along(0), along(1), along(2));
        let at_size = self.sizes.dot(at * at);
        let linear = self.linear.abs();
        let gradient = 2.0 * self.sizes.dot(at.abs()) + linear.element_sum();
        let at_error =
            DD_ERROR * (high.abs().element_sum() + base.abs()) + dir_error * base.abs() + origin_error;
        let b_size = (at_size * a_size).sqrt() + 0.5 * linear.dot(dir.abs());
        let c_size = at_size + linear.dot(at.abs()) + self.constant.abs();
        let reach = self.sizes.dot(dir.abs());
        RayPolynomial {
            base,
            at,
            at_error,
            a,
            b: at.dot(turned) + slope,
            c: at.dot(self.square * at) + self.linear.dot(at) + self.constant,
            a_error: ROUNDING * a_size + 2.0 * dir_error * reach,
            b_error: ROUNDING * b_size + at_error * reach + dir_error * gradient,
            // The nine components of `square` are at most 1.
            c_error: ROUNDING * c_size + at_error * gradient + 9.0 * at_error * at_error,
        }
    }

    /// Computes the first hit beyond `near` in plain arithmetic without branches, for all rays within a drift of `ray`.
    #[inline(always)]
    pub fn quick_hit(&self, ray: &OwnRay, near: f64, drift: RayError) -> QuickHit {
        let along = self.along(ray, drift.origin * self.scale, drift.dir);
        let RayPolynomial { a, b, c, a_error, b_error, c_error, .. } = along;
        let (square, product) = (b * b, a * c);
        let discriminant = square - product;
        let error = b_error * (2.0 * b.abs() + b_error)
            + a.abs() * c_error
            + a_error * (c.abs() + c_error)
            + 2.0 * f64::EPSILON * (square + product.abs());
        // The bounds of the roots' errors in `judge` are valid if the discriminant and `a` exceed their errors by this
        // factor. `quadrics_are_found` and `brackets_hold_the_hits_of_the_real_rays_of_a_camera` in
        // `tests/shapes/arithmetic.rs` test both.
        const SPARE: f64 = 1024.0;
        let is_clear = (discriminant > SPARE * error) & (a.abs() > SPARE * a_error);
        let root = discriminant.sqrt();
        let larger = if b > 0.0 { -b - root } else { root - b };
        let (one, other) = (larger / a, c / larger);
        let (nearer, farther) = if one < other { (one, other) } else { (other, one) };
        let near = near * self.scale;
        let (first, second) =
            (self.judge(&along, ray, near, nearer, root), self.judge(&along, ray, near, farther, root));
        let is_first = !first.is_missed;
        QuickHit {
            is_missed: (discriminant < -error) | (is_clear & first.is_missed & second.is_missed),
            is_unknown: !is_clear | first.is_unknown | (first.is_missed & second.is_unknown),
            distance: self.unscale * if is_first { first.distance } else { second.distance },
            error: self.unscale * if is_first { first.error } else { second.error },
        }
    }

    /// Tells whether one of two hits is beyond `near` and in the box. Lengths are in the quadric's own unit.
    #[inline(always)]
    fn judge(&self, along: &RayPolynomial, ray: &OwnRay, near: f64, hit: f64, root: f64) -> QuickHit {
        let RayPolynomial { base, at, at_error, a, a_error, b_error, c_error, .. } = *along;
        // This is the polynomial's error divided by half its slope, which is twice the error of the root of a linear
        // function, because the polynomial is curved.
        let off = a_error * hit * hit + 2.0 * b_error * hit.abs() + c_error;
        let hit_error = off / root + 4.0 * f64::EPSILON * hit.abs();
        let distance = base + hit;
        let error = hit_error + f64::EPSILON * distance.abs();
        let onward = hit * ray.dir;
        let place = at + onward;
        let place_error =
            2.0 * f64::EPSILON * (at.abs() + onward.abs()) + at_error + hit_error * ray.dir.abs();
        let (past_low, past_high) = (place - self.low, self.high - place);
        let depth = |axis: usize| smaller(past_low[axis], past_high[axis]) - place_error[axis];
        let inside = smaller(smaller(depth(0), depth(1)), depth(2));
        let depth = |axis: usize| smaller(past_low[axis], past_high[axis]) + place_error[axis];
        let outside = smaller(smaller(depth(0), depth(1)), depth(2));
        let is_missed = (distance + error < near) | (outside < 0.0);
        let is_certain =
            (4.0 * a.abs() * off < root * root) & (is_missed | ((inside > 0.0) & (distance - error > near)));
        QuickHit { is_missed: is_certain & is_missed, is_unknown: !is_certain, distance, error }
    }

    /// Returns a quick hit, corrected to half an ulp by a Newton step in double-double arithmetic, or NaN if one step
    /// is not enough.
    #[inline(always)]
    pub fn corrected(&self, ray: &OwnRay, quick: f64) -> f64 {
        let t = quick * self.scale;
        let place = |axis: usize| {
            let (product, product_low) = two_product(t, ray.dir[axis]);
            let (sum, sum_low) = two_sum(ray.from[axis].high, product);
            two_sum(sum, product_low + sum_low + ray.from[axis].low)
        };
        let ((x, x_low), (y, y_low), (z, z_low)) = (place(0), place(1), place(2));
        let (at, low) = (DVec3::new(x, y, z), DVec3::new(x_low, y_low, z_low));
        let (s, l) = (&self.square, self.linear);
        // The equation is x (Ax + Dy + Ez + G) + y (By + Fz + H) + z (Cz + I) - J. Each sum comes with its rounding
        // error.
        let (of_x, of_x_low) = compensated([s.x_axis.x, 2.0 * s.y_axis.x, 2.0 * s.z_axis.x], [x, y, z], l.x);
        let (of_y, of_y_low) = compensated([s.y_axis.y, 2.0 * s.z_axis.y, 0.0], [y, z, 0.0], l.y);
        let (of_z, of_z_low) = compensated([s.z_axis.z, 0.0, 0.0], [z, 0.0, 0.0], l.z);
        let (value, value_low) = compensated([of_x, of_y, of_z], [x, y, z], self.constant);
        let gradient = 2.0 * (self.square * at) + l;
        let value = value + (value_low + (of_x_low * x + of_y_low * y + of_z_low * z) + gradient.dot(low));
        let slope = gradient.dot(ray.dir);
        let step = value / slope;
        let bend = ray.dir.dot(self.square * ray.dir) * step * step;
        let size = self.sizes.dot(at * at) + l.abs().dot(at.abs()) + self.constant.abs();
        let error = bend.abs() + DD_ERROR * size;
        let is_enough = error <= 0.125 * f64::EPSILON * (t * slope).abs();
        if is_enough { (t - step) * self.unscale } else { f64::NAN }
    }
}

/// Returns the sum of three products and a number, and its rounding error, which is itself rounded.
#[inline(always)]
fn compensated(a: [f64; 3], b: [f64; 3], more: f64) -> (f64, f64) {
    let (first, first_low) = two_product(a[0], b[0]);
    let (second, second_low) = two_product(a[1], b[1]);
    let (third, third_low) = two_product(a[2], b[2]);
    let (sum, one_low) = two_sum(first, second);
    let (sum, other_low) = two_sum(sum, third);
    let (sum, more_low) = two_sum(sum, more);
    (sum, (first_low + second_low + third_low) + (one_low + other_low + more_low))
}
