//! Brackets of the first hits of rays, slab by slab for all of them at once, in plain arithmetic without branches.
//!
//! In a slab the surface lies between two quadrics, the parabola's with its error added and taken away. A ray that
//! misses the nearer one misses the surface; one that crosses both while falling all the way has one root between
//! them, bracketed by the error. Where a ray grazes the shell between them, starts in it, runs along the axis or upright
//! on it, or crosses the surface where slabs meet, the bracket says no more than where that begins, and the ray goes its
//! way alone (`walk`), through the same slabs.

use super::lanes::{Crossing, Lanes};
use super::pieces::Slab;
use super::quadratic::Quadratic;
use super::surface::Revolution;
use crate::geometry::aabb::{from_order, larger, order, smaller};
use crate::geometry::frame::Frame;
use crate::geometry::ray::{MISS, Ray, Side};
use crate::geometry::ray_packet::RayPacket;
use crate::simd::cpu::{Cpu, kernels};

/// A direction with less than this of an axis is taken for upright on it.
const UPRIGHT: f64 = 1e-9;

/// The most rays that go together: few enough for what is computed of them to stay near the processor, and for slabs
/// that no ray comes to.
pub(super) const MOST: usize = 64;

impl Revolution {
    /// The brackets of the first hits of rays, up to `N`, which may leave the surface on these sides. What begins beyond
    /// `ends` is of no interest.
    pub(super) fn t_bounds<const N: usize>(
        &self,
        cpu: Cpu,
        frame: &Frame,
        rays: RayPacket,
        sides: Option<&[Side]>,
        ends: &[f64],
        lanes: &mut Lanes<N>,
    ) {
        lanes.begin(rays.len(), sides);
        let reach = self.slabs.reach();
        if let Some((low, high)) = enter(cpu, lanes, frame, rays, self.size(), reach, ends) {
            let (first, last) = (self.slabs.index(low), self.slabs.index(high));
            for step in 0..=last - first {
                let index = if lanes.dy[0] > 0.0 { first + step } else { last - step };
                cross(cpu, lanes, &self.slab(index), self.size(), rays.origin_error, rays.len());
            }
        }
        leave(cpu, lanes, rays.len());
    }

    /// How high and how wide it is.
    pub(super) fn size(&self) -> [f64; 2] {
        [self.height, self.slabs.widest()]
    }

    /// A slab. The lowest and the highest go on, for what rounding cuts off.
    pub(super) fn slab(&self, index: usize) -> Slab {
        let slab = self.slabs.get(index);
        Slab {
            from: if index == 0 { f64::NEG_INFINITY } else { slab.from },
            to: if index + 1 == self.slabs.count() { f64::INFINITY } else { slab.to },
            ..*slab
        }
    }
}

kernels! {
    /// Counts rays from near the axis and clips them to the bounding cylinder, whose squared radius `reach` has room
    /// for the error's shell. Gives the least and the greatest height of any ray in it, or nothing where all miss it.
    fn enter<const N>(
        lanes: &mut Lanes<N>, frame: &Frame, rays: RayPacket, size: [f64; 2], reach: f64, ends: &[f64]
    ) -> Option<(f64, f64)> {
        let count = rays.len().min(N);
        let (rays, ends, [height, widest]) = (rays.first(count), &ends[..count], size);
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

            let inverse_dy = 1.0 / dir.y;
            let (bottom, top) = (-moved.y * inverse_dy, (height - moved.y) * inverse_dy);
            let hair = 2.0 * off * inverse_dy.abs() + 16.0 * f64::EPSILON * (bottom.abs() + top.abs() + base);
            let (first, last) = if bottom < top { (bottom - hair, top + hair) } else { (top - hair, bottom + hair) };
            let (inward, outward, room) = Quadratic::around(moved, dir).lowered(reach).between(inverse_a);
            let from = larger(larger(-base, first), inward);
            let to = smaller(last, outward);

            let is_upright = (a < UPRIGHT * UPRIGHT) | (dir.y.abs() < UPRIGHT);
            let is_missed = !is_upright & ((room < 0.0) | (from > to) | (from + base > ends[lane]));
            let is_in = !is_upright & !is_missed;
            lanes.put(lane, Ray { origin: moved, dir }, (base, off), (from, to), widest);
            // Others take no part.
            lanes.from[lane] = if is_in { from } else { f64::INFINITY };
            lanes.to[lane] = if is_in { to } else { f64::NEG_INFINITY };
            lanes.hair[lane] = hair;
            lanes.near[lane] = if is_upright { -base } else { MISS };
            let (one, other) = (moved.y + from * dir.y, moved.y + to * dir.y);
            low = low.min(if is_in { order(smaller(one, other)) } else { i64::MAX });
            high = high.max(if is_in { order(larger(one, other)) } else { i64::MIN });
        }
        (low <= high).then(|| (from_order(low), from_order(high)))
    }

    /// Compares the brackets with those of a slab, of a surface of this size.
    pub(super) fn cross<const N>(
        lanes: &mut Lanes<N>, slab: &Slab, size: [f64; 2], origin_error: f64, count: usize
    ) {
        let count = count.min(N);
        let mut is_close = [0; N];
        let mut any = 0;
        for lane in 0..count {
            is_close[lane] = u64::from(lanes.may_meet(lane, slab, lanes.part(slab, lane)));
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
            let shell = lanes.shell(lane, slab, lanes.part(slab, lane), size, origin_error);
            let Crossing { is_met, near, is_certain, far } = shell.crossing();
            let is_close = is_close[lane] != 0;
            let is_nearer = is_close & is_met & (near < lanes.near[lane]);
            lanes.near[lane] = if is_nearer { near } else { lanes.near[lane] };
            lanes.far[lane] = if is_nearer { if is_certain { far } else { MISS } } else { lanes.far[lane] };
            lanes.side[lane] = if is_close { shell.side } else { lanes.side[lane] };
        }
    }

    /// Counts the brackets from the rays' origins, a hair wider.
    fn leave<const N>(lanes: &mut Lanes<N>, count: usize) {
        let count = count.min(N);
        for lane in 0..count {
            let (near, far, hair) = (lanes.near[lane], lanes.far[lane], 2.0 * lanes.hair[lane]);
            let (low, high) = lanes.counted_from_origin(lane, (near, far));
            let is_met = near < MISS;
            // Rounding may have made an end of the cylinder a part of the surface.
            let is_certain = (far < MISS) & (near > lanes.from[lane] + hair) & (far < lanes.to[lane] - hair);
            lanes.near[lane] = if is_met { low } else { MISS };
            lanes.far[lane] = if is_certain & (low > 0.0) { high } else { MISS };
        }
    }
}
