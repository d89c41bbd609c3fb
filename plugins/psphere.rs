//! A procedural sphere: a sphere whose colours are computed at each point by a shader.

use super::sphere;
use tabray::prelude::*;

static SHADER: Pparm<OnSphere> = Pparm::or("shader", "the procedural shader", OnSphere::Number(0));

const TABLE: Table = &[&SHADER as &dyn Row];

inventory::submit! {
    Entity::shape("psphere", "a sphere with a procedural shader", &[sphere::TABLE, TABLE], |args| {
        Ok(sphere::body(args))
    })
}
