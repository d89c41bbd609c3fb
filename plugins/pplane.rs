//! A procedural plane: a plane whose colours are computed at each point by a shader.

use super::plane;
use tabray::prelude::*;

static SHADER: Pparm<OnPlane> = Pparm::required("shader", "the procedural shader");

/// The rows of planes with a procedural shader.
pub const TABLE: Table = &[&SHADER as &dyn Row];

inventory::submit! {
    Entity::shape("pplane", "an infinite plane with a procedural shader", &[plane::TABLE, TABLE], |args| {
        Ok(plane::body(args, plane::shape(args)))
    })
}
