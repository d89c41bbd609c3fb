//! A material: how a surface emits, reflects and transmits light.

use tabray::prelude::*;

static AMBIENT: Pparm<Rgb> =
    Pparm::or("ambient", "the emission in red, green and blue, independent of lights", Rgb::ZERO)
        .each(COLOUR);
/// The light that a surface gives by itself.
pub static EMISSION: Pparm<Rgb> = Pparm::or(
    "emission",
    "the light that it gives in red, green and blue; it lights others where the camera has `bounces`",
    Rgb::ZERO,
)
.known_as(&["emissive", "emissivity", "glow"])
.each(COLOUR)
.must("0 or more in each channel", |light| light.min_element() >= 0.0)
.not_dumped();
static DIFFUSE: Pparm<Rgb> =
    Pparm::or("diffuse", "the diffuse reflection coefficients for red, green and blue", Rgb::ZERO)
        .known_as(&["color", "colour", "albedo"])
        .each(COLOUR);
static SPECULAR: Pparm<PerChannel> = Pparm::or(
    "specular",
    "the specular reflection coefficient, for mirror images and highlights",
    PerChannel(Rgb::ZERO),
)
.dumped("specular", " \n\n");
static HIGHLIGHT: Pparm<PerChannel> = Pparm::or(
    "highlight",
    "the reflection coefficient for highlights of lights, without mirror images",
    PerChannel(Rgb::ZERO),
)
.must("0 or more in each channel", |PerChannel(strength)| strength.min_element() >= 0.0)
.not_dumped();
static SHININESS: Pparm<f64> =
    Pparm::or("shininess", "the exponent of highlights (larger is sharper, 0 is none)", 0.0)
        .must("0 or more", |sharpness| *sharpness >= 0.0)
        .dumped("shininess", " \n\n");
static TRANSPARENCY: Pparm<f64> =
    Pparm::or("transparency", "the fraction of light that is transmitted, tinted by the diffuse colour", 0.0)
        .between(0.0, 1.0)
        .dumped("transparency", " \n\n");

const TABLE: Table = &[&AMBIENT, &DIFFUSE, &SPECULAR, &SHININESS, &TRANSPARENCY, &EMISSION, &HIGHLIGHT];

inventory::submit! {
    Entity::material("material", "how a surface emits, reflects and transmits light", &[TABLE], |args| {
        Ok(Material {
            ambient: args.get(&AMBIENT),
            emission: args.get(&EMISSION),
            diffuse: args.get(&DIFFUSE),
            specular: args.get(&SPECULAR).0,
            highlight: args.get(&HIGHLIGHT).0,
            shininess: args.get(&SHININESS),
            transparency: args.get(&TRANSPARENCY),
            interface: None,
        })
    })
}
