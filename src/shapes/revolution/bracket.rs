//! Brackets of the first hits of rays, slab by slab for all rays at once, in plain arithmetic without branches.
//!
//! In a slab, the surface lies in a shell between two quadrics: that of the parabola, with its error added and
//! subtracted. A ray that misses the nearer one misses the surface. A ray that crosses both, while its distance from
//! the surface falls all the way, has one root between them, bracketed by the error. In other cases, the bracket only
//! has a lower end, and the ray is traced alone through the same slabs (`walk`): the ray grazes the shell or starts in
//! it, runs parallel or perpendicular to the axis, or crosses the surface where slabs meet.

use super::lanes::{Crossing, Lanes};
use super::quadratic::Quadratic;
use super::slab::Slab;
use super::surface::Revolution;
use tabray_world::geometry::aabb::{from_order, larger, order, smaller};
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::ray::{MISS, Ray};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::cpu::{Cpu, kernels};

/// Rays with a smaller component of the unit direction along the axis, or perpendicular to it, are traced alone.
const MIN_COMPONENT: f64 = 1e-9;

/// The margin of a slab's largest square, as a multiple of a ray's rounding error.
const MARGIN: f64 = 4.0;

/// The maximum distance between a ray and the rays that it stands for, as a fraction of the surface's radius. Rays with
/// a larger spread are traced alone.
const MAX_OFFSET: f64 = 1e-4;

/// The maximum number of rays that are bracketed together. It is small enough to keep their data in the cache, and to
/// skip slabs that none of them reaches.
pub(super) const MAX_RAYS: usize = 64;

impl Revolution {
    /// Computes brackets of the first hits, for all rays that each of up to `N` rays stands for. Hits beyond `ends`, in
    /// world units, do not matter.
    pub(super) fn t_bounds<const N: usize>(
        &self,
        cpu: Cpu,
        frame: &Frame,
        rays: RayPacket,
        ends: &[f64],
        lanes: &mut Lanes<N>,
    ) {
        lanes.prepare(rays.len(), rays.leaving);
        if !rays.drift.is_none() {
            spread(cpu, lanes, frame, rays, self.size());
        }
        let reach = self.slabs.reach();
        if let Some((low, high)) = enter(cpu, lanes, frame, rays, self.size(), reach, ends) {
            let (first, last) = (self.slabs.index(low), self.slabs.index(high));
            let mut step = 0;
            while step <= last - first {
                let index = if lanes.dy[0] > 0.0 { first + step } else { last - step };
                let may_meet = |run: &Slab| may_meet_any(cpu, lanes, run, rays.len());
                let skipped = self.slabs.skipped(index, lanes.dy[0] > 0.0, first..last + 1, may_meet);
                if skipped == 0 {
                    cross(cpu, lanes, &self.slab(index), self.size(), rays.origin_error, rays.len());
                }
                step += skipped.max(1);
            }
        }
        leave(cpu, lanes, rays.len());
    }

    /// Returns the height of the surface and its maximum distance from the axis, in world units.
    pub(super) fn size(&self) -> [f64; 2] {
        [self.height, self.slabs.widest()]
    }

    /// Returns a slab. The lowest and the highest slab extend to infinity, so that rounding cuts nothing off.
    pub(super) fn slab(&self, index: usize) -> Slab {
        self.slabs.extended(self.slabs.get(index), index..index + 1)
    }
}

kernels! {
    /// Sets the maximum distance of all rays within a drift from their ray, in the range of the surface. Counted from
    /// the point closest to the axis, this range is at most the radius divided by the direction's component across the
    /// axis.
    fn spread<const N>(lanes: &mut Lanes<N>, frame: &Frame, rays: RayPacket, size: [f64; 2]) {
        let count = rays.len().min(N);
        let (rays, [height, widest]) = (rays.first(count), size);
        for lane in 0..count {
            let Ray { origin, dir } = frame.ray(&rays.get(lane));
            let a = dir.x * dir.x + dir.z * dir.z;
            let closest = larger(-(origin.x * dir.x + origin.z * dir.z) / a, 0.0);
            let across = closest + 2.0 * widest / a.sqrt();
            let along = (origin.y.abs() + height) / dir.y.abs();
            lanes.off[lane] = rays.drift.origin + rays.drift.dir * smaller(across, along);
        }
    }

    /// Sets up rays relative to a base near the axis, and clips them to the bounding cylinder. Its squared radius,
    /// `reach`, includes the shell of the error. Returns the minimum and the maximum height of all rays in it, or
    /// `None` if all miss it.
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
            // The rounding error of that point, in units of EPSILON. The errors of each coordinate of the origin are
            // 1/2 in its difference from the frame's, 3 in the axes, and 3/2 in the rotation: 5, times sqrt(3) for
            // three axes, is below 9. The errors of the direction are sqrt(3) of 3 in the axes and 3/2 in the rotation,
            // 1 for a camera ray's rounded direction, and 1 for the point along the ray: below 10.
            let off = 12.0 * f64::EPSILON * (origin.abs().element_sum() + base) + lanes.off[lane];
            let is_wide = lanes.off[lane] > MAX_OFFSET * widest;

            let inverse_dy = 1.0 / dir.y;
            let (bottom, top) = (-moved.y * inverse_dy, (height - moved.y) * inverse_dy);
            // The hits in `tests/slow/truth.rs` test this margin.
            let end_error = 2.0 * off * inverse_dy.abs() + 16.0 * f64::EPSILON * (bottom.abs() + top.abs() + base);
            let (first, last) = if bottom < top { (bottom, top) } else { (top, bottom) };
            let (first, last) = (first - end_error, last + end_error);
            let (inward, outward, discriminant) = Quadratic::around(moved, dir).lowered(reach).between(inverse_a);
            let from = larger(larger(-base, first), inward);
            let to = smaller(last, outward);

            let is_aligned = (a < MIN_COMPONENT * MIN_COMPONENT) | (dir.y.abs() < MIN_COMPONENT) | is_wide;
            let is_missed = !is_aligned & ((discriminant < 0.0) | (from > to) | (from + base > ends[lane]));
            let is_in = !is_aligned & !is_missed;
            lanes.set(lane, Ray { origin: moved, dir }, (base, off), (from, to), widest);
            // Other rays take no part.
            lanes.from[lane] = if is_in { from } else { f64::INFINITY };
            lanes.to[lane] = if is_in { to } else { f64::NEG_INFINITY };
            lanes.end_error[lane] = end_error;
            lanes.near[lane] = if is_aligned { -base } else { MISS };
            let (one, other) = (moved.y + from * dir.y, moved.y + to * dir.y);
            low = low.min(if is_in { order(smaller(one, other)) } else { i64::MAX });
            high = high.max(if is_in { order(larger(one, other)) } else { i64::MIN });
        }
        (low <= high).then(|| (from_order(low), from_order(high)))
    }

    /// Returns whether any ray may hit the surface in a run of slabs before its hit so far. The margin is twice that of
    /// the slabs, because a ray's squared distance from the axis rounds differently at another point.
    fn may_meet_any<const N>(lanes: &Lanes<N>, run: &Slab, count: usize) -> bool {
        let count = count.min(N);
        let mut any = 0;
        for lane in 0..count {
            any |= u64::from(lanes.may_meet(lane, run, lanes.part(run, lane), 2.0 * MARGIN));
        }
        any != 0
    }

    /// Merges the hits in a slab into the brackets. `size` is the height and the maximum radius of the surface.
    pub(super) fn cross<const N>(
        lanes: &mut Lanes<N>, slab: &Slab, size: [f64; 2], origin_error: f64, count: usize
    ) {
        let count = count.min(N);
        let mut is_close = [0; N];
        let mut any = 0;
        for lane in 0..count {
            is_close[lane] = u64::from(lanes.may_meet(lane, slab, lanes.part(slab, lane), MARGIN));
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

    /// Converts the brackets to distances from the rays' origins, widened by their rounding errors.
    fn leave<const N>(lanes: &mut Lanes<N>, count: usize) {
        let count = count.min(N);
        for lane in 0..count {
            let (near, far, margin) = (lanes.near[lane], lanes.far[lane], 2.0 * lanes.end_error[lane]);
            let (low, high) = lanes.counted_from_origin(lane, (near, far));
            let is_met = near < MISS;
            // Rounding may have confused an end of the cylinder with a part of the surface.
            let is_certain = (far < MISS) & (near > lanes.from[lane] + margin) & (far < lanes.to[lane] - margin);
            lanes.near[lane] = if is_met { low } else { MISS };
            lanes.far[lane] = if is_certain & (low > 0.0) { high } else { MISS };
        }
    }
}
