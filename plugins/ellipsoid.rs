//! An ellipsoid: a sphere stretched along the axes.

use super::sphere::{self, Sphere};
use crate::entity::Entity;
use crate::geometry::{Body, Hittable, Ray, Span};
use crate::pparm::{Pparm, Row, Table};
use glam::DVec3;

static SCALE: Pparm<DVec3> = Pparm::required("scale", "how much it is stretched along x, y and z")
    .must("positive each way", |scale: &DVec3| scale.min_element() > 0.0);

const TABLE: Table = &[&SCALE as &dyn Row];

inventory::submit! {
    Entity::shape("ellipsoid", "a ball stretched along the axes", &[sphere::TABLE, TABLE], |args| {
        let Sphere { center, radius } = Sphere::new(args);
        let scale = args.get(&SCALE);
        Ok(Body::plain(Ellipsoid { center, scale, unstretched: Sphere { center: DVec3::ZERO, radius } }))
    })
}

struct Ellipsoid {
    center: DVec3,
    scale: DVec3,
    /// The sphere that it is where space is squeezed by `scale`.
    unstretched: Sphere,
}

impl Hittable for Ellipsoid {
    /// Squeezed, a ray's direction is no unit vector any more, so that distances stay what they were.
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let squeezed = Ray { origin: (ray.origin - self.center) / self.scale, dir: ray.dir / self.scale };
        self.unstretched.distance(&squeezed, within)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        ((at - self.center) / (self.scale * self.scale)).normalize()
    }
}
