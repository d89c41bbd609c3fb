//! Surfaces of revolution as shapes, wherever they stand.

use super::bracket::MOST;
use super::classic::Classic;
use super::lanes::Lanes;
use super::normal;
use super::surface::Revolution;
use crate::geometry::bounds::Bounds;
use crate::geometry::frame::Frame;
use crate::geometry::packet::{self, Nearest, Rays, parts};
use crate::geometry::ray::{Bracket, Ray, Side, Span};
use crate::geometry::roots::Method;
use crate::geometry::sight::Line;
use crate::numeric::number::Number;
use crate::simd::cpu::Cpu;
use crate::world::certify::Equation;
use crate::world::hittable::{Certified, Hittable, Searched};
use crate::world::landing::Landing;
use crate::world::packets::shape::{Packets, Proofs, by_distance};
use crate::world::shape::{ByPackets, Shape};
use glam::DVec3;

/// A surface around the y axis of a frame.
pub struct InFrame<S> {
    /// The surface.
    pub surface: S,
    /// Where it stands.
    pub frame: Frame,
}

impl<S: Equation> Equation for InFrame<S> {
    fn own<N: Number>(&self, line: Line<N>) -> Line<N> {
        self.frame.line(line)
    }

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        self.surface.value(at)
    }

    fn kept<N: Number>(&self, at: [N; 3]) -> N {
        self.surface.kept(at)
    }

    fn extent(&self) -> [DVec3; 2] {
        self.surface.extent()
    }
}

impl Hittable for InFrame<Classic> {
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.surface.first_hit(&self.frame.ray(ray), within)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (self.frame.axes * self.surface.normal(self.frame.point(at))).normalize()
    }

    fn meets_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn bounds(&self) -> Option<Bounds> {
        let [low, high] = self.surface.extent();
        Some(self.frame.bounds(&Bounds { low, high }))
    }

    fn method(&self) -> String {
        "bisection to 1e-4, from the ray's origin to its point closest to the axis".to_owned()
    }
}

impl Hittable for InFrame<Revolution> {
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.surface.first_hit(&self.frame, ray, within).0
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.surface.normal_in(&self.frame, at)
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.frame.bounds(&self.surface.bounds()))
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn method(&self) -> String {
        self.surface.to_string()
    }
}

impl Certified for InFrame<Revolution> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        // Rounding moves the point once more on its way into the frame.
        let moved = 8.0 * f64::EPSILON * (at - self.frame.origin).abs().max_element();
        self.surface.touches(self.frame.point(at), error + moved)
    }
}

impl Searched for InFrame<Revolution> {
    fn distance_by(&self, method: Method, ray: &Ray, within: &Span) -> f64 {
        self.surface.first_hit_by(method, &self.frame, ray, within)
    }
}

impl Shape<InFrame<Revolution>> {
    /// Found by functions of its own that take packets.
    pub fn in_packets(self) -> Shape<InFrame<Revolution>, ByPackets> {
        self.by()
    }
}

impl<P> Packets for Shape<InFrame<Revolution>, ByPackets, P>
where
    Self: Proofs,
{
    fn closest_hits(
        &self,
        cpu: Cpu,
        rays: Rays,
        sides: Option<&[Side]>,
        id: u64,
        mut nearest: Nearest,
    ) -> bool {
        let InFrame { surface, frame } = &self.shape;
        let (mut any, mut lanes) = (false, Lanes::<MOST>::none());
        for part in parts(rays.len(), MOST) {
            let (rays, sides) = (rays.part(part.clone()), sides.map(|sides| &sides[part.clone()]));
            let nearest = nearest.part(part);
            surface.bracket(cpu, frame, rays, sides, nearest.far, &mut lanes);
            any |= packet::meet_brackets(cpu, &lanes.near, &lanes.far, id, nearest);
        }
        any
    }

    fn occluded(
        &self,
        cpu: Cpu,
        rays: Rays,
        sides: Option<&[Side]>,
        ends: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let InFrame { surface, frame } = &self.shape;
        let (mut any, mut lanes) = (false, Lanes::<MOST>::none());
        for part in parts(ends.len(), MOST) {
            let (rays, sides) = (rays.part(part.clone()), sides.map(|sides| &sides[part.clone()]));
            let (ends, blocked, doubt) = (&ends[part.clone()], &mut blocked[part.clone()], &mut doubt[part]);
            surface.bracket(cpu, frame, rays, sides, ends, &mut lanes);
            any |= packet::block_brackets(cpu, &lanes.near, &lanes.far, ends, blocked, doubt);
        }
        any
    }

    fn refine(
        &self,
        cpu: Cpu,
        rays: Rays,
        _sides: Option<&[Side]>,
        brackets: (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        self.shape.surface.roots(cpu, &self.shape.frame, rays, brackets, out);
    }

    fn interact(&self, cpu: Cpu, rays: Rays, distances: &[f64], landing: Landing) {
        let Landing { points, normals, sides, cosines, travelled } = landing;
        let InFrame { surface, frame } = &self.shape;
        normal::land(cpu, surface, frame, rays, distances, sides, cosines, travelled, points, normals);
    }

    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        let touches = || self.touches(ray.origin, within.origin_error);
        by_distance(within, touches, |within| {
            let (distance, is_certain) = self.shape.surface.first_hit(&self.shape.frame, ray, within);
            is_certain.then_some(distance)
        })
    }

    fn refine_one(&self, ray: &Ray, leaves: Option<Side>) -> f64 {
        self.shape.distance(ray, &Span { leaves, ..Span::RAY })
    }
}
