//! A procedural plane: a plane whose colours are computed at each point by a shader.

use super::plane;
use crate::prelude::*;

static SHADER: Pparm<OnPlane> = Pparm::required("shader", "the procedural shader");

/// The rows of planes with a procedural shader.
pub const TABLE: Table = &[&SHADER as &dyn Row];

inventory::submit! {
    Entity::shape("pplane", "an infinite plane with a procedural shader", &[plane::TABLE, TABLE], |args| {
        Ok(body(args, plane::shape(args)))
    })
}

/// Makes an object of a plane's shape and the `shader` of an entity whose table has the rows of [`plane::TABLE`] and
/// [`TABLE`].
pub fn body(args: &Args, shape: AnyShape) -> Body {
    let anchor = Anchor { origin: args.get(&plane::POINT), unit: 1.0 };
    Body::procedural(shape, args.get(&SHADER).0, anchor)
}
