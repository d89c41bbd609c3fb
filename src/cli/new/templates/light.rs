//! A template: a lamp with a shade, which shines downward. Say here what it is.

use super::light::{self, PointLight};
use crate::prelude::*;

// Each attribute is one of these: its name, what it is, its unit and its rule. `required` has to be given; `or`
// has a default. The reader, its messages and the reference are made from them.
static NARROW: Pparm<f64> =
    Pparm::or("narrow", "how narrow its light is: 0 for as bright to the sides as below", 2.0)
        .must("0 or more", |narrow| *narrow >= 0.0);

const TABLE: Table = &[&NARROW];

// What scenes call it, what it is, and how it is made of values that have been checked. It takes what every light
// takes, and its own attributes.
inventory::submit! {
    Entity::light("template", "a lamp that shines downward", &[light::TABLE, TABLE], |args| {
        Ok(Box::new(Template { bulb: PointLight::new(args), narrow: args.get(&NARROW) }))
    })
}

struct Template {
    bulb: PointLight,
    narrow: f64,
}

impl Light for Template {
    fn location(&self) -> DVec3 {
        self.bulb.location
    }

    /// The light that it sends toward a point, or nothing where it does not point there.
    fn emissivity(&self, toward: DVec3) -> Option<Rgb> {
        let down = (self.bulb.location - toward).normalize_or_zero().y;
        (down > 0.0).then(|| self.bulb.emissivity * down.powf(self.narrow))
    }

    fn size(&self) -> f64 {
        self.bulb.size()
    }
}
