//! A light as a sphere that shines evenly.

use super::area_light::VISIBLE;
use super::{light, sphere};
use tabray::prelude::*;

static RADIUS: Pparm<f64> = Pparm::required("radius", "the distance from its middle to its surface")
    .known_as(&["size"])
    .unit("world units")
    .positive();

const TABLE: Table = &[&light::LOCATION, &light::EMISSIVITY, &RADIUS, &VISIBLE];

inventory::submit! {
    Entity::light("sphere_light", "a sphere that shines evenly", &[TABLE], |args| {
        Ok(Box::new(SphereLight {
            ball: Ball { middle: args.get(&light::LOCATION), radius: args.get(&RADIUS) },
            radiance: args.get(&light::EMISSIVITY),
            is_visible: args.get(&VISIBLE),
            accuracy: args.accuracy(),
        }))
    })
    .known_as(&["spherelight", "ball_light", "bulb", "globe"])
    .without_falloff()
}

struct SphereLight {
    ball: Ball,
    radiance: Rgb,
    is_visible: bool,
    accuracy: Accuracy,
}

impl Light for SphereLight {
    fn location(&self) -> DVec3 {
        self.ball.middle
    }

    fn sent<N: Number>(&self, _toward: [N; 3]) -> [N; 3] {
        constants(self.radiance)
    }

    /// It covers at most half of all directions, which are 2 pi.
    fn brightest(&self) -> Option<Rgb> {
        Some(2.0 * self.radiance.abs())
    }

    fn size(&self) -> f64 {
        self.ball.radius
    }

    fn emitter(&self) -> Option<&dyn EnclosedEmitter> {
        Some(self)
    }

    fn shape(&self) -> Option<AnyShape> {
        self.is_visible.then(|| sphere::shape(self.ball.middle, self.ball.radius, self.accuracy))
    }
}

impl Emitter for SphereLight {
    fn sample<N: Number>(&self, at: [N; 3], normal: [N; 3], numbers: DVec2) -> Option<EmitterPoint<N>> {
        let (toward, distance, solid_angle_over_pi) = self.ball.sample(at, normal, numbers)?;
        let light = per_axis(|channel| solid_angle_over_pi * N::constant(self.radiance[channel]));
        Some(EmitterPoint { toward: per_axis(|axis| distance * toward[axis]), is_far: false, light })
    }

    fn density(&self, at: DVec3, _toward: DVec3, _distance: f64) -> Option<f64> {
        self.ball.density(at)
    }

    fn extent(&self) -> Extent {
        Extent::Ball(self.ball)
    }

    /// Mirrors show it if it is seen.
    fn has_highlights(&self) -> bool {
        !self.is_visible
    }
}
