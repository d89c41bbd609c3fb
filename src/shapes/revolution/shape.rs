//! Surfaces of revolution as shapes, wherever they stand.

use super::bracket::MOST;
use super::lanes::Lanes;
use super::{Classic, Revolution, normal};
use crate::geometry::bounds::Bounds;
use crate::geometry::frame::Frame;
use crate::geometry::packet::{self, Nearest, Rays, parts};
use crate::geometry::sight::{Line, Sight};
use crate::numeric::number::Number;
use crate::numeric::twofold::Twofold;
use crate::shapes::roots::Method;
use crate::simd::cpu::Cpu;
use crate::world::certify::{self, Enclosure, Equation, Precision};
use crate::world::coincidence;
use crate::world::hittable::{Bracket, Hittable, Ray, Side, Span};
use crate::world::landing::Landing;
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

    fn method(&self) -> String {
        "bisection to 1e-4, from the ray's origin to its point closest to the axis".to_owned()
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }
}

impl Hittable for InFrame<Revolution> {
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.surface.first_hit(&self.frame, ray, within).0
    }

    fn distance_by(&self, method: Method, ray: &Ray, within: &Span) -> Option<f64> {
        Some(self.surface.first_hit_by(method, &self.frame, ray, within))
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.surface.normal_in(&self.frame, at)
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.frame.bounds(&self.surface.bounds()))
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        // Rounding moves the point once more on its way into the frame.
        let moved = 8.0 * f64::EPSILON * (at - self.frame.origin).abs().max_element();
        self.surface.touches(self.frame.point(at), error + moved)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<Twofold> {
        coincidence::distance(self, ray, distance)
    }

    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        coincidence::bracket_by(self, ray, within, |within| {
            let (distance, is_certain) = self.surface.first_hit(&self.frame, ray, within);
            is_certain.then_some(distance)
        })
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn method(&self) -> String {
        self.surface.to_string()
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }

    fn meet(&self, cpu: Cpu, rays: Rays, sides: Option<&[Side]>, id: u64, mut nearest: Nearest) -> bool {
        let (mut any, mut lanes) = (false, Lanes::<MOST>::none());
        for part in parts(rays.len(), MOST) {
            let (rays, sides) = (rays.part(part.clone()), sides.map(|sides| &sides[part.clone()]));
            let nearest = nearest.part(part);
            self.surface.bracket(cpu, &self.frame, rays, sides, nearest.far, &mut lanes);
            any |= packet::meet_brackets(cpu, &lanes.near, &lanes.far, id, nearest);
        }
        any
    }

    fn block(
        &self,
        cpu: Cpu,
        rays: Rays,
        sides: Option<&[Side]>,
        ends: &[f64],
        blocked: &mut [u64],
        doubt: &mut [u64],
    ) -> bool {
        let (mut any, mut lanes) = (false, Lanes::<MOST>::none());
        for part in parts(ends.len(), MOST) {
            let (rays, sides) = (rays.part(part.clone()), sides.map(|sides| &sides[part.clone()]));
            let (ends, blocked, doubt) = (&ends[part.clone()], &mut blocked[part.clone()], &mut doubt[part]);
            self.surface.bracket(cpu, &self.frame, rays, sides, ends, &mut lanes);
            any |= packet::block_brackets(cpu, &lanes.near, &lanes.far, ends, blocked, doubt);
        }
        any
    }

    fn distances(
        &self,
        cpu: Cpu,
        rays: Rays,
        _sides: Option<&[Side]>,
        brackets: (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        self.surface.roots(cpu, &self.frame, rays, brackets, out);
    }

    fn land(&self, cpu: Cpu, rays: Rays, distances: &[f64], landing: Landing) {
        let Landing { points, normals, sides, travelled } = landing;
        normal::land(cpu, &self.surface, &self.frame, rays, distances, sides, travelled, points, normals);
    }
}
