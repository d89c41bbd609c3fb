//! A procedural plane: a plane whose look changes from place to place by a rule.

use super::plane::{self, Plane};
use crate::prelude::*;

static SHADER: Pparm<OnPlane> = Pparm::required("shader", "the procedural shader");

/// What planes with a rule for their look take.
pub const TABLE: Table = &[&SHADER as &dyn Row];

inventory::submit! {
    Entity::shape("pplane", "an infinite plane with a procedural shader", &[plane::TABLE, TABLE], |args| {
        let plane = Plane::new(args);
        let origin = plane.point;
        Ok(body(args, plane, origin))
    })
}

/// A shape that looks as the `shader` of an entity whose table has [`TABLE`]'s rows.
pub fn body(args: &Args, shape: impl Hittable + 'static, origin: DVec3) -> Body {
    Body::procedural(shape, args.get(&SHADER).0, Anchor { origin, unit: 1.0 })
}
