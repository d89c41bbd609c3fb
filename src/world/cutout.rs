//! Shapes with parts cut out by their shaders, as an image of a leaf cuts its outline out of a rectangle.

use crate::any_shape::AnyShape;
use crate::certify::{Assumption, Enclosure, Precision, Premise};
use crate::coincidence::ROUNDING;
use crate::geometry::aabb::Aabb;
use crate::geometry::ray::{MISS, Ray, RayRange, Side};
use crate::geometry::sight::Sight;
use crate::hittable::{ByDistance, Curvature, Facts, Hittable, Shape, SurfaceHit};
use crate::packets::shader::PacketShader;
use crate::packets::shape::HitQueries;
use crate::surface_point::SurfacePoint;
use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;

/// The maximum number of cut parts that a ray passes on its way. Beyond them, it hits nothing.
const MAX_PASSED: usize = 1 << 16;

/// A shape without the parts that a shader cuts out. Rays pass through the holes.
pub(crate) struct Cutout {
    shape: AnyShape,
    shader: Arc<dyn PacketShader>,
}

/// Marks a shape about whose hits one thing is proven: they are hits of the whole shape.
pub(crate) struct ByWhole;

impl Cutout {
    /// Makes a shape without what a shader cuts out.
    pub(crate) fn shape(shape: AnyShape, shader: Arc<dyn PacketShader>) -> Shape<Self, ByDistance, ByWhole> {
        Shape::new(Self { shape, shader }).by()
    }

    /// Returns the side on which a ray in this direction leaves a point of the surface that is cut out; `None` where
    /// the point is not cut out.
    fn passes(&self, at: DVec3, dir: DVec3) -> Option<Side> {
        let normal = self.shape.normal(at);
        let side = Side::seen_along(dir, normal);
        let point = SurfacePoint::seen(&*self.shape, self.shader.sees(), at, normal, side);
        self.shader.is_cut_out(&point).then_some(side.opposite())
    }
}

impl Hittable for Cutout {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let (mut from, mut rest, mut passed) = (*ray, *range, 0.0);
        for _ in 0..MAX_PASSED {
            let distance = self.shape.distance(&from, &rest);
            if distance == MISS {
                break;
            }
            let at = from.at(distance);
            let Some(leaves) = self.passes(at, ray.dir) else { return range.keep(passed + distance) };
            if !self.shape.can_hit_itself(leaves) {
                break;
            }
            passed += distance;
            from.origin = ray.at(passed);
            let size = ray.origin.abs().max_element() + passed + self.shape.facts().max_coordinate;
            rest = RayRange {
                near: (range.near - passed).max(0.0),
                far: range.far - passed,
                origin_side: Some(leaves),
                origin_error: range.origin_error + ROUNDING * size,
            };
        }
        MISS
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.shape.normal(at)
    }

    fn facts(&self) -> Facts {
        self.shape.facts()
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        self.shape.shading_normal(at, normal)
    }

    fn bounds_after(&self, linear: &DMat3) -> Option<Aabb> {
        self.shape.bounds_after(linear)
    }

    fn why_not_closed(&self) -> Option<&str> {
        Some("parts of its surface are cut out")
    }

    fn method(&self) -> String {
        format!("{}; parts are cut out", self.shape.method())
    }

    fn part(&self, ray: &Ray, distance: f64) -> Option<String> {
        self.shape.part(ray, distance)
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        self.shape.uv(at)
    }

    fn curvature(&self, at: DVec3) -> Option<Curvature> {
        self.shape.curvature(at)
    }

    fn face(&self, at: DVec3) -> Option<u32> {
        self.shape.face(at)
    }

    fn face_hit(&self, ray: &Ray, distance: f64) -> Option<u32> {
        self.shape.face_hit(ray, distance)
    }

    fn assumes(&self, each: &mut dyn FnMut(Assumption)) {
        self.shape.assumes(each);
    }

    fn read_from_files(&self, each: &mut dyn FnMut(&[u8])) {
        self.shape.read_from_files(each);
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.shape.is_clear_of(region)
    }

    fn search_cost(&self, ray: &Ray, origin_side: Option<Side>) -> u32 {
        self.shape.search_cost(ray, origin_side)
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        self.shape.clearance(from)
    }
}

impl HitQueries for Shape<Cutout, ByDistance, ByWhole> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        let Cutout { shape, .. } = &self.shape;
        shape.is_on_surface(at, error) && self.shape.passes(at, -shape.normal(at)).is_none()
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        self.shape.shape.premises(of, each);
        each("cutout", Premise::NoEquation);
    }

    fn surface_hit(&self, ray: &Ray, distance: f64, at: DVec3, part: Option<usize>) -> Option<SurfaceHit> {
        Some(self.shape.shape.surface_hit(ray, distance, at, part))
    }

    /// A ray that misses the whole shape misses what is left of it.
    fn certify(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        let of_whole = self.shape.shape.certify(sight, precision);
        let left = match of_whole {
            Enclosure::Hits(at) | Enclosure::Edge(at) => Enclosure::Doubtful(at.low),
            open => open,
        };
        (left, 0)
    }
}
