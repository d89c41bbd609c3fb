//! A procedural sphere: a sphere whose look changes from place to place by a rule.

use super::sphere::{self, Sphere};
use crate::prelude::*;

static SHADER: Pparm<OnSphere> = Pparm::required("shader", "the procedural shader");

const TABLE: Table = &[&SHADER as &dyn Row];

inventory::submit! {
    Entity::shape("psphere", "a sphere with a procedural shader", &[sphere::TABLE, TABLE], |args| {
        let sphere = Sphere::new(args);
        let anchor = Anchor { origin: sphere.center, unit: 2.0 * sphere.radius };
        Ok(Body::procedural(sphere, args.get(&SHADER).0, anchor))
    })
}
