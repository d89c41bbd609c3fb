//! A sun: a disc in the sky, infinitely far away.

use super::light;
use tabray::prelude::*;

static DIRECTION: Pparm<DVec3> =
    Pparm::required("direction", "the direction in which it stands, seen from the scene")
        .known_as(&["toward", "position"])
        .nonzero();
static ANGLE: Pparm<f64> =
    Pparm::or("angle", "the angle at which its disc is seen, which makes shadows soft", 0.53)
        .known_as(&["size", "angular_size"])
        .unit("degrees")
        .between(0.0, 90.0);

const TABLE: Table = &[&DIRECTION, &light::EMISSIVITY, &ANGLE];

inventory::submit! {
    Entity::light("sun", "a disc in the sky: a surface that faces it gets its `emissivity`, at any distance", &[TABLE], |args| {
        let (direction, half) = (args.get(&DIRECTION), 0.5 * args.get(&ANGLE).to_radians());
        let sine = libm::sin(0.5 * half);
        Ok(Box::new(Sun {
            direction: tabray::exact::double_double::scaled(direction).normalize(),
            height: 2.0 * sine * sine,
            emissivity: args.get(&light::EMISSIVITY),
        }))
    })
    .known_as(&["sunlight", "directional", "directional_light", "distant", "parallel"])
    .without_falloff()
}

struct Sun {
    /// The unit vector toward its middle.
    direction: DVec3,
    /// 1 minus the cosine of half the angle at which it is seen.
    height: f64,
    emissivity: Rgb,
}

impl Sun {
    /// Returns `light` of each sample: the radiance times the solid angle of the sun's disc over pi. The radiance is
    /// the emissivity divided by the square of the sine of half the angle.
    fn light<N: Number>(&self) -> [N; 3] {
        let two = N::constant(2.0);
        let factor = two / (two - N::constant(self.height));
        per_axis(|channel| factor * N::constant(self.emissivity[channel]))
    }
}

impl Light for Sun {
    fn location(&self) -> DVec3 {
        DVec3::ZERO
    }

    fn is_far(&self) -> bool {
        true
    }

    fn sent<N: Number>(&self, _toward: [N; 3]) -> [N; 3] {
        constants(self.emissivity)
    }

    fn brightest(&self) -> Option<Rgb> {
        // More than its rounding.
        Some((1.0 + 1e-12) * Rgb::from(self.light()).abs())
    }

    fn emitter(&self) -> Option<&dyn EnclosedEmitter> {
        Some(self)
    }
}

impl Emitter for Sun {
    fn sample<N: Number>(&self, _at: [N; 3], _normal: [N; 3], numbers: DVec2) -> Option<EmitterPoint<N>> {
        let toward = emitter::in_cone(constants(self.direction), N::constant(self.height), numbers)?;
        Some(EmitterPoint { toward, is_far: true, light: self.light() })
    }

    fn extent(&self) -> Extent {
        Extent::Cone { axis: self.direction, height: self.height }
    }
}
