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
static ATTENUATION: Pparm<Rgb> = Pparm::or(
    "attenuation",
    "the fraction of light that is left after a path of length `at` through the glass, in red, green and blue",
    Rgb::ONE,
)
.must("more than 0 and at most 1 in each channel", |left| left.min_element() > 0.0 && left.max_element() <= 1.0)
.not_dumped();
static AT: Pparm<f64> = Pparm::or("at", "the length of the path after which `attenuation` is left", 1.0)
    .unit("world units")
    .positive()
    .not_dumped();
static SHININESS: Pparm<f64> =
    Pparm::or("shininess", "the exponent of the highlights of lights (larger is sharper, 0 is none)", 0.0)
        .must("0 or more", |exponent| *exponent >= 0.0)
        .not_dumped();
static ROUGHNESS: Pparm<f64> =
    Pparm::or("roughness", "how rough the surface is, from 0, smooth, to 1; it takes several samples", 0.0)
        .between(0.0, 1.0)
        .not_dumped();

const TABLE: Table = &[&INDEX, &COLOUR, &TRANSPARENCY, &ATTENUATION, &AT, &SHININESS, &ROUGHNESS];

inventory::submit! {
    Entity::material("glass", "a material that bends and reflects light by its refractive index", &[TABLE], |args| {
        let glass = Glass {
            index: args.get(&INDEX),
            medium: Medium::new(args.get(&ATTENUATION), args.get(&AT)),
            roughness: args.get(&ROUGHNESS),
        };
        Ok(Material {
            diffuse: args.get(&COLOUR),
            shininess: args.get(&SHININESS),
            transparency: args.get(&TRANSPARENCY),
            interface: Some(AnyInterface::new(glass)),
            ..Material::default()
        })
    })
    .known_as(&["dielectric"])
}

/// The interface of glass.
#[derive(PartialEq)]
pub struct Glass {
    /// The refractive index inside, relative to outside.
    pub index: f64,
    /// The medium that absorbs light inside.
    pub medium: Option<Medium>,
    /// How rough the surface is, from 0 to 1.
    pub roughness: f64,
}

impl Interface for Glass {
    fn absorbs(&self) -> bool {
        false
    }

    fn medium(&self) -> Option<Medium> {
        self.medium
    }

    fn law(&self) -> Law {
        Law::Fresnel(self.index)
    }

    fn roughness(&self) -> f64 {
        self.roughness
    }
}
