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

    /// Returns the light that it emits toward a point, or 0 where it does not shine. `N` is `f64` for pictures; for
    /// proofs of colours, it is a number that encloses all points of a box.
    #[inline]
    fn sent<N: Number>(&self, toward: [N; 3]) -> [N; 3] {
        let (n, location) = (N::constant, self.bulb.location);
        let up = unit(per_axis(|axis| toward[axis] - n(location[axis])))[1];
        let part = (-up).max(n(0.0)).pow(n(self.narrow));
        let below = self.bulb.sent(toward).map(|channel| part * channel);
        up.either([n(0.0); 3], below)
    }

    fn size(&self) -> f64 {
        self.bulb.size()
    }
}
