//! A surface of revolution: a line turned around an axis.

use crate::entity::Entity;
use crate::geometry::{Body, Hittable, MISS, Ray, Span};
use crate::pparm::{Pparm, Table};
use crate::profile::Profile;
use glam::{DMat3, DVec3};

static SURFER: Pparm<&'static Profile> =
    Pparm::required("surfer", "the line that is turned: its distance from the axis at each height");
static DIRECTION: Pparm<DVec3> = Pparm::required("direction", "the direction of the axis, from base upward")
    .must("a vector with a direction", |axis: &DVec3| axis.try_normalize().is_some());
static BASE: Pparm<DVec3> =
    Pparm::required("base", "the point of the axis where the height is 0").unit("world coordinates");
static HEIGHT: Pparm<f64> = Pparm::required("height", "how far along the axis it goes")
    .unit("world units")
    .must("positive", |height| *height > 0.0)
    .not_dumped();

const TABLE: Table = &[&SURFER, &DIRECTION, &BASE, &HEIGHT];

inventory::submit! {
    Entity::shape("revsurf", "a line turned around an axis, such as a cone, a vase or a column", &[TABLE], |args| {
        let up = args.get(&DIRECTION).normalize();
        let (across, away) = up.any_orthonormal_pair();
        Ok(Body::plain(Revsurf {
            profile: args.get(&SURFER),
            base: args.get(&BASE),
            height: args.get(&HEIGHT),
            axes: DMat3::from_cols(across, up, away),
        }))
    })
}

struct Revsurf {
    profile: &'static Profile,
    base: DVec3,
    height: f64,
    /// The directions in the world of its own x, y (the axis) and z.
    axes: DMat3,
}

impl Revsurf {
    /// A ray as seen from the base and along the axes.
    fn to_local(&self, ray: &Ray) -> Ray {
        Ray {
            origin: self.axes.transpose_mul_vec3(ray.origin - self.base),
            dir: self.axes.transpose_mul_vec3(ray.dir),
        }
    }

    /// Positive outside of the surface, negative inside.
    fn outside(&self, at: DVec3) -> f64 {
        let radius = (self.profile.radius)(at.y);
        at.x * at.x - radius * radius + at.z * at.z
    }
}

impl Hittable for Revsurf {
    /// The notes' method: between the ray's origin and its point closest to the axis, bisection to 1e-4. A ray
    /// that grazes the surface is lost, and so is the inner wall.
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let ray = self.to_local(ray);
        let closest = -(ray.origin.x * ray.dir.x + ray.origin.z * ray.dir.z)
            / (ray.dir.x * ray.dir.x + ray.dir.z * ray.dir.z);
        let at_origin = self.outside(ray.origin);
        if closest.is_nan() || closest <= 0.0 || at_origin * self.outside(ray.at(closest)) >= 0.0 {
            return MISS;
        }
        let (mut near, mut far) = (0.0, closest);
        while far - near > 1e-4 {
            let middle = (near + far) / 2.0;
            if middle <= near || middle >= far {
                break; // Far from the origin there is no number between them.
            }
            if at_origin * self.outside(ray.at(middle)) < 0.0 {
                far = middle;
            } else {
                near = middle;
            }
        }
        let distance = (near + far) / 2.0;
        let height = ray.at(distance).y;
        if (0.0..=self.height).contains(&height) { within.keep(distance) } else { MISS }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let at = self.axes.transpose_mul_vec3(at - self.base);
        let downhill = -(self.profile.radius)(at.y) * (self.profile.slope)(at.y);
        (self.axes * DVec3::new(2.0 * at.x, 2.0 * downhill, 2.0 * at.z)).normalize()
    }
}
