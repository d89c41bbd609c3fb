//! A ray's way from slab to slab.
//!
//! In a slab the surface lies between two quadrics, the parabola's with its error added and taken away. A ray that
//! misses the nearer one misses the surface; one that crosses both while falling all the way has one root between
//! them, bracketed by the error; what grazes the shell between them is looked at more closely on that short piece.

use super::line::{OnRay, Uncut};
use super::local::Local;
use super::slabs::Slab;
use super::surface::{Finish, Revolution, sign};
use crate::geometry::frame::{BLUR, Frame};
use crate::geometry::ray::{MISS, Ray, Side, Span};
use crate::geometry::roots::taylor::{self, Found, Stretch};
use crate::geometry::roots::{Method, newton};

/// `sg * (a s^2 + 2 b s + c)`, which is positive where the ray is still on its side of a slab's parabola.
#[derive(Clone, Copy)]
struct Quadratic {
    a: f64,
    b: f64,
    c: f64,
}

impl Revolution {
    /// The distance of a ray's first hit within a span, whatever the ray does, and whether it is that of all rays that
    /// this one was rounded from.
    pub fn first_hit(&self, frame: &Frame, ray: &Ray, within: &Span) -> (f64, bool) {
        let Some(local) = Local::new(frame, ray, within, self.height, self.slabs.widest()) else {
            return (MISS, true);
        };
        let Found { root, is_certain } = self.walk(&local, within.leaves);
        (root.map_or(MISS, |along| within.keep(local.base + along)), is_certain)
    }

    /// As [`first_hit`](Self::first_hit), by another method and in the same bounding cylinder; but the notes' steps, as
    /// in the notes, go all the way between the surface's heights.
    pub fn first_hit_by(&self, method: Method, frame: &Frame, ray: &Ray, within: &Span) -> f64 {
        let widest = if method == Method::Steps { f64::INFINITY } else { self.slabs.widest() };
        let Some(local) = Local::new(frame, ray, within, self.height, widest) else { return MISS };
        let line = Uncut { surface: self, local: &local };
        let shortest = 4.0 * local.tolerance();
        match method.first_root(&line, local.from..local.to, local.base, within, shortest) {
            Some(along) => within.keep(local.base + along),
            None => MISS,
        }
    }

    /// The first place along a ray where it crosses the surface. A ray that leaves the surface on a side looks for
    /// crossings from there alone.
    fn walk(&self, local: &Local, leaves: Option<Side>) -> Found {
        let mut is_certain = true;
        let root = self.walk_on(local, leaves, &mut is_certain);
        Found { root, is_certain }
    }

    fn walk_on(&self, local: &Local, leaves: Option<Side>, is_certain: &mut bool) -> Option<f64> {
        let dy = local.dir.y;
        let is_upward = dy > 0.0;
        let mut index = self.slabs.index(local.height(local.from));
        let mut from = local.from;
        let reach = local.from.abs().max(local.to.abs());
        let widest = self.slabs.widest();
        // What rounding makes of the ray's own part of the arithmetic, and of the ray.
        let farthest = local.c + local.a * reach * reach + widest * widest;
        let rounding = 16.0 * f64::EPSILON * farthest + 4.0 * farthest.sqrt() * local.moved();
        let mut side = leaves.map(sign);
        let mut wanted = leaves;
        loop {
            let slab = self.slabs.get(index);
            let is_last = if is_upward { index + 1 == self.slabs.count() } else { index == 0 };
            let to = if dy == 0.0 || is_last {
                local.to
            } else {
                let end = if is_upward { slab.to } else { slab.from };
                ((end - local.origin.y) / dy).min(local.to)
            };
            if slab.is_void {
                // Where the surface narrows down to the axis, rounding may decide on which side of its end a ray is.
                let is_near = |along: f64| local.around(along) <= self.slabs.coarsest() + rounding;
                *is_certain &= !is_near(from) && !is_near(to);
                (side, wanted) = (None, None);
            } else if to > from || from == local.from {
                let sg = side.unwrap_or_else(|| self.side_at(local, slab, from, rounding, is_certain));
                side = Some(sg);
                if let Some(hit) = self.cross(local, slab, (from, to), (sg, wanted), rounding, is_certain) {
                    return Some(hit);
                }
            }
            from = from.max(to);
            if is_last || from >= local.to || local.base + from >= local.far {
                return None;
            }
            index = if is_upward { index + 1 } else { index - 1 };
        }
    }

    /// Which side of the surface a place along a ray is on: 1 outside, -1 inside.
    #[inline(always)]
    fn side_at(&self, local: &Local, slab: &Slab, along: f64, rounding: f64, is_certain: &mut bool) -> f64 {
        let v = local.height(along) - slab.middle;
        let outside = local.around(along) - slab.parabola(v);
        let error = slab.error + rounding + slab.rounding(v, self.height, local.moved());
        if outside.abs() > error {
            return outside.signum();
        }
        *is_certain = false;
        if self.outside(local, along) < 0.0 { -1.0 } else { 1.0 }
    }

    /// The first crossing in a slab, if there is one.
    #[inline(always)]
    fn cross(
        &self,
        local: &Local,
        slab: &Slab,
        (from, to): (f64, f64),
        (sg, wanted): (f64, Option<Side>),
        rounding: f64,
        is_certain: &mut bool,
    ) -> Option<f64> {
        let dy = local.dir.y;
        if sg > 0.0 && local.closest_around(from, to) > slab.most + rounding {
            return None;
        }
        let v = local.origin.y - slab.middle;
        let rounding = rounding + slab.rounding(v.abs().max((v + to * dy).abs()), self.height, local.moved());
        let error = slab.error + rounding;
        let quadratic = Quadratic {
            a: sg * (local.a - slab.c2 * dy * dy),
            b: sg * (local.b - (0.5 * slab.c1 + slab.c2 * v) * dy),
            c: sg * (local.c - slab.parabola(v)),
        };
        // A crossing to the other side falls: begin where it can.
        let slope_error = slab.slope_error * dy.abs();
        let rises = quadratic.slope(from) - slope_error - rounding;
        let mut from = from;
        if rises > 0.0 {
            if quadratic.a >= 0.0 {
                return None;
            }
            from += rises / (-2.0 * quadratic.a);
            if from >= to {
                return None;
            }
        }
        let enters = quadratic.lowered(error).first_not_positive(from, to)?;
        if let Some(leaves) = quadratic.lowered(-error).first_not_positive(enters, to) {
            if quadratic.slope(enters).max(quadratic.slope(leaves)) + slope_error < 0.0 {
                *is_certain &= local.inner.start < enters && leaves < local.inner.end;
                return Some(self.finish(local, (enters, leaves), sg));
            }
            let Found { root, is_certain: is_root_certain } =
                self.first_crossing(local, enters, leaves, wanted);
            *is_certain &= is_root_certain && root.is_some();
            return Some(root.unwrap_or(enters));
        }
        // It may have touched the surface, while it was in the shell.
        let out = quadratic.lowered(error).next_positive(enters, to);
        let Found { root, is_certain: is_root_certain } = self.first_crossing(local, enters, out, wanted);
        *is_certain &= is_root_certain;
        root
    }

    /// The first crossing on a short piece, from a side if it matters from which.
    fn first_crossing(&self, local: &Local, from: f64, to: f64, wanted: Option<Side>) -> Found {
        // The piece's own ends may be crossings: they are where shells begin and end, but where the ray begins.
        let (from, to) = (from.next_down().max(local.from), to.next_up());
        let line = OnRay { surface: self, local };
        let all = Span { near: f64::NEG_INFINITY, leaves: wanted, ..Span::RAY };
        let stretch =
            Stretch { outer: from..to, inner: from.max(local.inner.start)..to.min(local.inner.end) };
        taylor::first_root(&line, &stretch, 0.0, &all, 4.0 * local.tolerance())
    }

    /// The one root of a bracket.
    #[inline(always)]
    pub(super) fn finish(&self, local: &Local, bracket: (f64, f64), sg: f64) -> f64 {
        let middle = 0.5 * (bracket.0 + bracket.1);
        match self.finish {
            Finish::Bracket => middle,
            Finish::Root => {
                let f = |along| self.outside_and_slope(local, along);
                newton::root(f, bracket, sg, middle, local.tolerance())
            }
        }
    }
}

impl Local {
    /// How far rounding may have moved any point of the ray near the surface.
    #[inline(always)]
    fn moved(&self) -> f64 {
        self.blur + BLUR * self.from.abs().max(self.to.abs())
    }

    /// The least squared distance from the axis between two places.
    #[inline(always)]
    fn closest_around(&self, from: f64, to: f64) -> f64 {
        if -self.b <= self.a * from {
            self.around(from)
        } else if -self.b >= self.a * to {
            self.around(to)
        } else {
            self.c - self.b * self.b / self.a
        }
    }
}

impl Slab {
    /// What rounding makes of the parabola, at most so far from the slab's middle, and of the height that it is asked for.
    #[inline(always)]
    fn rounding(&self, v: f64, height: f64, moved: f64) -> f64 {
        let slope = self.c1.abs() + 2.0 * self.c2.abs() * v.abs();
        4.0 * moved * slope
            + 16.0
                * f64::EPSILON
                * (self.c0.abs() + self.c1.abs() * (v.abs() + height) + self.c2.abs() * v * v)
    }
}

impl Quadratic {
    #[inline(always)]
    fn at(&self, s: f64) -> f64 {
        (self.a * s + 2.0 * self.b) * s + self.c
    }

    #[inline(always)]
    fn slope(&self, s: f64) -> f64 {
        2.0 * (self.a * s + self.b)
    }

    #[inline(always)]
    fn lowered(&self, by: f64) -> Self {
        Self { c: self.c - by, ..*self }
    }

    /// The first place from `from` to `to` where it is not positive, without cancellation.
    #[inline(always)]
    fn first_not_positive(&self, from: f64, to: f64) -> Option<f64> {
        if self.at(from) <= 0.0 {
            return Some(from);
        }
        let Self { a, b, c } = *self;
        let discriminant = b * b - a * c;
        if a > 0.0 {
            if discriminant < 0.0 {
                return None;
            }
            let root = discriminant.sqrt();
            let s = if b > 0.0 { -(b + root) / a } else { c / (root - b) };
            return (s >= from && s <= to).then_some(s);
        }
        // It opens downward, or is straight: having been positive, it ends below 0 for good.
        if self.at(to) > 0.0 {
            return None;
        }
        let root = discriminant.max(0.0).sqrt();
        let s = if b > 0.0 { -(b + root) / a } else { c / (root - b) };
        Some(s.clamp(from, to))
    }

    /// Where it is positive again after `from`, `to` at the latest.
    #[inline(always)]
    fn next_positive(&self, from: f64, to: f64) -> f64 {
        let Self { a, b, c } = *self;
        if a <= 0.0 {
            return to;
        }
        let root = (b * b - a * c).max(0.0).sqrt();
        let s = if b < 0.0 { (root - b) / a } else { c / (-b - root) };
        // Written so that what is not a number is the end.
        if s < to { s.max(from) } else { to }
    }
}
