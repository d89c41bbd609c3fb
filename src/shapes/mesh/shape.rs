//! Meshes as shapes.

use super::face::{Face, Leaving};
use super::hits::{Known, Last, NOTHING};
use super::memo::Memo;
use super::surface::Surface;
use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::ray::{Bracket, Drift, MISS, Ray, RayRange, Side};
use crate::geometry::ray_packet::{self, Nearest, PACKET_SIZE, RayPacket};
use crate::geometry::roots::Method;
use crate::geometry::sight::{Line, Sight};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use crate::shapes::plane::Plane;
use crate::simd::cpu::{Cpu, kernels};
use crate::text;
use crate::world::accuracy::{Accuracy, Bounded};
use crate::world::certify::{Enclosure, Found, Onward, Precise, Precision, Proven};
use crate::world::coincidence::{CLOSE, ROUNDING};
use crate::world::hittable::Hittable;
use crate::world::interaction::{SurfaceInteraction, turned};
use crate::world::packets::shape::{Packets, Proofs};
use crate::world::shape::{ByPackets, Shape};
use glam::{DMat3, DVec3};
use std::marker::PhantomData;
use std::sync::Arc;

/// A mesh of triangles.
pub struct Mesh<A> {
    surface: Arc<Surface>,
    /// Whether rays that leave the mesh may hit it again; in the notes, rays that leave an object do not.
    can_hit_itself: bool,
    accuracy: PhantomData<A>,
}

/// The number of vertices up to which they are mapped to find the box of a copy: a million copies of so many take two
/// seconds.
const MOST_MAPPED: usize = 1000;

/// Marks a shape that consists of faces, whose hits are proven face by face.
pub struct ByFaces;

impl<A: Bounded> Mesh<A> {
    /// Makes the shape of a surface.
    pub fn shape(surface: Arc<Surface>, accuracy: Accuracy) -> Shape<Self, ByPackets, ByFaces> {
        let can_hit_itself = accuracy != Accuracy::Classic;
        Shape::new(Self { surface, can_hit_itself, accuracy: PhantomData }).by()
    }

    /// Returns what a ray leaves that starts on the mesh, or may start on it.
    #[inline(always)]
    fn leaving(&self, origin_side: Option<Side>, origin_error: f64) -> Leaving {
        match origin_side {
            // The error is at least that of a hit point at the viewer.
            Some(_) => {
                let least = ROUNDING * self.surface.reach();
                Leaving { least, most: origin_error.max(least) }
            }
            None if origin_error > 0.0 => Leaving { least: -1.0, most: origin_error },
            None => NOTHING,
        }
    }

    /// Returns the bracket of a ray's first hit, and the face if it is known to be that of the hit point.
    #[inline(always)]
    fn bracket(
        &self,
        cpu: Cpu,
        ray: &Ray,
        range: &RayRange,
        last: &mut Last<Plane<A>>,
    ) -> (Bracket, Option<usize>) {
        if range.origin_side.is_some() && !self.can_hit_itself {
            return (Bracket::MISS, None);
        }
        self.surface.bracket(cpu, ray, range, self.leaving(range.origin_side, range.origin_error), last)
    }
}

/// The number of plain rays that take as long as the search for a ray's hit, 2 to 5 microseconds.
const RAYS_PER_SEARCH: u32 = 4;

impl<A: Bounded> Hittable for Mesh<A> {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if range.origin_side.is_none() {
            return self.surface.distance::<A>(ray, range, -1.0);
        }
        if !self.can_hit_itself {
            return MISS;
        }
        // The ray starts at the nearest face, however far that is from the rounded origin.
        let nearest = 2.0 * self.surface.nearest(ray.origin).0;
        let leaves = range.origin_error.max(ROUNDING * self.surface.reach()).max(nearest);
        self.surface.distance::<A>(ray, range, leaves)
    }

    /// The normal of the nearest face.
    fn normal(&self, at: DVec3) -> DVec3 {
        self.surface.triangle::<A>(self.surface.face_at(at)).plane.normal
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        self.surface.smoothed(self.surface.face_at(at), at, normal)
    }

    fn bounds(&self) -> Option<Aabb> {
        Some(self.surface.bounds)
    }

    fn bounds_after(&self, linear: &DMat3) -> Option<Aabb> {
        let vertices = &self.surface.vertices;
        let around = || {
            vertices
                .iter()
                .map(|at| *linear * *at)
                .fold(Aabb::EMPTY, |all, at| all.and(&Aabb { low: at, high: at }))
        };
        (vertices.len() <= MOST_MAPPED).then(around)
    }

    fn can_hit_itself(&self, _leaving: Side) -> bool {
        self.can_hit_itself
    }

    fn is_two_sided(&self) -> bool {
        self.surface.open_edges == 0
    }

    fn may_be_costly(&self) -> bool {
        true
    }

    fn search_cost(&self, _ray: &Ray, _origin_side: Option<Side>) -> u32 {
        RAYS_PER_SEARCH
    }

    fn method(&self) -> String {
        let Surface { open_edges, tree, .. } = &*self.surface;
        let sides = match open_edges {
            0 => "closed, and so lit on both sides".to_owned(),
            1 => "open at 1 edge, and so lit on one side".to_owned(),
            _ => format!("open at {open_edges} edges, and so lit on one side"),
        };
        let nodes = text::count(tree.nodes.len(), "node");
        format!("a tree of {nodes} over {}; {sides}", text::count(self.surface.face_count(), "face"))
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        let nearest = self.surface.nearest(from).0;
        Some((nearest - SLACK * (from.abs().max_element() + self.reach())).max(0.0))
    }

    fn part(&self, ray: &Ray, distance: f64) -> Option<String> {
        let face = distance.is_finite().then(|| self.surface.face_along(ray, distance))?;
        Some(format!("face {}", self.surface.order[face] + 1))
    }

    fn read_from_files(&self, each: &mut dyn FnMut(&[u8])) {
        self.surface.bytes_of(each);
    }
}

impl<A: Bounded> Proofs for Shape<Mesh<A>, ByPackets, ByFaces> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        self.shape.surface.touches::<A>(at, error)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        let surface = &self.shape.surface;
        let face = surface.face_along(ray, distance);
        let fine = surface.triangle::<A>(face).plane.exact_crossing(ray);
        // At an edge, the ray may hit the plane of a neighbouring face far from the edge.
        let size = distance + ray.origin.abs().max_element();
        ((fine.high - distance).abs() <= CLOSE * size).then_some(fine)
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        self.shape.surface.certify::<A>(sight, precision)
    }

    fn proven(&self) -> Option<&dyn Proven> {
        Some(&self.shape)
    }

    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}

impl<A: Bounded, F: Precise> Onward<F> for Mesh<A> {
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (Found<F>, usize) {
        self.surface.first_along::<A, F>(line, leaves)
    }

    fn slope(&self, at: [Dual<Interval<F>>; 3], part: usize) -> Dual<Interval<F>> {
        Onward::slope(&Face(self.surface.triangle::<A>(part)), at, 0)
    }

    fn shading_normal(
        &self,
        at: [Interval<F>; 3],
        part: usize,
        normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        self.surface.enclosed_normal(part, at, normal)
    }
}

impl<A: Bounded> Packets for Shape<Mesh<A>, ByPackets, ByFaces> {
    fn closest_hits(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        id: u64,
        nearest: Nearest,
    ) -> bool {
        let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
        let count = rays.len();
        Memo::with(|memo| {
            brackets(
                cpu,
                cpu,
                &self.shape,
                rays,
                sides,
                nearest.far,
                memo,
                &mut near[..count],
                &mut far[..count],
            );
        });
        ray_packet::closest_of_brackets(cpu, &near[..count], &far[..count], id, nearest)
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        t_max: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let (mut near, mut far) = ([MISS; PACKET_SIZE], [MISS; PACKET_SIZE]);
        let count = t_max.len();
        any_hits(cpu, cpu, &self.shape, rays, sides, t_max, blocked, &mut near[..count], &mut far[..count]);
        ray_packet::occluded_by_brackets(cpu, &near[..count], &far[..count], t_max, blocked, doubt)
    }

    fn refine(
        &self,
        _cpu: Cpu,
        rays: RayPacket,
        sides: Option<&[Side]>,
        (near, far): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let mesh = &self.shape;
        for lane in 0..out.len() {
            let leaving = mesh.leaving(sides.map(|sides| sides[lane]), rays.origin_error);
            let bracket = Bracket { near: near[lane], far: far[lane] };
            out[lane] = match bracket.near == bracket.far {
                true => bracket.near,
                false => mesh.surface.refined::<A>(&rays.get(lane), &RayRange::ALL, leaving, bracket),
            };
        }
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        let SurfaceInteraction { points, normals, sides, cosines, travelled } = interaction;
        Memo::with(|memo| {
            interact(cpu, &self.shape, rays, distances, memo, sides, cosines, travelled, points, normals);
        });
    }

    fn finds_normals_by_rays(&self) -> bool {
        true
    }

    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        self.shape.bracket(Cpu::best(), ray, range, &mut Last::none()).0
    }

    fn t_bounds_within(&self, ray: &Ray, range: &RayRange, drift: Drift) -> Bracket {
        self.shape.surface.bracket_within::<A>(Cpu::best(), ray, range, drift, &mut Last::none())
    }

    fn brackets_within(
        &self,
        cpu: Cpu,
        rays: RayPacket,
        drift: Drift,
        ends: &[f64],
        near: &mut [f64],
        far: &mut [f64],
    ) {
        brackets_within(cpu, cpu, &self.shape, rays, drift, ends, near, far);
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        let (leaving, range) =
            (self.shape.leaving(origin_side, 0.0), RayRange { origin_side, ..RayRange::ALL });
        match self.shape.surface.first(Cpu::best(), ray, &range, leaving, None, false) {
            Known::Face { face, .. } => self.shape.surface.plane::<A>(face).quick_crossing(ray),
            Known::Bracket(_) => f64::NAN,
        }
    }
}

/// Tells whether a ray of a packet is the one before it: arrays are padded with copies of the last ray.
#[inline(always)]
fn is_copy(rays: &RayPacket, lane: usize) -> bool {
    lane > 0 && {
        let (one, other) = (rays.get(lane), rays.get(lane - 1));
        one.dir == other.dir && one.origin == other.origin
    }
}

kernels! {
    /// Computes brackets of the distances of rays' first hits before `ends`.
    fn brackets[A: Bounded](
        level: Cpu, mesh: &Mesh<A>, rays: RayPacket, sides: Option<&[Side]>, ends: &[f64], memo: &mut Memo,
        near: &mut [f64], far: &mut [f64]
    ) {
        let (id, mut last) = (mesh.surface.id, Last::none());
        for lane in 0..near.len() {
            let origin_side = sides.map(|sides| sides[lane]);
            let range = RayRange { far: ends[lane], origin_side, origin_error: rays.origin_error, ..RayRange::ALL };
            if is_copy(&rays, lane) && ends[lane] == ends[lane - 1] {
                (near[lane], far[lane]) = (near[lane - 1], far[lane - 1]);
            } else {
                let ray = rays.get(lane);
                let (bracket, face) = mesh.bracket(level, &ray, &range, &mut last);
                (near[lane], far[lane]) = (bracket.near, bracket.far);
                if let Some(face) = face {
                    memo.note(id, &ray, bracket.near, face);
                }
            }
        }
    }

    /// Computes brackets of the distances of the first hits before `ends` of all rays within a drift of each ray.
    fn brackets_within[A: Bounded](
        level: Cpu, mesh: &Mesh<A>, rays: RayPacket, drift: Drift, ends: &[f64], near: &mut [f64], far: &mut [f64]
    ) {
        let mut last = Last::<Plane<A>>::none();
        for lane in 0..near.len() {
            if is_copy(&rays, lane) && ends[lane] == ends[lane - 1] {
                (near[lane], far[lane]) = (near[lane - 1], far[lane - 1]);
            } else {
                let range = RayRange { far: ends[lane], ..RayRange::ALL };
                let bracket = mesh.surface.bracket_within(level, &rays.get(lane), &range, drift, &mut last);
                (near[lane], far[lane]) = (bracket.near, bracket.far);
            }
        }
    }

    /// Computes brackets of the distances of any hits of rays before `ends`, except for rays that are blocked already.
    fn any_hits[A: Bounded](
        level: Cpu, mesh: &Mesh<A>, rays: RayPacket, sides: Option<&[Side]>, ends: &[f64], blocked: &[u64],
        near: &mut [f64], far: &mut [f64]
    ) {
        for lane in 0..near.len() {
            let origin_side = sides.map(|sides| sides[lane]);
            let (end, ray) = (ends[lane], rays.get(lane));
            if end <= 0.0 || blocked[lane] != 0 || origin_side.is_some() && !mesh.can_hit_itself {
                continue;
            }
            if is_copy(&rays, lane) && end == ends[lane - 1] {
                (near[lane], far[lane]) = (near[lane - 1], far[lane - 1]);
                continue;
            }
            let range = RayRange { far: end, origin_side, ..RayRange::ALL };
            let leaving = mesh.leaving(origin_side, rays.origin_error);
            let known = mesh.surface.first(level, &ray, &range, leaving, None, true);
            let (Known::Face { bracket, .. } | Known::Bracket(bracket)) = known;
            (near[lane], far[lane]) = (bracket.near, bracket.far);
        }
    }

    /// Computes the points, normals and sides that rays hit at these distances, in world units.
    fn interact[A: Bounded](
        mesh: &Mesh<A>, rays: RayPacket, distances: &[f64], memo: &Memo, sides: &mut [Side],
        cosines: &mut [f64], travelled: &mut [f64]
    ) => points, normals {
        let (is_two_sided, mut last) = (mesh.is_two_sided(), Last::none());
        for lane in 0..travelled.len() {
            let ray = rays.get(lane);
            if is_copy(&rays, lane) && distances[lane] == distances[lane - 1] {
                (sides[lane], cosines[lane]) = (sides[lane - 1], cosines[lane - 1]);
                points.set(lane, points.get(lane - 1));
                normals.set(lane, normals.get(lane - 1));
            } else {
                let point = ray.at(distances[lane]);
                let noted = memo.face(mesh.surface.id, &ray, distances[lane]);
                let face = noted.unwrap_or_else(|| mesh.surface.face_along(&ray, distances[lane]));
                let flat = *last.of(face, |face| mesh.surface.triangle::<A>(face).plane.normal);
                let turn;
                (sides[lane], cosines[lane], turn) = turned(ray.dir, flat, is_two_sided);
                points.set(lane, point);
                normals.set(lane, mesh.surface.smoothed(face, point, turn));
            }
            travelled[lane] += distances[lane];
        }
    }
}
