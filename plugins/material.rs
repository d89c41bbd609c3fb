//! A material: how a surface answers light.

use crate::prelude::*;

static AMBIENT: Pparm<Rgb> =
    Pparm::or("ambient", "red, green and blue of the light that it sends by itself", Rgb::ZERO);
static DIFFUSE: Pparm<Rgb> =
    Pparm::or("diffuse", "red, green and blue of the light that it scatters", Rgb::ZERO);
static SPECULAR: Pparm<PerChannel> =
    Pparm::or("specular", "the part of light that it mirrors", PerChannel(Rgb::ZERO))
        .dumped("specular", " \n\n");
static SHININESS: Pparm<f64> =
    Pparm::or("shininess", "the sharpness of the glint that a light leaves, 0 for none", 0.0)
        .must("0 or more", |sharpness| *sharpness >= 0.0)
        .dumped("shininess", " \n\n");
static TRANSPARENCY: Pparm<f64> =
    Pparm::or("transparency", "the part of light that passes, tinted by the diffuse colour", 0.0)
        .must("from 0 to 1", |part| (0.0..=1.0).contains(part))
        .dumped("transparency", " \n\n");

const TABLE: Table = &[&AMBIENT, &DIFFUSE, &SPECULAR, &SHININESS, &TRANSPARENCY];

inventory::submit! {
    Entity::material("material", "how a surface answers light", &[TABLE], |args| {
        Ok(Material {
            ambient: args.get(&AMBIENT),
            diffuse: args.get(&DIFFUSE),
            specular: args.get(&SPECULAR).0,
            shininess: args.get(&SHININESS),
            transparency: args.get(&TRANSPARENCY),
        })
    })
}
