//! An ellipsoid: a sphere stretched along the axes.

use super::sphere::{self, Sphere};
use crate::accuracy::Accuracy;
use crate::ball::{self, Line};
use crate::certify::{self, Enclosure, Equation};
use crate::entity::Entity;
use crate::geometry::{Body, Hittable, Ray, Span};
use crate::number::Number;
use crate::pparm::{Pparm, Row, Table};
use crate::twofold::Twofold;
use glam::DVec3;

static SCALE: Pparm<DVec3> = Pparm::required("scale", "how much it is stretched along x, y and z")
    .must("positive each way", |scale: &DVec3| scale.min_element() > 0.0);

const TABLE: Table = &[&SCALE as &dyn Row];

inventory::submit! {
    Entity::shape("ellipsoid", "a ball stretched along the axes", &[sphere::TABLE, TABLE], |args| {
        Ok(Body::plain(Ellipsoid { ball: Sphere::new(args), scale: args.get(&SCALE) }))
    })
}

struct Ellipsoid {
    /// The sphere that it is where space is squeezed by `scale` around its centre.
    ball: Sphere,
    scale: DVec3,
}

impl Hittable for Ellipsoid {
    /// Squeezed, a ray's direction is no unit vector any more, so that distances stay what they were.
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let Sphere { center, radius, accuracy } = self.ball;
        let (from, dir) = ((ray.origin - center) / self.scale, ray.dir / self.scale);
        if accuracy == Accuracy::Classic {
            return within.keep(sphere::classic(from, dir, radius));
        }
        let scale = self.scale.to_array().map(Twofold::from);
        let line = || Line {
            from: [0, 1, 2].map(|axis| Twofold::difference(ray.origin[axis], center[axis]) / scale[axis]),
            dir: [0, 1, 2].map(|axis| Twofold::from(ray.dir[axis]) / scale[axis]),
        };
        within.keep(ball::first_hit(from, dir, line, radius, accuracy))
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        ((at - self.ball.center) / (self.scale * self.scale)).normalize()
    }

    fn is_two_sided(&self) -> bool {
        self.ball.is_two_sided()
    }

    fn certify(&self, ray: &Ray) -> Enclosure {
        certify::first_hit(self, ray)
    }
}

impl Equation for Ellipsoid {
    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| {
            ((at[axis] - N::constant(self.ball.center[axis])) / N::constant(self.scale[axis])).powi(2)
        };
        part(0) + part(1) + part(2) - N::constant(self.ball.radius).powi(2)
    }
}
