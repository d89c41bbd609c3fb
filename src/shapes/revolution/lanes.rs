//! Some rays along which a surface is looked for, slab by slab: any number of them, one included.

use super::pieces::Slab;
use super::quadratic::Quadratic;
use crate::geometry::aabb::{larger, smaller};
use crate::geometry::ray::{MISS, Ray, Side};

/// Rays, each counted from a point near the surface.
pub(super) struct Lanes<const N: usize> {
    /// The height of that point, how fast the ray rises, and the reciprocal of that.
    pub y: [f64; N],
    pub dy: [f64; N],
    pub inverse_dy: [f64; N],
    /// The squared distance from the axis is `a s^2 + 2 b s + c`, and the least at `middle`.
    pub a: [f64; N],
    pub b: [f64; N],
    pub c: [f64; N],
    pub middle: [f64; N],
    /// Where the ray is in the surface's bounding cylinder.
    pub from: [f64; N],
    pub to: [f64; N],
    /// How far that point is from the ray's origin, and how far off it may be.
    pub base: [f64; N],
    pub off: [f64; N],
    /// What rounding makes of the quadratic, and of the places where the ray comes to the cylinder's ends.
    pub rounding: [f64; N],
    pub hair: [f64; N],
    /// 1 where the ray is outside of the surface, -1 where it is inside.
    pub side: [f64; N],
    /// 1 where the ray does not start on the surface.
    pub is_free: [f64; N],
    /// The bracket so far, counted as `from`; in the end from the ray's origin.
    pub near: [f64; N],
    pub far: [f64; N],
}

impl<const N: usize> Lanes<N> {
    /// None yet.
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
            hair: zero,
            side: zero,
            is_free: zero,
            near: zero,
            far: zero,
        }
    }

    /// So many rays that are put there next, and leave the surface on these sides, or begin elsewhere.
    pub fn begin(&mut self, count: usize, sides: Option<&[Side]>) {
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

    /// Puts a ray in its place, from a point so far along it that may be `off`, and between two places.
    #[inline(always)]
    pub fn put(
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
        let farthest = larger(from.abs(), to.abs());
        self.rounding[lane] =
            16.0 * f64::EPSILON * (c + a * farthest * farthest + widest * widest) + 4.0 * widest * off;
    }

    /// The part of a ray in a slab.
    #[inline(always)]
    pub fn part(&self, slab: &Slab, lane: usize) -> (f64, f64) {
        let (y, inverse) = (self.y[lane], self.inverse_dy[lane]);
        let (one, other) = ((slab.from - y) * inverse, (slab.to - y) * inverse);
        (larger(self.from[lane], smaller(one, other)), smaller(self.to[lane], larger(one, other)))
    }

    /// A bracket counted from a ray's origin, a hair wider.
    #[inline(always)]
    pub fn counted_from_origin(&self, lane: usize, (near, far): (f64, f64)) -> (f64, f64) {
        let base = self.base[lane];
        let slack = 4.0 * self.off[lane] + 16.0 * f64::EPSILON * (base + near.abs());
        (larger(base + near - slack, 0.0), base + far + slack)
    }

    /// The squared distance from the axis along a ray.
    #[inline(always)]
    pub fn around(&self, lane: usize) -> Quadratic {
        Quadratic { a: self.a[lane], b: self.b[lane], c: self.c[lane] }
    }

    /// Whether a ray may meet a slab's surface before what it has met, on its part from `from` to `to`.
    #[inline(always)]
    pub fn may_meet(&self, lane: usize, slab: &Slab, (from, to): (f64, f64)) -> bool {
        let closest = smaller(larger(self.middle[lane], from), to);
        let is_near = self.around(lane).at(closest) <= slab.most + 4.0 * self.rounding[lane];
        (from < to) & (self.near[lane] > from) & (is_near | (self.side[lane] < 0.0))
    }

    /// A slab's surface along a ray's part from `from` to `to`. The surface is so high and wide, and the ray's origin may be
    /// off by `origin_error`.
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
        // Where the ray comes into the cylinder it is seen on which side that is.
        let at_start = outside.at(from);
        let is_start = (from == self.from[lane]) & (self.is_free[lane] != 0.0);
        let side = if is_start { 1.0_f64.copysign(at_start) } else { self.side[lane] };
        // In the shell it may be either; and rays that rise and that fall go through slabs in one order, so that
        // some come to a slab before their side is known.
        let start_error = error + 4.0 * origin_error * (widest + slope);
        let is_side_unknown = (is_start & (at_start.abs() <= start_error)) | (side * at_start < -error);
        let slope_error = slab.slope_error * dy.abs();
        Shell { ahead: outside.times(side), side, is_side_unknown, error, slope_error, rounding, from, to }
    }
}

/// A slab's surface along a ray: between two quadrics, its parabola's with its error added and taken away.
#[derive(Clone, Copy)]
pub(super) struct Shell {
    /// How far the ray is on its side of the parabola's: it crosses the surface where this falls through 0, but for the
    /// error; and how far the slope may be from this one's, but for rounding.
    ahead: Quadratic,
    error: f64,
    slope_error: f64,
    rounding: f64,
    /// The ray's part in the slab.
    from: f64,
    to: f64,
    /// The side that the ray is on at first, and whether it may be the other one.
    pub side: f64,
    pub is_side_unknown: bool,
}

/// What a ray does in a slab.
pub(super) struct Crossing {
    /// Whether it comes into the shell, and where.
    pub is_met: bool,
    pub near: f64,
    /// Whether it certainly crosses the surface then, once, before it leaves the shell at `far`.
    pub is_certain: bool,
    pub far: f64,
}

impl Shell {
    /// The first crossing of the surface to the other side.
    #[inline(always)]
    pub fn crossing(&self) -> Crossing {
        let Self { ahead, error, slope_error, rounding, from, to, is_side_unknown, .. } = *self;
        let Quadratic { a, b, .. } = ahead;
        // A crossing to the other side falls: begin where it can.
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

    /// Where a ray that comes into the shell at `near` is out of it again, and whether it is on the other side then.
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
