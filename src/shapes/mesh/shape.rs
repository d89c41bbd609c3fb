//! Meshes as shapes.

use super::face::{Face, Leaving};
use super::hits::NOTHING;
use super::memo::Memo;
use super::surface::Surface;
use super::winding::Openness;
use glam::{DMat3, DVec2, DVec3};
use std::marker::PhantomData;
use std::sync::Arc;
use tabray_exact::affine::Affine;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_world::accuracy::{Accuracy, NotClassic};
use tabray_world::certify::{
    Assumption, Enclosure, FootprintHit, HitEnclosure, HitProofs, OverFootprint, Precise, Precision, Premise,
    ProofMethods,
};
use tabray_world::coincidence::CLOSE;
use tabray_world::geometry::aabb::{Aabb, SLACK};
use tabray_world::geometry::facet::Facet;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use tabray_world::geometry::sight::{Line, Sight};
use tabray_world::hittable::{Facts, Hittable, Sides, SurfaceHit};
use tabray_world::luminous::{Luminous, Triangles};
use tabray_world::packets::shape::HitQueries;
use tabray_world::simd::cpu::Cpu;
use tabray_world::text;

/// A mesh of triangles.
pub struct Mesh<A> {
    pub(super) surface: Arc<Surface>,
    /// Whether rays that leave the mesh may hit it again. In the notes, rays that leave an object do not.
    pub(super) can_hit_itself: bool,
    accuracy: PhantomData<A>,
}

/// The maximum number of vertices that are mapped to find the box of a copy. A million copies with that many vertices
/// take two seconds.
const MAX_MAPPED: usize = 1000;

impl<A: NotClassic> Mesh<A> {
    /// Makes the shape of a surface.
    pub fn new(surface: Arc<Surface>, accuracy: Accuracy) -> Self {
        Self { surface, can_hit_itself: accuracy != Accuracy::Classic, accuracy: PhantomData }
    }

    /// Tells whether both sides of the surface are lit.
    pub(super) fn is_two_sided(&self) -> bool {
        self.surface.is_two_sided || self.surface.is_closed()
    }

    /// Returns the distances within which a ray leaves faces, if it starts or may start on the mesh.
    #[inline(always)]
    pub(super) fn leaving(&self, origin_side: Option<Side>, origin_error: f64) -> Leaving {
        match origin_side {
            // The error is at least that of a hit point at the viewer.
            Some(_) => {
                let least = self.surface.least_error();
                Leaving { least, most: origin_error.max(least) }
            }
            None if origin_error > 0.0 => Leaving { least: -1.0, most: origin_error },
            None => NOTHING,
        }
    }

    /// Returns the bracket of a ray's first hit, and the face if it is known to be that of the hit point.
    #[inline(always)]
    pub(super) fn bracket(&self, cpu: Cpu, ray: &Ray, range: &RayRange) -> (Bracket, Option<usize>) {
        if range.origin_side.is_some() && !self.can_hit_itself {
            return (Bracket::MISS, None);
        }
        self.surface.bracket::<A>(cpu, ray, range, self.leaving(range.origin_side, range.origin_error))
    }
}

/// The number of plain rays that take as long as the search for a ray's hit, 2 to 5 microseconds.
pub(super) const RAYS_PER_SEARCH: u32 = 4;

impl<A: NotClassic> Hittable for Mesh<A> {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if range.origin_side.is_none() {
            return self.surface.distance::<A>(ray, range, -1.0);
        }
        if !self.can_hit_itself {
            return MISS;
        }
        let leaves = self.surface.leaves(range.origin_error, || self.surface.nearest(ray.origin).0);
        self.surface.distance::<A>(ray, range, leaves)
    }

    /// Returns the normal of the nearest face.
    fn normal(&self, at: DVec3) -> DVec3 {
        self.surface.triangle::<A>(self.surface.face_at(at)).plane.normal
    }

    fn facts(&self) -> Facts {
        Facts {
            can_hit_itself: Sides::both_if(self.can_hit_itself),
            is_two_sided: self.is_two_sided(),
            is_smooth: self.surface.is_smooth(),
            may_be_costly: true,
            ..Facts::within(self.surface.bounds)
        }
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        self.surface.smoothed(self.surface.face_at(at), at, normal)
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(self.surface.uv_of(self.surface.face_at(at), at))
    }

    fn face(&self, at: DVec3) -> Option<u32> {
        Some(self.surface.order[self.surface.face_at(at)])
    }

    fn bounds_after(&self, linear: &DMat3) -> Option<Aabb> {
        let vertices = &self.surface.vertices;
        let around = || {
            vertices
                .iter()
                .map(|at| *linear * *at)
                .fold(Aabb::EMPTY, |all, at| all.and(&Aabb { low: at, high: at }))
        };
        (vertices.len() <= MAX_MAPPED).then(around)
    }

    fn why_not_closed(&self) -> Option<&str> {
        match self.surface.why_not_closed {
            Openness { open: 0, clashing: 0 } => self
                .surface
                .depths()
                .map(|_| "some of its faces do not lie between its inside and the outside"),
            Openness { open: 0, .. } => Some("some of its faces are turned against their neighbours"),
            _ => Some("some of its edges belong to one face only"),
        }
    }

    fn search_cost(&self, _ray: &Ray, _origin_side: Option<Side>) -> u32 {
        RAYS_PER_SEARCH
    }

    fn method(&self) -> String {
        let Surface { why_not_closed: Openness { open, clashing }, tree, .. } = &*self.surface;
        let lit = if self.is_two_sided() { "lit on both sides" } else { "lit on one side" };
        let sides = match (open, clashing) {
            (0, 0) => format!("closed, and so {lit}"),
            (0, _) => {
                format!("with faces turned against each other at {}, {lit}", text::count(*clashing, "edge"))
            }
            _ => format!("open at {}, {lit}", text::count(*open, "edge")),
        };
        let nodes = text::count(tree.size(), "node");
        format!("a BVH of {nodes} over {}; {sides}", text::count(self.surface.face_count(), "face"))
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        let nearest = self.surface.nearest(from).0;
        Some((nearest - SLACK * (from.abs().max_element() + self.surface.max_coordinate())).max(0.0))
    }

    fn luminous(&self) -> Option<Luminous> {
        let faces = (0..self.surface.face_count()).map(|face| self.surface.corners(face));
        Some(Luminous::Triangles(Triangles::new(faces)))
    }

    fn part(&self, ray: &Ray, distance: f64) -> Option<String> {
        Some(format!("face {}", self.face_hit(ray, distance)? + 1))
    }

    fn face_hit(&self, ray: &Ray, distance: f64) -> Option<u32> {
        let face = distance.is_finite().then(|| self.surface.face_along(ray, distance))?;
        Some(self.surface.order[face])
    }

    fn assumes(&self, each: &mut dyn FnMut(Assumption)) {
        if self.surface.are_rounded {
            each(Assumption::Vertices);
        }
        if self.surface.is_smooth() {
            each(Assumption::Normals);
        }
    }

    fn read_from_files(&self, each: &mut dyn FnMut(&[u8])) {
        self.surface.bytes_of(each);
    }
}

impl<A: NotClassic> HitQueries for Mesh<A> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.surface.is_on_surface::<A>(at, error)
    }

    fn contains(&self, at: DVec3, error: f64) -> Option<bool> {
        self.surface.contains::<A>(at, error)
    }

    fn facet(&self, at: DVec3, error: f64) -> Option<Facet> {
        self.surface.facet::<A>(at, error)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        let surface = &self.surface;
        let face = surface.face_along(ray, distance);
        let fine = surface.triangle::<A>(face).plane.exact_crossing(ray);
        // At an edge, the ray may hit the plane of a neighbouring face far from the edge.
        let size = distance + ray.origin.abs().max_element();
        ((fine.high - distance).abs() <= CLOSE * size).then_some(fine)
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        self.assumes(&mut |assumption| each(of, Premise::Assumed(assumption)));
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        self.surface.certify::<A>(sight, precision)
    }

    fn surface_hit(&self, ray: &Ray, distance: f64, at: DVec3, part: Option<usize>) -> Option<SurfaceHit> {
        let surface = &self.surface;
        let known = part.or_else(|| Memo::with(|memo| memo.face(surface.id, ray, distance)));
        let face = known.unwrap_or_else(|| surface.face_along(ray, distance));
        Some(SurfaceHit {
            normal: surface.triangle::<A>(face).plane.normal,
            uv: Some(surface.uv_of(face, at)),
            face: Some(surface.order[face]),
        })
    }

    fn proven(&self) -> Option<&dyn ProofMethods> {
        Some(self)
    }
}

impl<A: NotClassic, F: Precise> HitProofs<F> for Mesh<A> {
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (HitEnclosure<F>, usize) {
        self.surface.first_along::<A, F>(line, leaves)
    }

    fn all_hits(
        &self,
        line: &Line<Interval<F>>,
        leaves: Option<usize>,
    ) -> Option<Vec<(HitEnclosure<F>, usize)>> {
        Some(self.surface.all_along::<A, F>(line, leaves))
    }

    fn slope(&self, at: [Dual<Interval<F>>; 3], part: usize) -> Dual<Interval<F>> {
        HitProofs::slope(&Face(self.surface.triangle::<A>(part)), at, 0)
    }

    fn shading_normal(
        &self,
        at: [Interval<F>; 3],
        part: usize,
        normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        self.surface.enclosed_normal(part, at, normal)
    }

    fn uv_bounds(&self, at: [Interval<F>; 3], part: usize) -> Option<[Interval; 2]> {
        let (surface, at) = (&self.surface, at.map(Interval::coarse));
        if surface.is_alone(at, |face| face == part) { surface.uv_bounds(part, at) } else { None }
    }

    fn face_of(&self, part: usize) -> Option<u32> {
        Some(self.surface.order[part])
    }

    fn face(&self, at: [Interval<F>; 3], part: usize) -> Option<u32> {
        let order = &self.surface.order;
        let is_own = |face: usize| order[face] == order[part];
        self.surface.is_alone(at.map(Interval::coarse), is_own).then_some(order[part])
    }
}

impl<A: NotClassic> OverFootprint for Mesh<A> {
    fn hits(&self, line: &Line<Affine>, leaves: Option<usize>, met: &mut dyn FnMut(FootprintHit, usize)) {
        self.surface.hits_of_footprint::<A>(line, leaves, met);
    }

    fn slope(&self, at: [Dual<Affine>; 3], part: usize) -> Dual<Affine> {
        OverFootprint::slope(&Face(self.surface.triangle::<A>(part)), at, 0)
    }
}
