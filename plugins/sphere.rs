//! A sphere: every point at one distance from a centre.

use crate::entity::{Args, Entity};
use crate::geometry::{Body, Hittable, MISS, Ray, Span};
use crate::pparm::{Pparm, Table};
use glam::DVec3;

static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the point in its middle").alias(&["centre"]).unit("world coordinates");
static RADIUS: Pparm<f64> = Pparm::required("radius", "the distance from its centre to its surface")
    .unit("world units")
    .must("positive", |radius| *radius > 0.0)
    .dumped("radius", "\n");

/// What every round shape takes.
pub const TABLE: Table = &[&CENTER, &RADIUS];

inventory::submit! {
    Entity::shape("sphere", "a ball", &[TABLE], |args| Ok(Body::plain(Sphere::new(args))))
}

/// A sphere. Other round shapes hold one.
#[derive(Clone)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
}

impl Sphere {
    /// The sphere of an entity whose table has [`TABLE`]'s rows.
    pub fn new(args: &Args) -> Self {
        Self { center: args.get(&CENTER), radius: args.get(&RADIUS) }
    }
}

impl Hittable for Sphere {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let from_center = ray.origin - self.center;
        let a = ray.dir.dot(ray.dir);
        let b = 2.0 * from_center.dot(ray.dir);
        let c = from_center.dot(from_center) - self.radius * self.radius;
        let discriminant = b * b - 4.0 * a * c;
        // A ray that only touches the sphere misses it (the notes).
        if discriminant <= 0.0 { MISS } else { within.keep((-b - discriminant.sqrt()) / (2.0 * a)) }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (at - self.center).normalize()
    }
}
