//! A light: a point that emits equally in all directions.

use tabray::prelude::*;

pub static LOCATION: Pparm<DVec3> = Pparm::required("location", "the position of the light")
    .known_as(&["position", "center"])
    .unit("world coordinates");
pub static EMISSIVITY: Pparm<Rgb> = Pparm::required("emissivity", "the emission in red, green and blue")
    .known_as(&["intensity", "power", "brightness", "color", "colour"])
    .each(COLOUR);

static SIZE: Pparm<f64> = Pparm::or("size", "the radius of a spherical light, for soft shadows", 0.0)
    .unit("world units")
    .must("0 or more", |size| *size >= 0.0)
    .not_dumped();

/// The rows of every light.
pub const TABLE: Table = &[&LOCATION, &EMISSIVITY, &SIZE];

inventory::submit! {
    Entity::light("light", "a point light that emits equally in all directions, or a spherical light if it has a `size`", &[TABLE], |args| {
        Ok(Box::new(PointLight::new(args)))
    })
    .known_as(&["point_light", "pointlight", "light_source", "lamp"])
}

/// A light that emits equally in all directions. Other lights contain one.
pub struct PointLight {
    pub location: DVec3,
    pub emissivity: Rgb,
    /// The radius of a spherical light, in world units; 0 for a point.
    size: f64,
}

impl PointLight {
    /// Makes the light of an entity whose table has the rows of [`TABLE`].
    pub fn new(args: &Attributes) -> Self {
        Self { location: args.get(&LOCATION), emissivity: args.get(&EMISSIVITY), size: args.get(&SIZE) }
    }
}

impl Light for PointLight {
    #[inline]
    fn location(&self) -> DVec3 {
        self.location
    }

    #[inline]
    fn sent<N: Number>(&self, _toward: [N; 3]) -> [N; 3] {
        constants(self.emissivity)
    }

    fn uniform(&self) -> Option<Rgb> {
        Some(self.emissivity)
    }

    fn size(&self) -> f64 {
        self.size
    }
}
