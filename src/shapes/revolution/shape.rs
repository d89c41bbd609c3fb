//! Surfaces of revolution as shapes, anywhere in the world.

use super::bracket::MAX_RAYS;
use super::classic::ClassicRevolution;
use super::lanes::Lanes;
use super::normal;
use super::surface::Revolution;
use crate::uv;
use glam::{DVec2, DVec3};
use tabray_exact::formula::written::Obstacle;
use tabray_exact::interval::Interval;
use tabray_exact::roots::Method;
use tabray_exact::scalar::Scalar;
use tabray_world::certify::Equation;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::ray::{Bracket, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::{RayPacket, SurfaceInteraction, split};
use tabray_world::geometry::sight::Line;
use tabray_world::hittable::{Certified, Facts, Hittable, Sides};
use tabray_world::packets::shape::{PacketIntersect, by_distance, queries_by_equation};
use tabray_world::simd::cpu::Cpu;

/// A surface around the y axis of a frame.
pub struct InFrame<S> {
    /// The surface.
    pub surface: S,
    /// The frame.
    pub frame: Frame,
}

impl<S: Equation> Equation for InFrame<S> {
    fn to_local<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        self.frame.line(line)
    }

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.surface.value(at)
    }

    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        self.surface.uv_bounds(at)
    }

    fn obstacle(&self, at: [Interval; 3]) -> Option<Obstacle> {
        self.surface.obstacle(at)
    }

    fn cost(&self) -> usize {
        self.surface.cost()
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.surface.inside_trim(at)
    }

    fn extent(&self) -> [DVec3; 2] {
        self.surface.extent()
    }
}

impl Hittable for InFrame<ClassicRevolution> {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        self.surface.first_hit(&self.frame.ray(ray), range)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (self.frame.axes * self.surface.normal(self.frame.point(at))).normalize()
    }

    fn facts(&self) -> Facts {
        let [low, high] = self.surface.extent();
        Facts { can_hit_itself: Sides::NONE, ..Facts::within(self.frame.bounds(&Aabb { low, high })) }
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_height(self.frame.point(at), self.surface.height))
    }

    fn method(&self) -> String {
        "bisection to 1e-4, from the ray's origin to its point closest to the axis".to_owned()
    }
}

impl Hittable for InFrame<Revolution> {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        self.surface.first_hit(&self.frame, ray, range).0
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.surface.normal_in(&self.frame, at)
    }

    fn facts(&self) -> Facts {
        Facts {
            is_two_sided: true,
            may_be_costly: self.surface.may_be_costly(),
            ..Facts::within(self.frame.bounds(&self.surface.bounds()))
        }
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_height(self.frame.point(at), self.surface.height))
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        self.surface.why_not_closed()
    }

    fn search_cost(&self, ray: &Ray, origin_side: Option<Side>) -> u32 {
        self.surface.search_cost(&self.frame, ray, origin_side)
    }

    fn method(&self) -> String {
        self.surface.to_string()
    }
}

impl Certified for InFrame<Revolution> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        // Transforming the point into the frame rounds it once more. `every_plugin_keeps_its_contract` in
        // `tests/shapes/contract.rs` tests that hits are on the surface.
        let moved = 8.0 * f64::EPSILON * (at - self.frame.origin).abs().max_element();
        self.surface.is_on_surface(self.frame.point(at), error + moved)
    }

    fn distance_by(&self, method: Method, ray: &Ray, range: &RayRange) -> Option<f64> {
        Some(self.surface.first_hit_by(method, &self.frame, ray, range))
    }
}

queries_by_equation!([] InFrame<Revolution>, |self| self);

impl PacketIntersect for InFrame<Revolution> {
    fn brackets(&self, cpu: Cpu, rays: RayPacket, ends: &[f64], (near, far): (&mut [f64], &mut [f64])) {
        let InFrame { surface, frame } = self;
        let mut lanes = Lanes::<MAX_RAYS>::none();
        for part in split(near.len(), MAX_RAYS) {
            surface.t_bounds(cpu, frame, rays.part(part.clone()), &ends[part.clone()], &mut lanes);
            near[part.clone()].copy_from_slice(&lanes.near[..part.len()]);
            far[part.clone()].copy_from_slice(&lanes.far[..part.len()]);
        }
    }

    fn refine(&self, cpu: Cpu, rays: RayPacket, brackets: (&[f64], &[f64]), out: &mut [f64]) {
        self.surface.roots(cpu, &self.frame, rays, brackets, out);
    }

    fn interact(&self, cpu: Cpu, rays: RayPacket, distances: &[f64], interaction: SurfaceInteraction) {
        let SurfaceInteraction { points, normals, sides, cosines, travelled, .. } = interaction;
        let InFrame { surface, frame } = self;
        normal::interact(cpu, surface, frame, rays, distances, sides, cosines, travelled, points, normals);
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if !ray.is_single() {
            return self.surface.bracket(&self.frame, ray, range);
        }
        let is_on_surface = || Certified::is_on_surface(self, ray.origin, range.origin_error);
        by_distance(ray, range, is_on_surface, |range| {
            let (distance, is_certain) = self.surface.first_hit(&self.frame, ray, range);
            is_certain.then_some(distance)
        })
    }

    fn refine_one(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}
