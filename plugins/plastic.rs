//! Plastic: a matt body under a clear coat.

use super::material::EMISSION;
use tabray::prelude::*;
use tabray::world::coat::{ClearCoat, fresnel};
use tabray::world::number::Number;

static BODY: Pparm<Rgb> = Pparm::or("colour", "the colour of the body under the coat", Rgb::splat(0.5))
    .alias(&["color"])
    .known_as(&["diffuse", "albedo"])
    .each(COLOUR)
    .between(0.0, 1.0);
static INDEX: Pparm<f64> =
    Pparm::or("index", "the refractive index of the coat: 1.5 is lacquer, 1.33 water", 1.5).between(1.0, 4.0);
static ROUGHNESS: Pparm<f64> =
    Pparm::or("roughness", "how rough the coat is, from 0, smooth, to 1; it takes several samples", 0.0)
        .between(0.0, 1.0);
static SHININESS: Pparm<f64> =
    Pparm::or("shininess", "the exponent of the highlights of lights (larger is sharper, 0 is none)", 0.0)
        .must("0 or more", |exponent| *exponent >= 0.0);

const TABLE: Table = &[&BODY, &INDEX, &ROUGHNESS, &SHININESS, &EMISSION];

inventory::submit! {
    Entity::material("plastic", "a matt body under a clear coat, as of plastic, lacquer and glaze", &[TABLE], |args| {
        let (index, roughness) = (args.get(&INDEX), args.get(&ROUGHNESS));
        Ok(Material {
            diffuse: args.get(&BODY),
            emission: args.get(&EMISSION),
            specular: Rgb::splat(fresnel(index, 1.0)),
            shininess: args.get(&SHININESS),
            interface: Some(AnyInterface::new(Plastic::new(index, roughness))),
            ..Material::default()
        })
    })
    .known_as(&["lacquer", "glaze", "roughplastic"])
}

/// The interface of a matt body under a clear coat.
#[derive(PartialEq)]
pub struct Plastic {
    index: f64,
    roughness: f64,
    coat: ClearCoat,
}

impl Plastic {
    /// Makes a coat of a refractive index from 1 to 4, with a roughness from 0 to 1.
    pub fn new(index: f64, roughness: f64) -> Self {
        Self { index, roughness, coat: ClearCoat::new(index, roughness) }
    }
}

impl Interface for Plastic {
    /// Follows Fresnel's equations, and leaves the light that is not reflected to the body.
    fn cross(&self, dir: DVec3, normal: DVec3, _side: Side) -> Crossing {
        Crossing { reflected: Rgb::splat(fresnel(self.index, -dir.dot(normal))), onward: None }
    }

    fn is_coat(&self) -> bool {
        true
    }

    /// In pictures alone: what the coat reflects is summed over facets in plain numbers.
    fn passed<N: Number>(&self, cosine: N) -> Option<N> {
        cosine.plain().map(|cosine| N::constant(self.coat.passed(cosine)))
    }

    fn body<N: Number>(&self, colour: [N; 3]) -> [N; 3] {
        self.coat.body(colour)
    }

    fn roughness(&self) -> f64 {
        self.roughness
    }
}
