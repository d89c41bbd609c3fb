//! Glass: a material that bends and reflects light by its refractive index.

use tabray::prelude::*;

static INDEX: Pparm<f64> = Pparm::or(
    "index",
    "the refractive index inside, relative to outside: 1.5 is glass, 1.33 water, 0.75 air in water",
    1.5,
)
.between(0.25, 4.0);
static COLOUR: Pparm<Rgb> = Pparm::or(
    "colour",
    "the tint of light that passes through a surface, scaled so that its strongest channel is 1",
    Rgb::ONE,
)
.alias(&["color"])
.must("0 or more in each channel, and more in one", |colour| {
    colour.min_element() >= 0.0 && colour.max_element() > 0.0
});
static TRANSPARENCY: Pparm<f64> =
    Pparm::or("transparency", "the transmitted fraction of the light that is not reflected", 1.0)
        .must("more than 0 and at most 1", |fraction| *fraction > 0.0 && *fraction <= 1.0);

const TABLE: Table = &[&INDEX, &COLOUR, &TRANSPARENCY];

inventory::submit! {
    Entity::material("glass", "a material that bends and reflects light by its refractive index", &[TABLE], |args| {
        Ok(Material {
            diffuse: args.get(&COLOUR),
            transparency: args.get(&TRANSPARENCY),
            interface: Some(AnyInterface::new(Glass { index: args.get(&INDEX) })),
            ..Material::default()
        })
    })
    .known_as(&["dielectric"])
}

#[derive(PartialEq)]
struct Glass {
    index: f64,
}

impl Interface for Glass {
    /// Follows Snell's law and Fresnel's equations for light that is not polarised.
    fn cross(&self, dir: DVec3, normal: DVec3, side: Side) -> Crossing {
        if self.index == 1.0 {
            return Crossing { reflected: Rgb::ZERO, onward: Some(dir) };
        }
        let (from, to) = match side {
            Side::Outside => (1.0, self.index),
            Side::Inside => (self.index, 1.0),
        };
        let ratio = from / to;
        let cosine = (-dir.dot(normal)).clamp(0.0, 1.0);
        let below = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
        if below <= 0.0 {
            return Crossing { reflected: Rgb::ONE, onward: None };
        }
        let onward = below.sqrt();
        let across = (from * cosine - to * onward) / (from * cosine + to * onward);
        let along = (to * cosine - from * onward) / (to * cosine + from * onward);
        Crossing {
            reflected: Rgb::splat(0.5 * (across * across + along * along)),
            onward: Some((ratio * dir + (ratio * cosine - onward) * normal).normalize()),
        }
    }

    fn absorbs(&self) -> bool {
        false
    }
}
