//! Where a ray meets a surface of the second degree.
//!
//! The polynomial along a ray comes from the ray's point closest to the middle of its two hits: neither the viewer nor the
//! place that the equation counts from need be near. Every number has a bound of its rounding. Where that could decide
//! whether there is a hit, which one is first or whether a box keeps it, all of it is done again in twice the precision.

use crate::geometry::bounds::smaller;
use crate::geometry::ray::{MISS, Side};
use crate::numeric::number::Number;
use crate::numeric::twofold::{
    Exact, Twofold, exponent_to_one, product, times_power_of_two, two_product, two_sum,
};
use glam::{DMat3, DVec3};

/// The part in a box of what solves `p·Sp + l·p + c = 0`.
///
/// Lengths are counted in a power of two of the world's, and the equation is multiplied by one, both such that its
/// numbers are around 1: that loses nothing, and their squares are neither too large nor too small.
#[derive(Clone, Debug)]
pub struct Quadratic {
    square: DMat3,
    linear: DVec3,
    constant: f64,
    /// The sums of the magnitudes of each row of `square`, or column: `|x|·|S||y|` is at most the root of the sums of
    /// `size x^2` and of `size y^2`, multiplied.
    sizes: DVec3,
    low: DVec3,
    high: DVec3,
    /// The power of two that a length of the world is multiplied by, as its exponent.
    exponent: i32,
    /// That power of two, and one over it.
    scale: f64,
    unscale: f64,
}

/// A ray, in the surface's own lengths and counted from its centre.
#[derive(Clone, Copy, Debug)]
pub struct OwnRay {
    from: [Twofold; 3],
    dir: DVec3,
}

/// What is known quickly of a ray's first hit.
#[derive(Clone, Copy, Debug)]
pub struct Quick {
    /// Whether there is certainly none.
    pub is_missed: bool,
    /// Whether rounding could decide it, if it is not missed.
    pub is_unknown: bool,
    /// Else its distance, in the world's lengths.
    pub distance: f64,
    /// By how much that is off at most.
    pub error: f64,
}

/// The polynomial `a t^2 + 2 b t + c` along a ray in plain arithmetic, and by how much each is off at most.
struct Along {
    /// Where on the ray `t` is 0.
    base: f64,
    /// The point there, and by how much each coordinate is off at most.
    at: DVec3,
    at_error: f64,
    a: f64,
    b: f64,
    c: f64,
    a_error: f64,
    b_error: f64,
    c_error: f64,
}

/// A hit in twice the precision, and what it is off at most.
#[derive(Clone, Copy)]
struct Fine {
    at: Twofold,
    error: f64,
}

impl Fine {
    const NONE: Self = Self { at: Twofold { high: f64::NAN, low: 0.0 }, error: 0.0 };
}

/// What a number is off at most after about ten operations in twice the precision, against the size of its parts: each
/// makes less than 2^-102.
const FINE: f64 = 1.0 / (1_u128 << 98) as f64;

/// By what a component of a camera's direction may be off: three units of 2^-53.
pub const CAMERA: f64 = 1.5 * f64::EPSILON;

impl Quadratic {
    /// The surface with `Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J`, kept in a box.
    pub fn new(coefficients: [f64; 10], low: DVec3, high: DVec3) -> Self {
        let exponent_of = |of: &[f64]| {
            let most = of.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
            (most != 0.0).then(|| -exponent_to_one(most))
        };
        let (square, linear) = (exponent_of(&coefficients[..6]), exponent_of(&coefficients[6..9]));
        let constant = exponent_of(&coefficients[9..]);
        // The lengths at which two of the three parts are about the same.
        let length = match (square, linear, constant) {
            (Some(square), linear, constant) => {
                let of_linear = linear.map(|linear| linear - square);
                of_linear.max(constant.map(|constant| (constant - square) / 2))
            }
            (None, Some(linear), Some(constant)) => Some(constant - linear),
            _ => None,
        };
        // Of a length of 1e150 the square of what is left is still a number, and of one of 1e-150.
        let length = length.unwrap_or(0).clamp(-200, 200);
        let sizes = [square.map(|of| of + 2 * length), linear.map(|of| of + length), constant];
        let factor = -sizes.into_iter().flatten().max().unwrap_or(0);
        let of_square = |index: usize| times_power_of_two(coefficients[index], factor + 2 * length);
        let half_of_square = |index: usize| times_power_of_two(coefficients[index], factor + 2 * length - 1);
        let of_linear = |index: usize| times_power_of_two(coefficients[index], factor + length);
        let square = DMat3::from_cols(
            DVec3::new(of_square(0), half_of_square(3), half_of_square(4)),
            DVec3::new(half_of_square(3), of_square(1), half_of_square(5)),
            DVec3::new(half_of_square(4), half_of_square(5), of_square(2)),
        );
        let own = |of: DVec3| DVec3::from(of.to_array().map(|part| times_power_of_two(part, -length)));
        Self {
            square,
            linear: DVec3::new(of_linear(6), of_linear(7), of_linear(8)),
            constant: -times_power_of_two(coefficients[9], factor),
            sizes: square.x_axis.abs() + square.y_axis.abs() + square.z_axis.abs(),
            low: own(low),
            high: own(high),
            exponent: -length,
            scale: times_power_of_two(1.0, -length),
            unscale: times_power_of_two(1.0, length),
        }
    }

    /// A ray of the world in the surface's own lengths, from its centre.
    #[inline(always)]
    pub fn own(&self, origin: DVec3, dir: DVec3, center: DVec3) -> OwnRay {
        let from = [0, 1, 2].map(|axis| {
            let (high, low) = two_sum(origin[axis], -center[axis]);
            Twofold { high: high * self.scale, low: low * self.scale }
        });
        OwnRay { from, dir }
    }

    /// The polynomial along a ray whose direction may be off by this in each component.
    ///
    /// Units of 2^-53: a point is off by 1, a product of three factors and the sums that it goes into are off by 8, and the
    /// point comes into it twice at most: less than 16. What moves the point, or turns the direction, comes on top,
    /// with the gradient there.
    #[inline(always)]
    fn along(&self, ray: &OwnRay, dir_error: f64) -> Along {
        const ROUNDING: f64 = 8.0 * f64::EPSILON;
        let OwnRay { from, dir } = *ray;
        let high = DVec3::new(from[0].high, from[1].high, from[2].high);
        let turned = self.square * dir;
        let (a, a_size) = (dir.dot(turned), self.sizes.dot(dir * dir));
        let slope = 0.5 * self.linear.dot(dir);
        // Any base will do; without a middle, the point closest to the centre.
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
        let at_error = FINE * (high.abs().element_sum() + base.abs()) + dir_error * base.abs();
        let b_size = (at_size * a_size).sqrt() + 0.5 * linear.dot(dir.abs());
        let c_size = at_size + linear.dot(at.abs()) + self.constant.abs();
        let reach = self.sizes.dot(dir.abs());
        Along {
            base,
            at,
            at_error,
            a,
            b: at.dot(turned) + slope,
            c: at.dot(self.square * at) + self.linear.dot(at) + self.constant,
            a_error: ROUNDING * a_size + 2.0 * dir_error * reach,
            b_error: ROUNDING * b_size + at_error * reach + dir_error * gradient,
            // The components of `square` are at most 1.
            c_error: ROUNDING * c_size + at_error * gradient + 9.0 * at_error * at_error,
        }
    }

    /// The first hit beyond `near` in plain arithmetic without branches, of a ray whose direction may be off by this in
    /// each component.
    #[inline(always)]
    pub fn quick_hit(&self, ray: &OwnRay, near: f64, dir_error: f64) -> Quick {
        let along = self.along(ray, dir_error);
        let Along { a, b, c, a_error, b_error, c_error, .. } = along;
        let (square, product) = (b * b, a * c);
        let room = square - product;
        let error = b_error * (2.0 * b.abs() + b_error)
            + a.abs() * c_error
            + a_error * (c.abs() + c_error)
            + 2.0 * f64::EPSILON * (square + product.abs());
        // With that much to spare, roots are off by what is below.
        const SPARE: f64 = 1024.0;
        let is_clear = (room > SPARE * error) & (a.abs() > SPARE * a_error);
        let root = room.sqrt();
        let larger = if b > 0.0 { -b - root } else { root - b };
        let (one, other) = (larger / a, c / larger);
        let (nearer, farther) = if one < other { (one, other) } else { (other, one) };
        let near = near * self.scale;
        let (first, second) =
            (self.met(&along, ray, near, nearer, root), self.met(&along, ray, near, farther, root));
        let is_first = !first.is_missed;
        Quick {
            is_missed: (room < -error) | (is_clear & first.is_missed & second.is_missed),
            is_unknown: !is_clear | first.is_unknown | (first.is_missed & second.is_unknown),
            distance: self.unscale * if is_first { first.distance } else { second.distance },
            error: self.unscale * if is_first { first.error } else { second.error },
        }
    }

    /// Whether one of two hits counts, as far as plain arithmetic tells, in the surface's own lengths: it must be beyond
    /// `near` and in the box.
    #[inline(always)]
    fn met(&self, along: &Along, ray: &OwnRay, near: f64, hit: f64, root: f64) -> Quick {
        let Along { base, at, at_error, a, a_error, b_error, c_error, .. } = *along;
        // The polynomial's error there by its slope, twice: it is bent.
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
        Quick { is_missed: is_certain & is_missed, is_unknown: !is_certain, distance, error }
    }

    /// A quick hit, corrected to half a unit in its last place by a step of Newton's method in twice the precision; NaN
    /// where one is not enough.
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
        // As x (Ax + Dy + Ez + G) + y (By + Fz + H) + z (Cz + I) - J, each sum with what rounding takes from it.
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
        let error = bend.abs() + FINE * size;
        let is_enough = error <= 0.125 * f64::EPSILON * (t * slope).abs();
        if is_enough { (t - step) * self.unscale } else { f64::NAN }
    }

    /// The first hit beyond `near`, in twice the precision, and where that could decide without rounding. What is as near to
    /// the box as twice the precision tells touches it, and a line that touches the surface meets it there.
    #[inline(never)]
    pub fn exact_hit(&self, ray: &OwnRay, near: f64) -> f64 {
        let near = Twofold::from(near * self.scale);
        let hits = self.fine_hits(ray).and_then(|hits| self.first_kept(ray, near, hits, false));
        let hits = hits.or_else(|| self.first_kept(ray, near, self.exact_hits(ray), true));
        times_power_of_two(hits.unwrap_or(MISS), -self.exponent)
    }

    /// The first of two hits, each with what it is off at most, that is beyond `near` and in the box; nothing where that is in
    /// doubt and must be certain.
    fn first_kept(&self, ray: &OwnRay, near: Twofold, mut hits: [Fine; 2], is_final: bool) -> Option<f64> {
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
        let (a, [b, ..]) = (self.bend(ray), self.at(ray, Twofold::from(0.0)));
        // On the outside the values rise from there, on the inside they fall, whatever rounding says.
        let zero = Twofold::from(0.0);
        let b = match side {
            Side::Outside => Number::max(b, zero),
            Side::Inside => Number::min(b, zero),
        };
        let hit = Twofold::from(-2.0) * b / a;
        let is_there = hit.high.is_finite() && hit.high > 0.0;
        let is_kept = is_there && self.depth(ray, hit, f64::EPSILON * hit.high) >= -1.0;
        if is_kept { times_power_of_two(hit.high, -self.exponent) } else { MISS }
    }

    /// Both hits in twice the precision, no numbers where there are none; nothing where rounding could decide that.
    fn fine_hits(&self, ray: &OwnRay) -> Option<[Fine; 2]> {
        let a = self.bend(ray);
        let dir = ray.dir.abs();
        let a_error = FINE * self.sizes.dot(dir * dir);
        let room = |b: Twofold, c: Twofold, b_error: f64, c_error: f64| {
            let (square, product) = (b * b, a * c);
            let error = 2.0 * b_error * b.high.abs()
                + b_error * b_error
                + a.high.abs() * c_error
                + a_error * (c.high.abs() + c_error)
                + FINE * (square.high + product.high.abs());
            (square - product, error)
        };
        // From where the ray starts, and if that does not tell, from the middle of both.
        let [b, c, b_error, c_error] = self.at(ray, Twofold::from(0.0));
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
            let base = Twofold::from((-b / a).high);
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
    fn polished(&self, ray: &OwnRay, hit: Twofold) -> Option<Fine> {
        let [b, c, b_error, c_error] = self.at(ray, hit);
        let error = c_error.high / b.high.abs() + FINE * hit.high.abs();
        (b.high.abs() > 1e15 * b_error.high).then(|| Fine { at: hit - c / (b + b), error })
    }

    /// Both hits of the polynomial without rounding, but for that of the roots: no numbers where there are none.
    #[cold]
    fn exact_hits(&self, ray: &OwnRay) -> [Fine; 2] {
        let [a, b, c] = self.exact_polynomial(ray);
        let room = Exact::sum(b.times(&b).chain(a.times(&c).map(|term| -term))).rounded();
        let [a, b, c] = [a, b, c].map(|part| part.rounded());
        let fine = |at: Twofold| Fine { at, error: FINE * at.high.abs() };
        if room.high < 0.0 {
            return [Fine::NONE; 2];
        }
        if a.high == 0.0 {
            // A line in it, or one that is nowhere on it, has none.
            return [if b.high == 0.0 { Fine::NONE } else { fine(-c / (b + b)) }, Fine::NONE];
        }
        let root = room.sqrt();
        let larger = if b.high > 0.0 { -b - root } else { root - b };
        // Both are 0 where b and c are.
        let other = if larger.high == 0.0 { larger } else { c / larger };
        [fine(larger / a), fine(other)]
    }

    /// The polynomial `a t^2 + 2 b t + c` along a ray from where it starts.
    fn exact_polynomial(&self, ray: &OwnRay) -> [Exact; 3] {
        let parts = |of: Twofold| Exact::sum([of.high, of.low]);
        let (from, dir) = (ray.from.map(parts), ray.dir.to_array().map(|part| Exact::sum([part])));
        let second = |one: &[Exact; 3], other: &[Exact; 3]| {
            Exact::sum((0..9).flat_map(|index| {
                let (row, column) = (index / 3, index % 3);
                let product = Exact::sum(one[row].times(&other[column]));
                let coefficient = Exact::sum([self.square.col(column)[row]]);
                product.times(&coefficient).collect::<Vec<_>>()
            }))
        };
        let first = |of: &[Exact; 3], factor: f64| {
            let part =
                |axis: usize| Exact::sum([factor * self.linear[axis]]).times(&of[axis]).collect::<Vec<_>>();
            Exact::sum((0..3).flat_map(part))
        };
        let sum = |parts: &[&Exact]| Exact::sum(parts.iter().flat_map(|part| part.parts().iter().copied()));
        let b = sum(&[&second(&from, &dir), &first(&dir, 0.5)]);
        let c = sum(&[&second(&from, &from), &first(&from, 1.0), &Exact::sum([self.constant])]);
        [second(&dir, &dir), b, c]
    }

    /// How deep in the box the point of a ray is at a distance that may be off by this, in units of what it is off then, or of
    /// what twice the precision tells.
    fn depth(&self, ray: &OwnRay, distance: Twofold, error: f64) -> f64 {
        let depths = (0..3).map(|axis| {
            let place = ray.from[axis] + distance * Twofold::from(ray.dir[axis]);
            let size = ray.from[axis].high.abs() + (distance.high * ray.dir[axis]).abs();
            let past = [place - self.low[axis].into(), Twofold::from(self.high[axis]) - place];
            past[0].high.min(past[1].high) / (FINE * size + error * ray.dir[axis].abs() + f64::MIN_POSITIVE)
        });
        depths.fold(f64::INFINITY, f64::min)
    }

    /// The `a` of a ray.
    fn bend(&self, ray: &OwnRay) -> Twofold {
        let dir = ray.dir.to_array().map(Twofold::from);
        product(dir, self.turned(dir))
    }

    /// The `b` and `c` of a ray around its point at a distance, and what they are off at most.
    fn at(&self, ray: &OwnRay, distance: Twofold) -> [Twofold; 4] {
        let dir = ray.dir.to_array().map(Twofold::from);
        let place = [0, 1, 2].map(|axis| ray.from[axis] + distance * dir[axis]);
        let linear = self.linear.to_array().map(Twofold::from);
        let b = product(place, self.turned(dir)) + Twofold::from(0.5) * product(linear, dir);
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
    fn turned(&self, vector: [Twofold; 3]) -> [Twofold; 3] {
        // It is symmetric: its columns are its rows.
        let row = |row: usize| product(self.square.col(row).to_array().map(Twofold::from), vector);
        [row(0), row(1), row(2)]
    }

    /// What is 0 on the surface, at a point from its centre.
    #[inline(always)]
    fn value(&self, place: [Twofold; 3]) -> Twofold {
        let linear = self.linear.to_array().map(Twofold::from);
        let turned = self.turned(place);
        let sum = [0, 1, 2].map(|axis| turned[axis] + linear[axis]);
        product(place, sum) + Twofold::from(self.constant)
    }

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
        let part = |axis: usize| turned[axis] + turned[axis] + Twofold::from(self.linear[axis]);
        let gradient = [part(0), part(1), part(2)].map(|part| part.high);
        let exponent = exponent_to_one(gradient.iter().fold(0.0, |most, part| part.abs().max(most)));
        let gradient = DVec3::from(gradient.map(|part| times_power_of_two(part, exponent)));
        // A cone's apex has none, and any will do; a plane that is there twice has this one.
        let longest = (0..3)
            .map(|axis| self.square.col(axis))
            .max_by(|one, other| one.length().total_cmp(&other.length()));
        gradient.try_normalize().or(longest.and_then(DVec3::try_normalize)).unwrap_or(DVec3::Y)
    }
}

/// A sum of three products and a number, and what rounding takes from it, but for what it takes from that.
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

/// The roots by the well-known formula, which the notes have: it loses digits, and double roots.
#[inline(always)]
pub fn classic_roots(a: f64, half_b: f64, c: f64) -> [f64; 2] {
    let b = 2.0 * half_b;
    if a == 0.0 {
        return [-c / b, f64::NAN];
    }
    let root = (b * b - 4.0 * a * c).sqrt();
    let (one, other) = ((-b - root) / (2.0 * a), (-b + root) / (2.0 * a));
    [one.min(other), one.max(other)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: [DVec3; 2] = [DVec3::splat(-1e9), DVec3::splat(1e9)];

    fn hit(coefficients: [f64; 10], [low, high]: [DVec3; 2], origin: DVec3, dir: DVec3) -> f64 {
        let surface = Quadratic::new(coefficients, low, high);
        let ray = surface.own(origin, dir, DVec3::ZERO);
        let exact = surface.exact_hit(&ray, 0.0);
        let quick = surface.quick_hit(&ray, 0.0, 0.0);
        if quick.is_missed {
            assert_eq!(exact, MISS);
        } else if !quick.is_unknown {
            assert!((quick.distance - exact).abs() <= quick.error, "{quick:?} {exact}");
            let corrected = surface.corrected(&ray, quick.distance);
            assert!(corrected.is_nan() || (corrected - exact).abs() <= 1e-15 * exact, "{corrected} {exact}");
        }
        exact
    }

    const BALL: [f64; 10] = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

    #[test]
    fn balls_of_every_size_are_hit() {
        for exponent in [-150, -80, -20, 0, 20, 80, 150] {
            let radius = 10_f64.powi(exponent);
            let mut ball = BALL;
            ball[9] = radius * radius;
            let all = BOX.map(|corner| corner * radius);
            let found = hit(ball, all, DVec3::new(0.0, 0.0, 3.0) * radius, DVec3::NEG_Z);
            assert!((found / radius - 2.0).abs() < 1e-14, "{radius:e}: {found:e}");
            assert_eq!(hit(ball, all, DVec3::new(1.1, 0.0, 3.0) * radius, DVec3::NEG_Z), MISS);
        }
    }

    #[test]
    fn coefficients_of_every_size_make_the_same_ball() {
        for exponent in [-301, -150, 1, 150, 301] {
            let ball = BALL.map(|coefficient| coefficient * 10_f64.powi(exponent));
            let found = hit(ball, BOX, DVec3::new(0.6, 0.0, 3.0), DVec3::NEG_Z);
            assert!((found - 2.2).abs() < 1e-14, "1e{exponent}: {found:e}");
        }
        // That has a radius of 3e150, and nothing of it is in the box.
        let huge = [1e-301, 1e-301, 1e-301, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        assert_eq!(hit(huge, BOX, DVec3::new(0.6, 0.0, 3.0), DVec3::NEG_Z), MISS);
    }

    #[test]
    fn two_planes_that_are_almost_one_are_hit_where_they_are() {
        let dir = DVec3::new(0.36, 0.48, -0.8);
        let along = dir.element_sum();
        for apart in [1e-15, 1e-30, 0.0_f64] {
            let found = hit(
                [1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 0.0, 0.0, 0.0, apart],
                BOX,
                DVec3::new(0.1, 0.7, -0.3),
                dir,
            );
            let truth = (0.1 + 0.7 - 0.3 - apart.sqrt()) / -along;
            assert!((found - truth).abs() < 1e-14 * truth.abs() || truth < 0.0, "{apart:e}: {found} {truth}");
        }
    }

    #[test]
    fn straight_lines_and_planes_are_hit_once() {
        let plane = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0];
        assert_eq!(hit(plane, BOX, DVec3::Z, DVec3::NEG_Z), 0.5);
        assert_eq!(hit(plane, BOX, DVec3::Z, DVec3::X), MISS);
        // A bowl, met along its axis.
        let bowl = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0];
        assert_eq!(hit(bowl, BOX, DVec3::new(1.0, 0.0, 3.0), DVec3::NEG_Z), 2.0);
    }
}
