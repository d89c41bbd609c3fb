//! The state of rays during the search of a surface, slab by slab, in any number of lanes, including one.

use super::quadratic::Quadratic;
use super::slab::Slab;
use tabray_world::geometry::aabb::{larger, smaller};
use tabray_world::geometry::ray::{MISS, Ray, Side};

/// Rays, each with a base: a point of the ray near the surface, where its parameter is 0. Lengths are in world units.
pub(super) struct Lanes<const N: usize> {
    /// The height of the base, the direction's component along the axis, and its reciprocal.
    pub y: [f64; N],
    pub dy: [f64; N],
    pub inverse_dy: [f64; N],
    /// The coefficients of the squared distance from the axis, `a s^2 + 2 b s + c`, and the `s` of its minimum.
    pub a: [f64; N],
    pub b: [f64; N],
    pub c: [f64; N],
    pub middle: [f64; N],
    /// The part of the ray in the surface's bounding cylinder.
    pub from: [f64; N],
    pub to: [f64; N],
    /// The distance of the base from the ray's origin, and a bound of the base's rounding error. Before the base is
    /// set, `off` bounds the distance of the rays that the ray stands for.
    pub base: [f64; N],
    pub off: [f64; N],
    /// Bounds of the rounding errors of the quadratic, and of the places of the cylinder's ends.
    pub rounding: [f64; N],
    pub end_error: [f64; N],
    /// 1 outside of the surface, and -1 inside.
    pub side: [f64; N],
    /// 1 for a ray that does not start on the surface, and else 0.
    pub is_free: [f64; N],
    /// The bracket so far, counted from the base, and finally from the ray's origin.
    pub near: [f64; N],
    pub far: [f64; N],
}

impl<const N: usize> Lanes<N> {
    /// Returns lanes without rays.
    pub fn none() -> Self {
        let zero = [0.0; N];
        Self {
            y: zero,
            dy: zero,
            inverse_dy: zero,
            a: zero,
            b: zero,
            c: zero,
            middle: zero,
            from: zero,
            to: zero,
            base: zero,
            off: zero,
            rounding: zero,
            end_error: zero,
            side: zero,
            is_free: zero,
            near: zero,
            far: zero,
        }
    }

    /// Prepares `count` lanes for exact rays. They leave the surface to these sides, or start elsewhere.
    pub fn prepare(&mut self, count: usize, sides: Option<&[Side]>) {
        self.off[..count].fill(0.0);
        match sides {
            None => {
                self.side[..count].fill(1.0);
                self.is_free[..count].fill(1.0);
            }
            Some(sides) => {
                for (lane, side) in sides.iter().enumerate() {
                    self.side[lane] = match side {
                        Side::Outside => 1.0,
                        Side::Inside => -1.0,
                    };
                }
                self.is_free[..count].fill(0.0);
            }
        }
        self.far[..count].fill(MISS);
    }

    /// Sets a lane to a ray with the base as its origin. The base is at a distance of `base` along the original ray,
    /// with a rounding error of `off`. The search is limited to the part between two places.
    #[inline(always)]
    pub fn set(
        &mut self,
        lane: usize,
        ray: Ray,
        (base, off): (f64, f64),
        (from, to): (f64, f64),
        widest: f64,
    ) {
        let Quadratic { a, b, c } = Quadratic::around(ray.origin, ray.dir);
        (self.y[lane], self.dy[lane], self.inverse_dy[lane]) = (ray.origin.y, ray.dir.y, 1.0 / ray.dir.y);
        (self.a[lane], self.b[lane], self.c[lane], self.middle[lane]) = (a, b, c, -b * (1.0 / a));
        (self.base[lane], self.off[lane]) = (base, off);
        (self.from[lane], self.to[lane]) = (from, to);
        // The coefficients and the value have about ten roundings of half an EPSILON of terms that add up to at most `2
        // (c + a s^2)`: 10 EPSILON of that sum. An error of `off` in the base changes the squared distance on the
        // surface by `2 widest off`.
        let farthest = larger(from.abs(), to.abs());
        self.rounding[lane] =
            16.0 * f64::EPSILON * (c + a * farthest * farthest + widest * widest) + 4.0 * widest * off;
    }

    /// Returns the part of a ray in a slab.
    #[inline(always)]
    pub fn part(&self, slab: &Slab, lane: usize) -> (f64, f64) {
        let (y, inverse) = (self.y[lane], self.inverse_dy[lane]);
        let (one, other) = ((slab.from - y) * inverse, (slab.to - y) * inverse);
        (larger(self.from[lane], smaller(one, other)), smaller(self.to[lane], larger(one, other)))
    }

    /// Converts a bracket to distances from the ray's origin, widened by the rounding errors of the base and of the
    /// sums. The hits in `tests/slow/truth.rs` test this margin.
    #[inline(always)]
    pub fn counted_from_origin(&self, lane: usize, (near, far): (f64, f64)) -> (f64, f64) {
        let base = self.base[lane];
        let slack = 4.0 * self.off[lane] + 16.0 * f64::EPSILON * (base + near.abs());
        (larger(base + near - slack, 0.0), base + far + slack)
    }

    /// Returns the squared distance from the axis along a ray.
    #[inline(always)]
    pub fn around(&self, lane: usize) -> Quadratic {
        Quadratic { a: self.a[lane], b: self.b[lane], c: self.c[lane] }
    }

    /// Returns whether a ray, from `from` to `to`, may hit a slab's surface before its hit so far. The square is
    /// increased by `margin` times the rounding error.
    #[inline(always)]
    pub fn may_meet(&self, lane: usize, slab: &Slab, (from, to): (f64, f64), margin: f64) -> bool {
        let closest = smaller(larger(self.middle[lane], from), to);
        let is_near = self.around(lane).at(closest) <= slab.max_square + margin * self.rounding[lane];
        (from < to) & (self.near[lane] > from) & (is_near | (self.side[lane] < 0.0))
    }

    /// Returns a slab's surface along a ray, from `from` to `to`. The surface has this height and maximum radius, and
    /// the ray's origin may be off by `origin_error`, all in world units.
    #[inline(always)]
    pub fn shell(
        &self,
        lane: usize,
        slab: &Slab,
        (from, to): (f64, f64),
        [height, widest]: [f64; 2],
        origin_error: f64,
    ) -> Shell {
        let dy = self.dy[lane];
        let v = self.y[lane] - slab.middle;
        let farthest = larger(larger((v + from * dy).abs(), (v + to * dy).abs()), v.abs());
        let slope = slab.c1.abs() + 2.0 * slab.c2.abs() * farthest;
        // An error of `off` in the height changes the parabola by `slope off`. The parabola's value has about ten
        // roundings of half an EPSILON of its terms, and the error of `v` is half an EPSILON of the height.
        let rounding = self.rounding[lane]
            + 4.0 * self.off[lane] * slope
            + 16.0
                * f64::EPSILON
                * (slab.c0.abs() + slab.c1.abs() * (farthest + height) + slab.c2.abs() * farthest * farthest);
        let error = slab.error + rounding;
        let Quadratic { a, b, c } = self.around(lane);
        let outside = Quadratic {
            a: a - slab.c2 * dy * dy,
            b: b - (0.5 * slab.c1 + slab.c2 * v) * dy,
            c: c - slab.parabola(v),
        };
        // The side is determined where the ray enters the cylinder.
        let at_start = outside.at(from);
        let is_start = (from == self.from[lane]) & (self.is_free[lane] != 0.0);
        let side = if is_start { 1.0_f64.copysign(at_start) } else { self.side[lane] };
        // In the shell, the ray may be on either side. Rising and falling rays visit slabs in the same order, and so
        // some reach a slab before their side is known.
        let start_error = error + 4.0 * origin_error * (widest + slope);
        let is_side_unknown = (is_start & (at_start.abs() <= start_error)) | (side * at_start < -error);
        let slope_error = slab.slope_error * dy.abs();
        Shell { ahead: outside.times(side), side, is_side_unknown, error, slope_error, rounding, from, to }
    }
}

/// A slab's surface along a ray: a shell between the parabola's quadric with its error added and subtracted.
#[derive(Clone, Copy)]
pub(super) struct Shell {
    /// The distance from the parabola's quadric on the ray's side, in squared world units. The ray crosses the surface
    /// where this falls through 0, to within `error`. `slope_error` bounds the difference of the slopes, except for
    /// `rounding`.
    ahead: Quadratic,
    error: f64,
    slope_error: f64,
    rounding: f64,
    /// The part of the ray in the slab.
    from: f64,
    to: f64,
    /// The first side of the ray (1 outside, -1 inside), and whether it may be the other one.
    pub side: f64,
    pub is_side_unknown: bool,
}

/// The hit of a ray in a slab.
pub(super) struct Crossing {
    /// Whether the ray enters the shell, at `near`.
    pub is_met: bool,
    pub near: f64,
    /// Whether the ray then certainly crosses the surface exactly once before it leaves the shell at `far`.
    pub is_certain: bool,
    pub far: f64,
}

impl Shell {
    /// Returns the first crossing of the surface to the other side.
    #[inline(always)]
    pub fn crossing(&self) -> Crossing {
        let Self { ahead, error, slope_error, rounding, from, to, is_side_unknown, .. } = *self;
        let Quadratic { a, b, .. } = ahead;
        // At a crossing to the other side, `ahead` falls. The search starts where it can.
        let rises = 2.0 * (a * from + b) - slope_error - rounding;
        let begin = if rises > 0.0 { from - rises / (2.0 * a) } else { from };
        let never_falls = (rises > 0.0) & ((a >= 0.0) | (begin >= to));
        let outer = ahead.lowered(error);
        let is_in_shell = outer.at(begin) <= 0.0;
        let (enters, is_entered) = outer.first_not_positive(begin, to);
        let (origin_side, is_left) = ahead.lowered(-error).first_not_positive(enters, to);
        let falls = larger(a * enters + b, a * origin_side + b);
        let is_certain =
            !is_side_unknown & !is_in_shell & is_left & (2.0 * falls + slope_error + rounding < 0.0);
        let is_met = is_side_unknown | (!never_falls & (is_in_shell | is_entered));
        let near = if is_side_unknown {
            from
        } else if is_in_shell {
            begin
        } else {
            enters
        };
        Crossing { is_met, near, is_certain, far: origin_side }
    }

    /// Returns where a ray that enters the shell at `near` leaves it, and whether it is then on the other side.
    pub fn end(&self, near: f64) -> (f64, bool) {
        if self.is_side_unknown {
            return (self.to, false);
        }
        let (origin_side, is_left) = self.ahead.lowered(-self.error).first_not_positive(near, self.to);
        if is_left {
            (origin_side, true)
        } else {
            (self.ahead.lowered(self.error).next_positive(near, self.to), false)
        }
    }
}
