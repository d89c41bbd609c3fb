//! A procedural plane: a plane whose look changes from place to place by a rule.

use super::plane;
use crate::prelude::*;

static SHADER: Pparm<OnPlane> = Pparm::required("shader", "the procedural shader");

/// What planes with a rule for their look take.
pub const TABLE: Table = &[&SHADER as &dyn Row];

inventory::submit! {
    Entity::shape("pplane", "an infinite plane with a procedural shader", &[plane::TABLE, TABLE], |args| {
        Ok(body(args, plane::shape(args)))
    })
}

/// A plane's shape that looks as the `shader` of an entity whose table has its rows and [`TABLE`]'s.
pub fn body(args: &Args, shape: AnyShape) -> Body {
    let anchor = Anchor { origin: args.get(&plane::POINT), unit: 1.0 };
    Body::procedural(shape, args.get(&SHADER).0, anchor)
}
