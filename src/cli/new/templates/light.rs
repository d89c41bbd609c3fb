//! A template: a light with a shade, which shines downward. Describe it here.

use super::light::{self, PointLight};
use tabray::prelude::*;

// Each attribute has a name, a meaning, a unit and a rule. One made with `required` must be given, one made with `or`
// has a default. The parser, its messages and the reference are made from these descriptions.
static NARROW: Pparm<f64> =
    Pparm::or("narrow", "how narrow the beam is: 0 is as bright to the sides as below", 2.0)
        .must("0 or more", |narrow| *narrow >= 0.0);

const TABLE: Table = &[&NARROW];

// Its name in scenes, its meaning, and how it is made from values that have been checked. It takes the attributes of
// every light and its own.
inventory::submit! {
    Entity::light("template", "a light that shines downward", &[light::TABLE, TABLE], |args| {
        Ok(Box::new(Template { bulb: PointLight::new(args), narrow: args.get(&NARROW) }))
    })
}

struct Template {
    bulb: PointLight,
    narrow: f64,
}

impl Light for Template {
    #[inline]
    fn location(&self) -> DVec3 {
        self.bulb.location
    }

    /// Returns the light that it emits toward a point, or nothing where it does not shine.
    #[inline]
    fn emissivity(&self, toward: DVec3) -> Option<Rgb> {
        let down = (self.bulb.location - toward).normalize_or_zero().y;
        (down > 0.0).then(|| self.bulb.emissivity * libm::pow(down, self.narrow))
    }

    fn size(&self) -> f64 {
        self.bulb.size()
    }
}
