//! Brackets of the first hits of a packet of rays, slab by slab for all of them at once.
//!
//! It is what `walk` does, in plain arithmetic without branches, and with more room for rounding. Where a ray grazes
//! the error's shell, starts in it, runs along the axis or upright on it, or crosses the surface where slabs meet, the
//! bracket says no more than where that begins, and the ray goes its way alone.

use super::slabs::Slab;
use super::surface::{Revolution, sign};
use crate::geometry::bounds::{from_order, larger, order, smaller};
use crate::geometry::frame::Frame;
use crate::geometry::packet::Rays;
use crate::geometry::ray::{MISS, Ray, Side, Span};
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::{STEP, Vectors};
use glam::DVec3;

/// A direction with less than this of an axis is taken for upright on it.
const UPRIGHT: f64 = 1e-9;

/// The most rays that go together: few enough for what is computed of them to stay near the processor, and for slabs
/// that no ray comes to.
pub(super) const MOST: usize = 64;

/// Some rays of a packet, each counted from its point closest to the axis.
pub(super) struct Lanes {
    /// The height of that point, how fast the ray rises, and the reciprocal of that.
    y: [f64; MOST],
    dy: [f64; MOST],
    inverse_dy: [f64; MOST],
    /// The squared distance from the axis is `a s^2 + 2 b s + c`, and the least at `middle`.
    a: [f64; MOST],
    b: [f64; MOST],
    c: [f64; MOST],
    middle: [f64; MOST],
    /// Where the ray is in the surface's bounding cylinder.
    from: [f64; MOST],
    to: [f64; MOST],
    /// How far that point is from the ray's origin, and how far off it may be.
    base: [f64; MOST],
    off: [f64; MOST],
    /// What rounding makes of the quadratic, and of the places where the ray comes to the cylinder's ends.
    rounding: [f64; MOST],
    hair: [f64; MOST],
    /// 1 where the ray is outside of the surface, -1 where it is inside.
    side: [f64; MOST],
    /// 1 where the ray does not start on the surface.
    is_free: [f64; MOST],
    /// The bracket so far, counted as `from`; in the end from the ray's origin.
    pub near: [f64; MOST],
    pub far: [f64; MOST],
}

impl Lanes {
    /// None yet.
    pub fn none() -> Self {
        let zero = [0.0; MOST];
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

    /// So many rays that leave the surface on these sides, or begin elsewhere.
    fn begin(&mut self, count: usize, sides: Option<&[Side]>) {
        match sides {
            None => {
                self.side[..count].fill(1.0);
                self.is_free[..count].fill(1.0);
            }
            Some(sides) => {
                for (lane, side) in sides.iter().enumerate() {
                    self.side[lane] = sign(*side);
                }
                self.is_free[..count].fill(0.0);
            }
        }
        self.far[..count].fill(MISS);
    }
}

impl Revolution {
    /// The brackets of the first hits of rays, up to [`MOST`], which may leave the surface on these sides. What begins
    /// beyond `ends` is of no interest.
    pub(super) fn bracket(
        &self,
        cpu: Cpu,
        frame: &Frame,
        rays: Rays,
        sides: Option<&[Side]>,
        ends: &[f64],
        lanes: &mut Lanes,
    ) {
        lanes.begin(rays.len(), sides);
        let (widest, reach) = (self.slabs.widest(), self.slabs.reach());
        let heights = enter(cpu, lanes, frame, rays, self.height, widest, reach, ends);
        if let Some((low, high)) = heights {
            let (first, last) = (self.slabs.index(low), self.slabs.index(high));
            for step in 0..=last - first {
                let index = if lanes.dy[0] > 0.0 { first + step } else { last - step };
                let slab = self.slabs.get(index);
                // The lowest and the highest go on, for what rounding cuts off.
                let slab = Slab {
                    from: if index == 0 { f64::NEG_INFINITY } else { slab.from },
                    to: if index + 1 == self.slabs.count() { f64::INFINITY } else { slab.to },
                    ..*slab
                };
                cross(cpu, lanes, &slab, self.height, rays.origin_error, widest, rays.len());
            }
        }
        leave(cpu, lanes, rays.len());
    }

    /// The distance of a ray's first hit within a span, and whether it is that of all rays that this one was rounded from.
    pub(super) fn distance(&self, frame: &Frame, ray: &Ray, within: &Span) -> (f64, bool) {
        let splat = |v: DVec3| Vectors::<STEP> { x: [v.x; STEP], y: [v.y; STEP], z: [v.z; STEP] };
        let (origin, dir) = (splat(ray.origin), splat(ray.dir));
        let rays = Rays { origin: origin.view(STEP), dir: dir.view(STEP), origin_error: 0.0 };
        let sides = within.leaves.map(|side| [side; STEP]);
        let sides = sides.as_ref().map(|sides| &sides[..]);
        let mut lanes = Lanes::none();
        self.bracket(Cpu::best(), frame, rays, sides, &[MISS; STEP], &mut lanes);
        let (near, far) = (lanes.near[0], lanes.far[0]);
        if near == MISS {
            (MISS, true)
        } else if far < MISS {
            let mut root = [near; STEP];
            self.roots(Cpu::best(), frame, rays, (&[near; STEP], &[far; STEP]), &mut root);
            (within.keep(root[0]), true)
        } else {
            self.first_hit(frame, ray, within)
        }
    }
}

kernels! {
    /// Counts rays from near the axis and clips them to the bounding cylinder, whose squared radius `reach` has room
    /// for the error's shell. Gives the least and the greatest height of any ray in it, or nothing where all miss it.
    fn enter(
        lanes: &mut Lanes, frame: &Frame, rays: Rays, height: f64, widest: f64, reach: f64, ends: &[f64]
    ) -> Option<(f64, f64)> {
        let count = rays.len().min(MOST);
        let (rays, ends) = (rays.first(count), &ends[..count]);
        let (mut low, mut high) = (i64::MAX, i64::MIN);
        for lane in 0..count {
            let Ray { origin, dir } = frame.ray(&rays.get(lane));
            let is_free = lanes.is_free[lane] != 0.0;
            let a = dir.x * dir.x + dir.z * dir.z;
            let inverse_a = 1.0 / a;
            let closest = -(origin.x * dir.x + origin.z * dir.z) * inverse_a;
            let base = if is_free & (closest > 0.0) { closest } else { 0.0 };
            let moved = origin + base * dir;
            // How far rounding moves that point, in units of EPSILON. Each coordinate of the origin: 1/2 in its difference
            // from the frame's, 3 in the axes, 3/2 in the turning; sqrt(3) of these 5 across three axes are below 9. The
            // direction: sqrt(3) of 3 in the axes and 3/2 in the turning, 1 for the ray of a real camera, which is that
            // far from one of f64, and 1 for the point on the way: below 10.
            let off = 12.0 * f64::EPSILON * (origin.abs().element_sum() + base);
            let (b, c) = (moved.x * dir.x + moved.z * dir.z, moved.x * moved.x + moved.z * moved.z);

            let inverse_dy = 1.0 / dir.y;
            let (bottom, top) = (-moved.y * inverse_dy, (height - moved.y) * inverse_dy);
            let hair = 2.0 * off * inverse_dy.abs() + 16.0 * f64::EPSILON * (bottom.abs() + top.abs() + base);
            let (first, last) = if bottom < top { (bottom - hair, top + hair) } else { (top - hair, bottom + hair) };
            let room = b * b - a * (c - reach);
            let root = if room > 0.0 { room } else { 0.0 }.sqrt();
            let (inward, outward) = ((-b - root) * inverse_a, (root - b) * inverse_a);
            let from = larger(larger(-base, first), inward);
            let to = smaller(last, outward);

            let is_upright = (a < UPRIGHT * UPRIGHT) | (dir.y.abs() < UPRIGHT);
            let is_missed = !is_upright & ((room < 0.0) | (from > to) | (from + base > ends[lane]));
            let is_in = !is_upright & !is_missed;
            lanes.y[lane] = moved.y;
            lanes.dy[lane] = dir.y;
            lanes.inverse_dy[lane] = inverse_dy;
            lanes.a[lane] = a;
            lanes.b[lane] = b;
            lanes.c[lane] = c;
            lanes.middle[lane] = -b * inverse_a;
            // Others take no part.
            lanes.from[lane] = if is_in { from } else { f64::INFINITY };
            lanes.to[lane] = if is_in { to } else { f64::NEG_INFINITY };
            lanes.base[lane] = base;
            lanes.off[lane] = off;
            let farthest = larger(from.abs(), to.abs());
            lanes.rounding[lane] =
                16.0 * f64::EPSILON * (c + a * farthest * farthest + widest * widest) + 4.0 * widest * off;
            lanes.hair[lane] = hair;
            lanes.near[lane] = if is_upright { -base } else { MISS };
            let (one, other) = (moved.y + from * dir.y, moved.y + to * dir.y);
            low = low.min(if is_in { order(smaller(one, other)) } else { i64::MAX });
            high = high.max(if is_in { order(larger(one, other)) } else { i64::MIN });
        }
        (low <= high).then(|| (from_order(low), from_order(high)))
    }

    /// Compares the brackets with those of a slab.
    fn cross(lanes: &mut Lanes, slab: &Slab, height: f64, origin_error: f64, widest: f64, count: usize) {
        let count = count.min(MOST);
        let mut is_close = [0; MOST];
        let mut any = 0;
        for lane in 0..count {
            let (from, to) = lanes.part(slab, lane);
            let closest = smaller(larger(lanes.middle[lane], from), to);
            let around = (lanes.a[lane] * closest + 2.0 * lanes.b[lane]) * closest + lanes.c[lane];
            let may_meet = (around <= slab.most + 4.0 * lanes.rounding[lane]) | (lanes.side[lane] < 0.0);
            is_close[lane] = u64::from((from < to) & (lanes.near[lane] > from) & may_meet);
            any |= is_close[lane];
        }
        if any == 0 {
            return;
        }
        if slab.is_void {
            for lane in 0..count {
                lanes.side[lane] = if is_close[lane] != 0 { 1.0 } else { lanes.side[lane] };
            }
            return;
        }
        for lane in 0..count {
            let (from, to) = lanes.part(slab, lane);
            let (a, b, c, dy) = (lanes.a[lane], lanes.b[lane], lanes.c[lane], lanes.dy[lane]);
            let v = lanes.y[lane] - slab.middle;
            let farthest = larger(larger((v + from * dy).abs(), (v + to * dy).abs()), v.abs());
            let slope = slab.c1.abs() + 2.0 * slab.c2.abs() * farthest;
            let rounding = lanes.rounding[lane] + 4.0 * lanes.off[lane] * slope
                + 16.0 * f64::EPSILON * (slab.c0.abs() + slab.c1.abs() * (farthest + height) + slab.c2.abs() * farthest * farthest);
            let error = slab.error + rounding;
            let slope_error = slab.slope_error * dy.abs();
            let (a, b) = (a - slab.c2 * dy * dy, b - (0.5 * slab.c1 + slab.c2 * v) * dy);
            let c = c - slab.parabola(v);
            // Where the ray comes into the cylinder it is seen on which side that is.
            let at_start = (a * from + 2.0 * b) * from + c;
            let is_start = (from == lanes.from[lane]) & (lanes.is_free[lane] != 0.0);
            let side = if is_start { 1.0_f64.copysign(at_start) } else { lanes.side[lane] };
            // In the shell it may be either; and rays that rise and that fall go through slabs in one order, so that
            // some come to a slab before their side is known.
            let start_error = error + 4.0 * origin_error * (widest + slope);
            let is_side_unknown = (is_start & (at_start.abs() <= start_error)) | (side * at_start < -error);
            let (a, b, c) = (side * a, side * b, side * c);
            // A crossing to the other side falls: begin where it can.
            let rises = 2.0 * (a * from + b) - slope_error - rounding;
            let begin = if rises > 0.0 { from - rises / (2.0 * a) } else { from };
            let never_falls = (rises > 0.0) & ((a >= 0.0) | (begin >= to));
            let outer = (a, b, c - error);
            let is_in_shell = at(outer, begin) <= 0.0;
            let (enters, is_entered) = first_not_positive(outer, begin, to);
            let inner = (a, b, c + error);
            let (leaves, is_left) = first_not_positive(inner, enters, to);
            let falls = larger(a * enters + b, a * leaves + b);
            let is_certain =
                !is_side_unknown & !is_in_shell & is_left & (2.0 * falls + slope_error + rounding < 0.0);
            let is_met = (is_close[lane] != 0)
                & (is_side_unknown | (!never_falls & (is_in_shell | is_entered)));
            let near = if is_side_unknown {
                from
            } else if is_in_shell {
                begin
            } else {
                enters
            };
            let is_nearer = is_met & (near < lanes.near[lane]);
            lanes.near[lane] = if is_nearer { near } else { lanes.near[lane] };
            lanes.far[lane] = if is_nearer { if is_certain { leaves } else { MISS } } else { lanes.far[lane] };
            lanes.side[lane] = if is_close[lane] != 0 { side } else { lanes.side[lane] };
        }
    }

    /// Counts the brackets from the rays' origins, a hair wider.
    fn leave(lanes: &mut Lanes, count: usize) {
        let count = count.min(MOST);
        for lane in 0..count {
            let (near, far, base) = (lanes.near[lane], lanes.far[lane], lanes.base[lane]);
            let hair = 2.0 * lanes.hair[lane];
            let is_met = near < MISS;
            // Rounding may have made an end of the cylinder a part of the surface.
            let is_certain = (far < MISS) & (near > lanes.from[lane] + hair) & (far < lanes.to[lane] - hair);
            let slack = 4.0 * lanes.off[lane] + 16.0 * f64::EPSILON * (base + near.abs());
            let low = larger(base + near - slack, 0.0);
            lanes.near[lane] = if is_met { low } else { MISS };
            lanes.far[lane] = if is_certain & (low > 0.0) { base + far + slack } else { MISS };
        }
    }
}

impl Lanes {
    /// The part of a ray in a slab.
    #[inline(always)]
    fn part(&self, slab: &Slab, lane: usize) -> (f64, f64) {
        let (y, inverse) = (self.y[lane], self.inverse_dy[lane]);
        let (one, other) = ((slab.from - y) * inverse, (slab.to - y) * inverse);
        (larger(self.from[lane], smaller(one, other)), smaller(self.to[lane], larger(one, other)))
    }
}

/// The value of `a s^2 + 2 b s + c`.
#[inline(always)]
fn at((a, b, c): (f64, f64, f64), s: f64) -> f64 {
    (a * s + 2.0 * b) * s + c
}

/// The first place where that is not positive, without cancellation, and whether there is one from `from` to `to`;
/// it is positive at `from`.
#[inline(always)]
fn first_not_positive(quadratic: (f64, f64, f64), from: f64, to: f64) -> (f64, bool) {
    let (a, b, c) = quadratic;
    let discriminant = b * b - a * c;
    let root = if discriminant > 0.0 { discriminant } else { 0.0 }.sqrt();
    let s = if b > 0.0 { -(b + root) } else { c } / if b > 0.0 { a } else { root - b };
    // One that opens downward, or is straight, ends below 0 for good.
    let is_there =
        if a > 0.0 { (discriminant >= 0.0) & (s >= from) & (s <= to) } else { at(quadratic, to) <= 0.0 };
    (smaller(larger(s, from), to), is_there)
}
