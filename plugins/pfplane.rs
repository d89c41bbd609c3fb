//! A procedural finite plane: a rectangle whose look changes from place to place by a rule.

use super::{fplane, plane, pplane};
use crate::prelude::*;

inventory::submit! {
    Entity::shape(
        "pfplane",
        "a rectangle with a procedural shader",
        &[plane::TABLE, pplane::TABLE, fplane::TABLE, fplane::ROTATION],
        |args| {
            Ok(pplane::body(args, fplane::shape(args)?))
        },
    )
}
