//! Metal: a coloured mirror that reflects more of the light that grazes it.

use super::material::EMISSION;
use tabray::prelude::*;

static REFLECTANCE: Pparm<Rgb> = Pparm::or(
    "colour",
    "the fraction of the light along the normal that is reflected: 0.95 0.93 0.88 is silver, 1 0.77 0.34 is gold, 0.96 0.64 0.54 is copper",
    Rgb::new(0.91, 0.92, 0.92),
)
.alias(&["color"])
.each(COLOUR)
.between(0.0, 1.0);
static SHININESS: Pparm<f64> =
    Pparm::or("shininess", "the exponent of the highlights of lights (larger is sharper, 0 is none)", 0.0)
        .must("0 or more", |exponent| *exponent >= 0.0);
static ROUGHNESS: Pparm<f64> =
    Pparm::or("roughness", "how rough the surface is, from 0, smooth, to 1; it takes several samples", 0.0)
        .between(0.0, 1.0)
        .not_dumped();

const TABLE: Table = &[&REFLECTANCE, &SHININESS, &ROUGHNESS, &EMISSION];

inventory::submit! {
    Entity::material("metal", "a coloured mirror that reflects more of the light that grazes it", &[TABLE], |args| {
        let colour = args.get(&REFLECTANCE);
        Ok(Material {
            emission: args.get(&EMISSION),
            specular: colour,
            shininess: args.get(&SHININESS),
            interface: Some(AnyInterface::new(Metal { colour, roughness: args.get(&ROUGHNESS) })),
            ..Material::default()
        })
    })
    .known_as(&["conductor", "metallic", "metalness"])
}

/// The interface of metal.
#[derive(PartialEq)]
pub struct Metal {
    /// The fraction of the light along the normal that is reflected.
    pub colour: Rgb,
    /// How rough the surface is, from 0 to 1.
    pub roughness: f64,
}

impl Interface for Metal {
    /// Follows Schlick's approximation of Fresnel's equations (1994), and absorbs the light that is not reflected.
    fn law(&self) -> Law {
        Law::metal(self.colour, 1.0)
    }

    fn roughness(&self) -> f64 {
        self.roughness
    }
}
