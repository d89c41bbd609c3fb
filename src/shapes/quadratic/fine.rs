//! Hits of a quadric in double-double arithmetic, and the decisions that depend on it.

use super::exact::PreciseHit;
use super::surface::{DD_ERROR, OwnRay, Quadratic};
use glam::DVec3;
use tabray_exact::double_double::vectors::product;
use tabray_exact::double_double::{DoubleDouble, exponent_to_one, times_power_of_two};
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::geometry::ray::{MISS, Side};

impl Quadratic {
    /// Returns the unit normal at a point in world space.
    pub fn normal(&self, at: DVec3, center: DVec3) -> DVec3 {
        let OwnRay { from, .. } = self.own(at, DVec3::ZERO, center);
        let place = DVec3::from(from.map(|part| part.high));
        let gradient = 2.0 * (self.square * place) + self.linear;
        let size = (2.0 * self.sizes * place.abs().max_element() + self.linear.abs()).max_element();
        // The rounding errors of the terms are then less than 1e-12 of the gradient.
        if gradient.abs().max_element() > 1e-3 * size {
            return gradient.normalize();
        }
        // The gradient's terms cancel near an apex, or between two planes that are almost one.
        let turned = self.square_times(from);
        let part = |axis: usize| turned[axis] + turned[axis] + DoubleDouble::from(self.linear[axis]);
        let gradient = [part(0), part(1), part(2)].map(|part| part.high);
        let exponent = exponent_to_one(gradient.iter().fold(0.0, |largest, part| part.abs().max(largest)));
        let gradient = DVec3::from(gradient.map(|part| times_power_of_two(part, exponent)));
        // A cone's apex has no normal, and any unit vector will do. A double plane has this one.
        let longest = (0..3)
            .map(|axis| self.square.col(axis))
            .max_by(|one, other| one.length().total_cmp(&other.length()));
        gradient.try_normalize().or(longest.and_then(DVec3::try_normalize)).unwrap_or(DVec3::Y)
    }

    /// Computes the first hit beyond `near` in double-double arithmetic, or exactly if rounding could affect the
    /// decision. A hit whose distance from the box is below the precision touches the box, and a tangent line hits the
    /// quadric at the touching point.
    #[inline(never)]
    pub fn exact_hit(&self, ray: &OwnRay, near: f64) -> f64 {
        let near = DoubleDouble::from(near * self.scale);
        let hits = self.fine_hits(ray).and_then(|hits| self.first_kept(ray, near, hits, false));
        let hits = hits.or_else(|| self.first_kept(ray, near, self.exact_hits(ray), true));
        times_power_of_two(hits.unwrap_or(MISS), -self.exponent)
    }

    /// Returns the first of two hits that is beyond `near` and in the box, or `None` if that is in doubt and the answer
    /// is not final.
    fn first_kept(
        &self,
        ray: &OwnRay,
        near: DoubleDouble,
        mut hits: [PreciseHit; 2],
        is_final: bool,
    ) -> Option<f64> {
        if hits[1].at < hits[0].at {
            hits.swap(0, 1);
        }
        for PreciseHit { at: hit, error } in hits {
            // NaN is not a hit.
            if !hit.high.is_finite() {
                continue;
            }
            let ahead = (hit - near).high;
            let depth = self.depth(ray, hit, error);
            let is_doubtful = ahead.abs() <= error || depth.abs() <= 1.0;
            if is_doubtful && !is_final && (ahead >= -error && depth >= -1.0) {
                return None;
            }
            if ahead > 0.0 && depth >= -1.0 {
                return Some(hit.high);
            }
        }
        Some(MISS)
    }

    /// Returns the other hit of a ray that starts on one hit and leaves to a side, or [`MISS`] if it is behind the ray
    /// or outside of the box.
    pub fn other_hit(&self, ray: &OwnRay, side: Side) -> f64 {
        let (a, [b, ..]) = (self.bend(ray), self.at(ray, DoubleDouble::from(0.0)));
        // From the origin on, the values rise outside and fall inside, regardless of rounding.
        let zero = DoubleDouble::from(0.0);
        let b = match side {
            Side::Outside => Scalar::max(b, zero),
            Side::Inside => Scalar::min(b, zero),
        };
        let hit = DoubleDouble::from(-2.0) * b / a;
        let is_there = hit.high.is_finite() && hit.high > 0.0;
        let is_kept = is_there && self.depth(ray, hit, f64::EPSILON * hit.high) >= -1.0;
        if is_kept { times_power_of_two(hit.high, -self.exponent) } else { MISS }
    }

    /// Computes both hits in double-double arithmetic, or NaN for missing hits. Returns `None` if rounding could affect
    /// their existence.
    fn fine_hits(&self, ray: &OwnRay) -> Option<[PreciseHit; 2]> {
        let a = self.bend(ray);
        let dir = ray.dir.abs();
        let a_error = DD_ERROR * self.sizes.dot(dir * dir);
        let discriminant = |b: DoubleDouble, c: DoubleDouble, b_error: f64, c_error: f64| {
            let (square, product) = (b * b, a * c);
            let error = 2.0 * b_error * b.high.abs()
                + b_error * b_error
                + a.high.abs() * c_error
                + a_error * (c.high.abs() + c_error)
                + DD_ERROR * (square.high + product.high.abs());
            (square - product, error)
        };
        // The polynomial is expanded at the ray's origin and, if that is not conclusive, at the midpoint of both hits.
        let [b, c, b_error, c_error] = self.at(ray, DoubleDouble::from(0.0));
        let (whole, whole_error) = discriminant(b, c, b_error.high, c_error.high);
        if whole.high < -whole_error {
            return Some([PreciseHit::NONE; 2]);
        }
        // A number is decisive if it exceeds its error by this factor. `quadrics_are_found` in
        // `tests/shapes/arithmetic.rs` checks the results to 4 ulps.
        let is_clear = whole.high > 1e15 * whole_error;
        // The polynomial is linear along this ray: the quadric is a plane, or a paraboloid along its axis.
        if a_error == 0.0 {
            return Some([self.polished(ray, -c / (b + b))?, PreciseHit::NONE]);
        }
        if a.high.abs() <= 1e15 * a_error {
            return None;
        }
        let hits = if is_clear {
            let root = whole.sqrt();
            let larger = if b.high > 0.0 { -b - root } else { root - b };
            [larger / a, c / larger]
        } else {
            let base = DoubleDouble::from((-b / a).high);
            let [b, c, b_error, c_error] = self.at(ray, base);
            let (discriminant, discriminant_error) = discriminant(b, c, b_error.high, c_error.high);
            if discriminant.high < -discriminant_error {
                return Some([PreciseHit::NONE; 2]);
            }
            if discriminant.high <= 1e15 * discriminant_error {
                return None;
            }
            let (middle, half) = (base - b / a, discriminant.sqrt() / a);
            [middle - half, middle + half]
        };
        let [one, other] = hits.map(|hit| self.polished(ray, hit));
        Some([one?, other?])
    }

    /// Returns a hit after a Newton step, or `None` if the step could make it worse.
    fn polished(&self, ray: &OwnRay, hit: DoubleDouble) -> Option<PreciseHit> {
        let [b, c, b_error, c_error] = self.at(ray, hit);
        let error = c_error.high / b.high.abs() + DD_ERROR * hit.high.abs();
        (b.high.abs() > 1e15 * b_error.high).then(|| PreciseHit { at: hit - c / (b + b), error })
    }

    /// Returns the depth in the box of the point at a distance along a ray, in units of the depth's error. It is
    /// negative outside. The distance may be off by `error`.
    fn depth(&self, ray: &OwnRay, distance: DoubleDouble, error: f64) -> f64 {
        let depths = (0..3).map(|axis| {
            let place = ray.from[axis] + distance * DoubleDouble::from(ray.dir[axis]);
            let size = ray.from[axis].high.abs() + (distance.high * ray.dir[axis]).abs();
            let past = [place - self.low[axis].into(), DoubleDouble::from(self.high[axis]) - place];
            past[0].high.min(past[1].high)
                / (DD_ERROR * size + error * ray.dir[axis].abs() + f64::MIN_POSITIVE)
        });
        depths.fold(f64::INFINITY, f64::min)
    }

    /// Returns the coefficient `a` of a ray's polynomial.
    fn bend(&self, ray: &OwnRay) -> DoubleDouble {
        let dir = ray.dir.to_array().map(DoubleDouble::from);
        product(dir, self.square_times(dir))
    }

    /// Returns the coefficients `b` and `c` of a ray's polynomial around its point at a distance, and bounds of their
    /// errors.
    fn at(&self, ray: &OwnRay, distance: DoubleDouble) -> [DoubleDouble; 4] {
        let dir = ray.dir.to_array().map(DoubleDouble::from);
        let place = per_axis(|axis| ray.from[axis] + distance * dir[axis]);
        let linear = self.linear.to_array().map(DoubleDouble::from);
        let b = product(place, self.square_times(dir)) + DoubleDouble::from(0.5) * product(linear, dir);
        let size = DVec3::from(place.map(|part| part.high.abs()));
        let linear = self.linear.abs();
        // The error of the point itself is a fraction of the numbers that it was computed from.
        let moved = (0..3).map(|axis| ray.from[axis].high.abs() + (distance.high * ray.dir[axis]).abs());
        let moved = moved.sum::<f64>();
        let (dir, at_size) = (ray.dir.abs(), self.sizes.dot(size * size));
        let b_size =
            (at_size * self.sizes.dot(dir * dir)).sqrt() + linear.dot(dir) + moved * self.sizes.dot(dir);
        let c_size = at_size
            + linear.dot(size)
            + self.constant.abs()
            + moved * (2.0 * self.sizes.dot(size) + linear.element_sum());
        [b, self.value(place), (DD_ERROR * b_size).into(), (DD_ERROR * c_size).into()]
    }

    #[inline(always)]
    pub(super) fn square_times(&self, vector: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
        // The matrix is symmetric.
        let row = |row: usize| product(self.square.col(row).to_array().map(DoubleDouble::from), vector);
        [row(0), row(1), row(2)]
    }

    /// Returns the left side of the equation, which is 0 on the quadric, at a point relative to the center.
    #[inline(always)]
    fn value(&self, place: [DoubleDouble; 3]) -> DoubleDouble {
        let linear = self.linear.to_array().map(DoubleDouble::from);
        let turned = self.square_times(place);
        let sum = per_axis(|axis| turned[axis] + linear[axis]);
        product(place, sum) + DoubleDouble::from(self.constant)
    }
}
