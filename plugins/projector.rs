//! A projector: a light that throws a picture.

use super::light::{self, PointLight};
use super::texplane::{self, Picture};
use super::{fplane, plane};
use crate::prelude::*;

static HEADING: Derived = Derived(|_| Datum::Word(String::new()).line("projector", " \n"));

const TABLE: Table = &[&HEADING as &dyn Row];

inventory::submit! {
    Entity::light(
        "projector",
        "a light that projects a texture through a rectangle, which is itself invisible",
        &[light::TABLE, TABLE, plane::TABLE, fplane::TABLE, fplane::ROTATION, texplane::TABLE],
        |args| Ok(Box::new(Projector { light: PointLight::new(args), picture: Picture::new(args)? })),
    )
    .dumped_as("light")
}

struct Projector {
    light: PointLight,
    picture: Picture,
}

impl Light for Projector {
    fn location(&self) -> DVec3 {
        self.light.location
    }

    /// Light gets only where the way to the lamp leads through the picture, and takes its colours.
    fn emissivity(&self, toward: DVec3) -> Option<Rgb> {
        let ray = Ray { origin: toward, dir: (self.light.location - toward).normalize() };
        let distance = self.picture.rectangle.plane.crossing(&ray);
        let at = ray.at(distance);
        (distance > 0.0 && self.picture.rectangle.has_crossing(&ray, distance))
            .then(|| self.light.emissivity * self.picture.colour(at))
    }

    /// No texel is above 1.
    fn brightest(&self) -> Option<Rgb> {
        self.light.even()
    }

    fn size(&self) -> f64 {
        self.light.size()
    }
}
