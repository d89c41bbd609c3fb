//! The search along one ray with a first hit that plain arithmetic leaves in doubt.
//!
//! The ray goes through the slabs again, from a base near the surface that is accurate to the last digit. Where it
//! grazes a slab's shell, bounds of the second derivative decide on that short piece.

use super::bracket::cross;
use super::lanes::Lanes;
use super::line::{ProfileOnRay, Uncut};
use super::local::Local;
use super::surface::Revolution;
use glam::DVec3;
use std::slice::from_ref;
use tabray_exact::roots::Method;
use tabray_exact::roots::stretch::Stretch;
use tabray_exact::roots::taylor::{self, FirstRoot, SignChange};
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::View;

/// A ray with a smaller direction component along the axis stays in one slab, and is not divided by this component.
const LEVEL: f64 = 1e-200;

/// The maximum number of examined pieces along one ray, in all slabs together, which takes some milliseconds. With more
/// pieces, the ray's hits are not proven.
const MAX_PIECES: usize = 1024;

/// The number of plain rays that take as long as a piece, including pieces that bounds in `f64` leave undecided.
const RAYS_PER_PIECE: usize = 4;

/// The number of slabs that count as one plain ray.
const SLABS_PER_RAY: usize = 256;

/// The result of a search.
struct SearchResult {
    /// The distance of the first hit, in world units.
    distance: f64,
    /// Whether the distance is certain for all rays that may have been rounded to this one.
    is_certain: bool,
    /// The number of examined pieces.
    pieces: usize,
}

impl Revolution {
    /// Returns the distance of a ray's first hit in a range, and whether it is certain for all rays that may have been
    /// rounded to this one.
    pub fn first_hit(&self, frame: &Frame, ray: &Ray, range: &RayRange) -> (f64, bool) {
        let SearchResult { distance, is_certain, .. } = self.search(frame, ray, range);
        (distance, is_certain)
    }

    /// Returns a bracket of the first hits in a range, for all rays that `ray` stands for.
    pub fn bracket(&self, frame: &Frame, ray: &RayBall, range: &RayRange) -> Bracket {
        let lanes = self.alone(frame, ray, range.origin_side);
        let (near, far) = (lanes.near[0], lanes.far[0]);
        if near == MISS || far < MISS {
            return Bracket { near, far };
        }
        let Some(local) = self.local(frame, ray, range) else { return Bracket::MISS };
        let (distance, is_certain) = self.walk(&local, range.origin_side, lanes, &mut MAX_PIECES.clone());
        if !is_certain {
            return Bracket::UNKNOWN;
        }
        if distance == MISS {
            return Bracket::MISS;
        }
        let root = distance - local.base;
        let rounding = 4.0 * f64::EPSILON * (local.base.abs() + root.abs());
        let width = 4.0 * (local.blur + local.turn * root.abs()) + rounding;
        taylor::bracket(&ProfileOnRay { surface: self, local: &local }, root, width).map_or(
            Bracket::UNKNOWN,
            |SignChange { low, high, .. }| Bracket {
                near: (local.base + low - rounding).max(0.0),
                far: local.base + high + rounding,
            },
        )
    }

    /// Returns the part of a ray in the bounding cylinder.
    fn local(&self, frame: &Frame, ray: &RayBall, range: &RayRange) -> Option<Local> {
        Local::new(frame, ray, range, self.height, self.slabs.reach().sqrt())
    }

    /// Brackets one ray in plain arithmetic.
    fn alone(&self, frame: &Frame, ray: &RayBall, origin_side: Option<Side>) -> Lanes<1> {
        let rays = RayPacket::new(view(&ray.ray.origin), view(&ray.ray.dir), 0.0);
        let rays = RayPacket { drift: ray.drift, ..rays.leaving(origin_side.as_ref().map(from_ref)) };
        let mut lanes = Lanes::none();
        self.t_bounds(Cpu::best(), frame, rays, &[MISS], &mut lanes);
        lanes
    }

    /// Returns the number of plain rays that take as long as the search for the first hit of a ray that may leave the
    /// surface to a side. It depends on nothing else, so that a pixel's cost limit is the same however its rays are
    /// traced.
    pub fn search_cost(&self, frame: &Frame, ray: &Ray, origin_side: Option<Side>) -> u32 {
        let range = RayRange { origin_side, ..RayRange::ALL };
        if self.local(frame, &ray.into(), &range).is_none() {
            return 0;
        }
        let pieces = if self.slabs.is_tight() { 0 } else { self.search(frame, ray, &range).pieces };
        // The search for a plain hit takes as long as a plain ray, and is done twice.
        (self.slabs.count() / SLABS_PER_RAY + RAYS_PER_PIECE * pieces).max(1) as u32
    }

    /// Tells whether the search for a ray's first hit may take as long as several plain rays.
    pub fn may_be_costly(&self) -> bool {
        self.slabs.count() >= SLABS_PER_RAY || !self.slabs.is_tight()
    }

    /// Searches for a ray's first hit in a range.
    fn search(&self, frame: &Frame, ray: &Ray, range: &RayRange) -> SearchResult {
        let lanes = self.alone(frame, &ray.into(), range.origin_side);
        let (near, far) = (lanes.near[0], lanes.far[0]);
        let known = |distance| SearchResult { distance, is_certain: true, pieces: 0 };
        if near == MISS {
            known(MISS)
        } else if far < MISS {
            known(range.keep(self.root(frame, ray, (near, far))))
        } else {
            self.local(frame, &ray.into(), range).map_or(known(MISS), |local| {
                let mut left = MAX_PIECES;
                let (distance, is_certain) = self.walk(&local, range.origin_side, lanes, &mut left);
                SearchResult { distance: range.keep(distance), is_certain, pieces: MAX_PIECES - left }
            })
        }
    }

    /// Finds the first hit, like [`first_hit`](Self::first_hit), but by another method, in the same bounding cylinder.
    /// Only the course notes' steps search all of the ray between the surface's heights, as in the notes.
    pub fn first_hit_by(&self, method: Method, frame: &Frame, ray: &Ray, range: &RayRange) -> f64 {
        let widest = if method == Method::Steps { f64::INFINITY } else { self.slabs.widest() };
        let Some(local) = Local::new(frame, &ray.into(), range, self.height, widest) else { return MISS };
        let line = Uncut { surface: self, local: &local };
        let shortest = 4.0 * local.tolerance();
        match method.first_root(&line, local.from..local.to, local.base, range, shortest) {
            Some(along) => range.keep(local.base + along),
            None => MISS,
        }
    }

    /// Returns the distance of the first crossing of the surface, and whether it is certain for all rays that may have
    /// been rounded to this one. For a ray that leaves the surface to a side, only crossings from that side count.
    /// Examines at most `left` pieces of the ray, and subtracts their number from `left`.
    fn walk(
        &self,
        local: &Local,
        origin_side: Option<Side>,
        mut lanes: Lanes<1>,
        left: &mut usize,
    ) -> (f64, bool) {
        let (size, cpu) = (self.size(), Cpu::best());
        lanes.prepare(1, origin_side.as_ref().map(from_ref));
        let own = Ray { origin: local.origin, dir: local.dir };
        lanes.set(0, own, (local.base, local.moved()), (local.from, local.to), self.slabs.widest());
        lanes.near[0] = MISS;
        let is_level = local.dir.y.abs() < LEVEL;
        let is_upward = local.dir.y > 0.0;
        let (mut index, mut wanted, mut is_certain) =
            (self.slabs.index(local.height(local.from)), origin_side, true);
        loop {
            let mut slab = self.slab(index);
            if is_level {
                (slab.from, slab.to) = (f64::NEG_INFINITY, f64::INFINITY);
            }
            let (from, to) = lanes.part(&slab, 0);
            if slab.is_void {
                // Where the surface narrows to the axis, rounding may decide on which side of its end a ray is.
                let margin = self.slabs.coarsest() + lanes.rounding[0];
                is_certain &= lanes.around(0).at(from) > margin && lanes.around(0).at(to) > margin;
                // Through the tip, where no crossing is told from a touch, a ray along the axis leaves the inside.
                let is_on_axis = lanes.around(0).at(from) <= lanes.rounding[0];
                if lanes.side[0] < 0.0 && from < to && is_on_axis {
                    return (local.base + from, false);
                }
                wanted = None;
            }
            cross(cpu, &mut lanes, &slab, size, 0.0, 1);
            let (near, far) = (lanes.near[0], lanes.far[0]);
            if local.inner.start < near && far < local.inner.end {
                let bracket = lanes.counted_from_origin(0, (near, far));
                return (self.root(&local.frame, &local.ray, bracket), is_certain);
            }
            if near < MISS {
                let shell = lanes.shell(0, &slab, (from, to), size, 0.0);
                let (end, is_across) = shell.end(near);
                let found = self.first_crossing(local, (near, end), wanted, left);
                is_certain &= found.is_certain && (found.root.is_some() || !is_across);
                // A ray that is on the other side has crossed the surface.
                if let Some(root) = found.root.or(is_across.then_some(near)) {
                    return (local.base + root, is_certain);
                }
                (lanes.near[0], lanes.far[0]) = (MISS, MISS);
                if shell.is_side_unknown {
                    (lanes.from[0], lanes.is_free[0]) = (to, 1.0);
                }
            }
            let is_last = is_level || if is_upward { index + 1 == self.slabs.count() } else { index == 0 };
            if is_last || to >= local.to || local.base + to >= local.far {
                return (MISS, is_certain);
            }
            index = if is_upward { index + 1 } else { index - 1 };
        }
    }

    /// Returns the first crossing on a short piece, only from one side if a side is given. It stays unknown if no
    /// pieces are left.
    fn first_crossing(
        &self,
        local: &Local,
        (from, to): (f64, f64),
        wanted: Option<Side>,
        left: &mut usize,
    ) -> FirstRoot {
        if *left == 0 {
            return FirstRoot { root: None, is_certain: false };
        }
        // The ends of the piece may themselves be crossings, because shells begin and end there, unless the ray begins
        // there.
        let (from, to) = (from.next_down().max(local.from), to.next_up());
        let line = ProfileOnRay { surface: self, local };
        let all = RayRange { near: f64::NEG_INFINITY, origin_side: wanted, ..RayRange::ALL };
        let stretch =
            Stretch { outer: from..to, inner: from.max(local.inner.start)..to.min(local.inner.end) };
        taylor::first_root_within(&line, &stretch, 0.0, &all, 4.0 * local.tolerance(), left)
    }
}

fn view(of: &DVec3) -> View<'_> {
    View { x: from_ref(&of.x), y: from_ref(&of.y), z: from_ref(&of.z) }
}
