//! A procedural finite plane: a rectangle whose colours are computed at each point by a shader.

use super::{fplane, plane, pplane};
use tabray::prelude::*;

inventory::submit! {
    Entity::shape(
        "pfplane",
        "a rectangle with a procedural shader",
        &[plane::TABLE, pplane::TABLE, fplane::TABLE, fplane::ROTATION],
        |args| {
            Ok(plane::body(args, fplane::shape(args)?))
        },
    )
}
