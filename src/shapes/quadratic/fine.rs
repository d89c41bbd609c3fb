//! Hits of a surface of the second degree in twice the precision, and what is decided there.

use super::exact::Fine;
use super::surface::{FINE, OwnRay, Quadratic};
use crate::geometry::ray::{MISS, Side};
use crate::numeric::double_double::{DoubleDouble, exponent_to_one, product, times_power_of_two};
use crate::numeric::scalar::Scalar;
use glam::DVec3;

impl Quadratic {
    /// The unit normal at a point of the world.
    pub fn normal(&self, at: DVec3, center: DVec3) -> DVec3 {
        let OwnRay { from, .. } = self.own(at, DVec3::ZERO, center);
        let place = DVec3::from(from.map(|part| part.high));
        let gradient = 2.0 * (self.square * place) + self.linear;
        let size = (2.0 * self.sizes * place.abs().max_element() + self.linear.abs()).max_element();
        if gradient.abs().max_element() > 1e-3 * size {
            return gradient.normalize();
        }
        // Near an apex, or between two planes that are almost one, its parts cancel.
        let turned = self.turned(from);
        let part = |axis: usize| turned[axis] + turned[axis] + DoubleDouble::from(self.linear[axis]);
        let gradient = [part(0), part(1), part(2)].map(|part| part.high);
        let exponent = exponent_to_one(gradient.iter().fold(0.0, |most, part| part.abs().max(most)));
        let gradient = DVec3::from(gradient.map(|part| times_power_of_two(part, exponent)));
        // A cone's apex has none, and any will do; a plane that is there twice has this one.
        let longest = (0..3)
            .map(|axis| self.square.col(axis))
            .max_by(|one, other| one.length().total_cmp(&other.length()));
        gradient.try_normalize().or(longest.and_then(DVec3::try_normalize)).unwrap_or(DVec3::Y)
    }

    /// The first hit beyond `near`, in twice the precision, and where that could decide without rounding. What is as near to
    /// the box as twice the precision tells touches it, and a line that touches the surface meets it there.
    #[inline(never)]
    pub fn exact_hit(&self, ray: &OwnRay, near: f64) -> f64 {
        let near = DoubleDouble::from(near * self.scale);
        let hits = self.fine_hits(ray).and_then(|hits| self.first_kept(ray, near, hits, false));
        let hits = hits.or_else(|| self.first_kept(ray, near, self.exact_hits(ray), true));
        times_power_of_two(hits.unwrap_or(MISS), -self.exponent)
    }

    /// The first of two hits, each with what it is off at most, that is beyond `near` and in the box; nothing where that is in
    /// doubt and must be certain.
    fn first_kept(
        &self,
        ray: &OwnRay,
        near: DoubleDouble,
        mut hits: [Fine; 2],
        is_final: bool,
    ) -> Option<f64> {
        if hits[1].at < hits[0].at {
            hits.swap(0, 1);
        }
        for Fine { at: hit, error } in hits {
            // None is no number.
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

    /// The other hit of a ray that starts on one and leaves it on a side; [`MISS`] where it lies behind or out of the box.
    pub fn other_hit(&self, ray: &OwnRay, side: Side) -> f64 {
        let (a, [b, ..]) = (self.bend(ray), self.at(ray, DoubleDouble::from(0.0)));
        // On the outside the values rise from there, on the inside they fall, whatever rounding says.
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

    /// Both hits in twice the precision, no numbers where there are none; nothing where rounding could decide that.
    fn fine_hits(&self, ray: &OwnRay) -> Option<[Fine; 2]> {
        let a = self.bend(ray);
        let dir = ray.dir.abs();
        let a_error = FINE * self.sizes.dot(dir * dir);
        let room = |b: DoubleDouble, c: DoubleDouble, b_error: f64, c_error: f64| {
            let (square, product) = (b * b, a * c);
            let error = 2.0 * b_error * b.high.abs()
                + b_error * b_error
                + a.high.abs() * c_error
                + a_error * (c.high.abs() + c_error)
                + FINE * (square.high + product.high.abs());
            (square - product, error)
        };
        // From where the ray starts, and if that does not tell, from the middle of both.
        let [b, c, b_error, c_error] = self.at(ray, DoubleDouble::from(0.0));
        let (whole, whole_error) = room(b, c, b_error.high, c_error.high);
        if whole.high < -whole_error {
            return Some([Fine::NONE; 2]);
        }
        let is_clear = whole.high > 1e15 * whole_error;
        // Nothing is bent along this ray: of a plane, or of a bowl along its axis.
        if a_error == 0.0 {
            return Some([self.polished(ray, -c / (b + b))?, Fine::NONE]);
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
            let (room, room_error) = room(b, c, b_error.high, c_error.high);
            if room.high < -room_error {
                return Some([Fine::NONE; 2]);
            }
            if room.high <= 1e15 * room_error {
                return None;
            }
            let (middle, half) = (base - b / a, room.sqrt() / a);
            [middle - half, middle + half]
        };
        let [one, other] = hits.map(|hit| self.polished(ray, hit));
        Some([one?, other?])
    }

    /// A hit after a step of Newton's method; nothing where that could make it worse.
    fn polished(&self, ray: &OwnRay, hit: DoubleDouble) -> Option<Fine> {
        let [b, c, b_error, c_error] = self.at(ray, hit);
        let error = c_error.high / b.high.abs() + FINE * hit.high.abs();
        (b.high.abs() > 1e15 * b_error.high).then(|| Fine { at: hit - c / (b + b), error })
    }

    /// How deep in the box the point of a ray is at a distance that may be off by this, in units of what it is off then, or of
    /// what twice the precision tells.
    fn depth(&self, ray: &OwnRay, distance: DoubleDouble, error: f64) -> f64 {
        let depths = (0..3).map(|axis| {
            let place = ray.from[axis] + distance * DoubleDouble::from(ray.dir[axis]);
            let size = ray.from[axis].high.abs() + (distance.high * ray.dir[axis]).abs();
            let past = [place - self.low[axis].into(), DoubleDouble::from(self.high[axis]) - place];
            past[0].high.min(past[1].high) / (FINE * size + error * ray.dir[axis].abs() + f64::MIN_POSITIVE)
        });
        depths.fold(f64::INFINITY, f64::min)
    }

    /// The `a` of a ray.
    fn bend(&self, ray: &OwnRay) -> DoubleDouble {
        let dir = ray.dir.to_array().map(DoubleDouble::from);
        product(dir, self.turned(dir))
    }

    /// The `b` and `c` of a ray around its point at a distance, and what they are off at most.
    fn at(&self, ray: &OwnRay, distance: DoubleDouble) -> [DoubleDouble; 4] {
        let dir = ray.dir.to_array().map(DoubleDouble::from);
        let place = [0, 1, 2].map(|axis| ray.from[axis] + distance * dir[axis]);
        let linear = self.linear.to_array().map(DoubleDouble::from);
        let b = product(place, self.turned(dir)) + DoubleDouble::from(0.5) * product(linear, dir);
        let size = DVec3::from(place.map(|part| part.high.abs()));
        let linear = self.linear.abs();
        // The point itself is off by a few parts of what it was computed from.
        let moved = (0..3).map(|axis| ray.from[axis].high.abs() + (distance.high * ray.dir[axis]).abs());
        let moved = moved.sum::<f64>();
        let (dir, at_size) = (ray.dir.abs(), self.sizes.dot(size * size));
        let b_size =
            (at_size * self.sizes.dot(dir * dir)).sqrt() + linear.dot(dir) + moved * self.sizes.dot(dir);
        let c_size = at_size
            + linear.dot(size)
            + self.constant.abs()
            + moved * (2.0 * self.sizes.dot(size) + linear.element_sum());
        [b, self.value(place), (FINE * b_size).into(), (FINE * c_size).into()]
    }

    #[inline(always)]
    pub(super) fn turned(&self, vector: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
        // It is symmetric: its columns are its rows.
        let row = |row: usize| product(self.square.col(row).to_array().map(DoubleDouble::from), vector);
        [row(0), row(1), row(2)]
    }

    /// What is 0 on the surface, at a point from its centre.
    #[inline(always)]
    fn value(&self, place: [DoubleDouble; 3]) -> DoubleDouble {
        let linear = self.linear.to_array().map(DoubleDouble::from);
        let turned = self.turned(place);
        let sum = [0, 1, 2].map(|axis| turned[axis] + linear[axis]);
        product(place, sum) + DoubleDouble::from(self.constant)
    }
}
