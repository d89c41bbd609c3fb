//! A plane: every point in two directions, without end.

use crate::accuracy::Accuracy;
use crate::bounds::Bounds;
use crate::certify::{self, Enclosure, Equation};
use crate::cpu::Cpu;
use crate::entity::{Args, Entity};
pub use crate::flat::Plane;
use crate::geometry::{Body, Bracket, Hittable, Ray, Side, Span};
use crate::interval::Interval;
use crate::number::Number;
use crate::packet::Rays;
use crate::pparm::{Pparm, Table};
use glam::DVec3;

pub static NORMAL: Pparm<DVec3> =
    Pparm::required("normal", "a vector that stands upright on it, on its lit side")
        .must("a vector with a direction", |normal: &DVec3| normal.try_normalize().is_some())
        .shown(DVec3::normalize);
pub static POINT: Pparm<DVec3> = Pparm::required("point", "a point of it").unit("world coordinates");

/// What every kind of plane takes.
pub const TABLE: Table = &[&NORMAL, &POINT];

inventory::submit! {
    Entity::shape("plane", "a plane without end", &[TABLE], |args| Ok(Body::plain(Plane::new(args))))
}

impl Plane {
    /// The plane of an entity whose table has a plane's rows.
    pub fn new(args: &Args) -> Self {
        Self::with_normal(args.get(&NORMAL), args.get(&POINT), args.accuracy())
    }
}

impl Hittable for Plane {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.keep(self.crossing(ray), ray, within)
    }

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        match self.accuracy {
            Accuracy::Classic => Bracket::exactly(self.quick_distance(ray, within)),
            _ => Plane::bracket(self, &self.rough(ray), ray, within),
        }
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.quick_crossing(ray);
        self.quick_keep(distance, ray, within)
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.normal
    }

    fn is_clear_of(&self, region: &Bounds) -> bool {
        Plane::is_clear_of(self, region)
    }

    fn method(&self) -> String {
        Plane::method(self).to_owned()
    }

    fn distances(&self, cpu: Cpu, rays: Rays, _: Option<&[Side]>, _: (&[f64], &[f64]), out: &mut [f64]) {
        Plane::distances(self, cpu, rays, out);
    }

    fn certify(&self, ray: &Ray) -> Enclosure {
        certify::first_hit(self, ray)
    }
}

impl Equation for Plane {
    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| (at[axis] - N::constant(self.point[axis])) * N::constant(self.normal[axis]);
        part(0) + part(1) + part(2)
    }

    fn kept(&self, [_, _, z]: [Interval; 3]) -> Interval {
        Interval::constant(0.01) - z
    }
}
