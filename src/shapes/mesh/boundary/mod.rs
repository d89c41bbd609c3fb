//! The boundary of the inside of a closed mesh whose bodies overlap, touch or contain each other. Solids and glass need
//! it, because a ray that crosses it must change sides.
//!
//! A ray crosses the boundary where the winding number changes from 0 or to 0. Faces in the same place with opposite
//! orientations cancel.

mod hit_proofs;

use super::passages::{Turn, winding};
use super::shape::{Mesh, RAYS_PER_SEARCH};
use super::surface::{Depth, Surface};
use super::winding::DIRECTIONS;
use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::double_double::DoubleDouble;
use tabray_world::accuracy::{Accuracy, Exact, NotClassic, Strict};
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::{Assumption, Premise, ProofMethods};
use tabray_world::coincidence::{CLOSE, ROUNDING, close};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::hittable::{Facts, Hittable, SurfaceHit};
use tabray_world::packets::shape::{HitQueries, ScalarIntersect, by_distance};

/// The distance from a face at which its two sides are examined, as a multiple of the rounding error of a point.
const BESIDE: f64 = 256.0;

/// The boundary of the inside of a closed mesh.
struct Boundary<A> {
    mesh: Mesh<A>,
    /// The winding numbers before its faces.
    depths: Arc<[Depth]>,
}

impl Surface {
    /// Makes the shape of the boundary of a closed surface's inside. Returns `None` if the boundary is the whole
    /// surface, or if the surface is open.
    pub fn boundary(self: &Arc<Self>, accuracy: Accuracy) -> Option<AnyShape> {
        let depths = if self.is_closed() { self.depths()?.clone() } else { return None };
        Some(match accuracy {
            Accuracy::Strict => AnyShape::of_packets(Boundary::<Strict>::new(self, depths, accuracy)),
            _ => AnyShape::of_packets(Boundary::<Exact>::new(self, depths, accuracy)),
        })
    }
}

impl<A: NotClassic> Boundary<A> {
    fn new(surface: &Arc<Surface>, depths: Arc<[Depth]>, accuracy: Accuracy) -> Self {
        Self { mesh: Mesh::new(surface.clone(), accuracy), depths }
    }

    /// Tells whether all of a face lies inside.
    fn is_hidden(&self, face: usize) -> bool {
        self.depths[face].is_some_and(|depth| depth != 0 && depth != -1)
    }

    /// Tells whether a point is on the boundary, up to an error in world units and to rounding.
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.mesh.surface.is_on_one_of::<A>(at, error, |face| !self.is_hidden(face))
    }

    /// Tells whether a point that lies on no face lies inside.
    fn is_inside(&self, at: DVec3) -> bool {
        let ray = Ray { origin: at, dir: DIRECTIONS[0].normalize() };
        winding(&self.mesh.surface.passages::<A>(&ray, -1.0)) != 0
    }

    /// Tells whether the points beside a point of a face lie inside, first on its outer side and then on its inner
    /// side.
    fn sides(&self, face: usize, at: DVec3) -> [bool; 2] {
        if let Some(depth) = self.depths[face] {
            return [depth != 0, depth != -1];
        }
        let size = at.abs().max_element() + self.mesh.surface.max_coordinate();
        let step = BESIDE * ROUNDING * size * self.mesh.surface.triangle::<A>(face).plane.normal;
        [self.is_inside(at + step), self.is_inside(at - step)]
    }

    /// Returns the face of the boundary nearest to a point. Of several faces that are equally near up to rounding, it
    /// is the first in the file with the outside on one side only.
    fn face_at(&self, at: DVec3) -> usize {
        let nearest = self.mesh.surface.nearest_of(at, |face| !self.is_hidden(face));
        self.mesh.surface.first_of(nearest, at, |face| {
            let [before, behind] = self.sides(face, at);
            u8::from(before == behind)
        })
    }

    /// Returns the place where a ray crosses the boundary near a distance, in world units.
    fn turn_at(&self, ray: &Ray, distance: f64) -> Option<Turn> {
        let turns = self.mesh.surface.turns::<A>(ray, -1.0).into_iter();
        let away = |turn: &Turn| (turn.distance - distance).abs();
        turns.min_by(|one, other| away(one).total_cmp(&away(other))).filter(|_| distance.is_finite())
    }
}

impl<A: NotClassic> Hittable for Boundary<A> {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let surface = &self.mesh.surface;
        let leaves = if range.origin_side.is_none() {
            -1.0
        } else if !self.mesh.can_hit_itself {
            return MISS;
        } else {
            surface
                .leaves(range.origin_error, || surface.nearest_of(ray.origin, |face| !self.is_hidden(face)).0)
        };
        let turns = surface.turns::<A>(ray, leaves).into_iter();
        turns.map(|turn| range.keep(turn.distance)).find(|distance| *distance < MISS).unwrap_or(MISS)
    }

    /// Returns the normal of the nearest face, pointing outside.
    fn normal(&self, at: DVec3) -> DVec3 {
        let face = self.face_at(at);
        let normal = self.mesh.surface.triangle::<A>(face).plane.normal;
        if self.sides(face, at)[0] { -normal } else { normal }
    }

    fn facts(&self) -> Facts {
        self.mesh.facts()
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        self.mesh.surface.smoothed(self.face_at(at), at, normal)
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(self.mesh.surface.uv_of(self.face_at(at), at))
    }

    fn face(&self, at: DVec3) -> Option<u32> {
        Some(self.mesh.surface.order[self.face_at(at)])
    }

    fn face_hit(&self, ray: &Ray, distance: f64) -> Option<u32> {
        Some(self.mesh.surface.order[self.turn_at(ray, distance)?.face])
    }

    fn part(&self, ray: &Ray, distance: f64) -> Option<String> {
        Some(format!("face {}", self.face_hit(ray, distance)? + 1))
    }

    fn bounds_after(&self, linear: &DMat3) -> Option<Aabb> {
        self.mesh.bounds_after(linear)
    }

    fn why_not_closed(&self) -> Option<&str> {
        None
    }

    fn search_cost(&self, _ray: &Ray, _origin_side: Option<Side>) -> u32 {
        // The search goes to the end of the ray.
        2 * RAYS_PER_SEARCH
    }

    fn method(&self) -> String {
        format!("{}; what lies inside of it is left out", self.mesh.method())
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        self.mesh.clearance(from)
    }

    fn assumes(&self, each: &mut dyn FnMut(Assumption)) {
        self.mesh.assumes(each);
    }

    fn read_from_files(&self, each: &mut dyn FnMut(&[u8])) {
        self.mesh.read_from_files(each);
    }
}

/// A camera ray that meets an edge in `f64` arithmetic is decided with the numbers of the scene.
impl<A: NotClassic> ScalarIntersect for Boundary<A> {
    type Author = Self;

    fn author(&self) -> &Self {
        self
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        let Aabb { low, high } = self.mesh.surface.bounds;
        let is_outside = ray.origin.cmplt(low).any() || ray.origin.cmpgt(high).any();
        let is_from_camera = range.origin_side.is_none() && range.origin_error == 0.0;
        let is_on_surface = || self.is_on_surface(ray.origin, range.origin_error);
        by_distance(ray, range, is_on_surface, |range| {
            let distance = self.distance(ray, range);
            // Unless the ray starts outside, its winding number is counted from the end of the ray.
            let far = if is_outside && distance < MISS { distance + close(ray, distance) } else { MISS };
            (!is_from_camera || self.mesh.surface.is_off_edges(ray, far)).then_some(distance)
        })
    }
}

impl<A: NotClassic> HitQueries for Boundary<A> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.is_on_surface(at, error)
    }

    fn contains(&self, at: DVec3, error: f64) -> Option<bool> {
        (!self.is_on_surface(at, error)).then(|| self.is_inside(at))
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        let face = self.turn_at(ray, distance)?.face;
        let fine = self.mesh.surface.triangle::<A>(face).plane.exact_crossing(ray);
        let size = distance + ray.origin.abs().max_element();
        ((fine.high - distance).abs() <= CLOSE * size).then_some(fine)
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        self.assumes(&mut |assumption| each(of, Premise::Assumed(assumption)));
    }

    fn surface_hit(&self, ray: &Ray, distance: f64, at: DVec3, part: Option<usize>) -> Option<SurfaceHit> {
        let found = || self.turn_at(ray, distance).map_or_else(|| self.face_at(at), |turn| turn.face);
        let face = part.map_or_else(found, |part| part >> 1);
        let is_turned = part.map_or_else(|| self.sides(face, at)[0], |part| part & 1 == 1);
        let hit = self.mesh.surface_hit(ray, distance, at, Some(face))?;
        Some(SurfaceHit { normal: if is_turned { -hit.normal } else { hit.normal }, ..hit })
    }

    fn proven(&self) -> Option<&dyn ProofMethods> {
        Some(self)
    }
}
