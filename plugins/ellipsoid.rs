//! An ellipsoid: a sphere stretched along the axes.

use super::sphere::{self, Sphere};
use crate::numeric::twofold::{exponent_to_one, times_power_of_two};
use crate::prelude::*;
use crate::shapes::ball::{self, Line};

static SCALE: Pparm<DVec3> = Pparm::required("scale", "the scale factors along x, y and z")
    .must("positive in each dimension", |scale: &DVec3| scale.min_element() > 0.0);

const TABLE: Table = &[&SCALE as &dyn Row];

inventory::submit! {
    Entity::shape("ellipsoid", "a sphere scaled along the coordinate axes", &[sphere::TABLE, TABLE], |args| {
        Ok(Body::plain(Ellipsoid::new(Sphere::new(args), args.get(&SCALE))))
    })
}

struct Ellipsoid {
    /// The sphere that it is where space is squeezed by `scale` around its centre.
    ball: Sphere,
    scale: DVec3,
    /// One over the least of `scale`.
    most_squeezed: f64,
}

impl Ellipsoid {
    /// A sphere, stretched.
    fn new(mut ball: Sphere, mut scale: DVec3) -> Self {
        // A power of two more in the radius and less in the scale changes nothing but how large the squares become.
        if ball.accuracy != Accuracy::Classic {
            let exponent = exponent_to_one(scale.min_element());
            scale = DVec3::from(scale.to_array().map(|part| times_power_of_two(part, exponent)));
            ball.radius = times_power_of_two(ball.radius, -exponent);
        }
        Self { ball, scale, most_squeezed: 1.0 / scale.min_element() }
    }

    /// A ray, squeezed: its direction is no unit vector any more, so that distances stay what they were.
    #[inline(always)]
    fn squeezed(&self, ray: &Ray) -> (DVec3, DVec3) {
        ((ray.origin - self.ball.center) / self.scale, ray.dir / self.scale)
    }
}

impl Hittable for Ellipsoid {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let Sphere { radius, accuracy, .. } = self.ball;
        if accuracy == Accuracy::Classic {
            let (from, dir) = self.squeezed(ray);
            return within.keep(sphere::classic(from, dir, radius));
        }
        let line = Line::squeezed(ray, self.ball.center, self.scale);
        within.keep(match within.leaves {
            None => ball::first_hit(&line, radius, accuracy),
            Some(Side::Inside) => ball::far_hit(&line, radius, accuracy),
            Some(Side::Outside) => MISS,
        })
    }

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        let (from, dir) = self.squeezed(ray);
        match self.ball.accuracy {
            Accuracy::Classic => Bracket::exactly(within.keep(sphere::classic(from, dir, self.ball.radius))),
            _ => {
                let (inverse, error) = (1.0 / dir.dot(dir), within.origin_error / self.scale.min_element());
                let spread = self.most_squeezed * inverse.sqrt();
                ball::bracket(from, dir, inverse, spread, self.ball.radius, within.leaves, error)
            }
        }
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        let Sphere { radius, accuracy, .. } = self.ball;
        let distance = match accuracy {
            Accuracy::Classic => {
                let (from, dir) = self.squeezed(ray);
                sphere::classic(from, dir, radius)
            }
            _ => ball::quick_hit(&Line::squeezed(ray, self.ball.center, self.scale), radius, accuracy),
        };
        if distance.is_nan() { distance } else { within.keep(distance) }
    }

    fn bounds(&self) -> Option<Bounds> {
        let reach = self.ball.radius * self.scale;
        let bounds = Bounds { low: self.ball.center - reach, high: self.ball.center + reach };
        (self.ball.accuracy != Accuracy::Classic).then_some(bounds)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        ((at - self.ball.center) / (self.scale * self.scale)).normalize()
    }

    fn meets_itself(&self, leaving: Side) -> bool {
        self.ball.meets_itself(leaving)
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        // Where it is squeezed most, an error is largest.
        let from = (at - self.ball.center) / self.scale;
        let squeezed = (from / self.scale).length() / from.length();
        ball::touches(from, self.ball.radius, error * squeezed)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<Twofold> {
        let is_classic = self.ball.accuracy == Accuracy::Classic;
        if is_classic { None } else { coincidence::distance(self, ray, distance) }
    }

    fn is_two_sided(&self) -> bool {
        self.ball.is_two_sided()
    }

    fn method(&self) -> String {
        ball::method(self.ball.accuracy).to_owned()
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }
}

impl Equation for Ellipsoid {
    const IS_QUADRATIC: bool = true;

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| {
            ((at[axis] - N::constant(self.ball.center[axis])) / N::constant(self.scale[axis])).powi(2)
        };
        part(0) + part(1) + part(2) - N::constant(self.ball.radius).powi(2)
    }
}
