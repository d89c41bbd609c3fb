//! A plane: every point in two directions, without end.

use crate::entity::{Args, Entity};
use crate::geometry::{Body, Hittable, MISS, Ray, Span};
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

/// An infinite plane. Other planes hold one.
pub struct Plane {
    pub normal: DVec3,
    pub point: DVec3,
    normal_dot_point: f64,
}

impl Plane {
    /// The plane of an entity whose table has [`TABLE`]'s rows.
    pub fn new(args: &Args) -> Self {
        Self::through(args.get(&NORMAL).normalize(), args.get(&POINT))
    }

    /// The plane through a point with this unit normal.
    pub fn through(normal: DVec3, point: DVec3) -> Self {
        Self { normal, point, normal_dot_point: normal.dot(point) }
    }

    /// The distance at which a ray crosses it, forward or backward; [`MISS`] for one that runs along it.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        let toward = self.normal.dot(ray.dir);
        if toward == 0.0 { MISS } else { (self.normal_dot_point - self.normal.dot(ray.origin)) / toward }
    }
}

impl Hittable for Plane {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.crossing(ray);
        // On the viewer's side of the screen there are no planes (the notes' "wrong side").
        if ray.at(distance).z > 0.01 { MISS } else { within.keep(distance) }
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.normal
    }
}
