//! An intersection: the space that several objects share.

use tabray::prelude::*;
use tabray::shapes::{Objects, Operation, combined};

static OBJECTS: Pparm<Objects> = Pparm::required(
    "objects",
    "the objects, defined earlier in the scene; they are seen only as parts of it",
)
.known_as(&["children", "operands", "shapes", "solids"]);

const TABLE: Table = &[&OBJECTS as &dyn Row];

inventory::submit! {
    Entity::of_objects("intersection", "the space that several objects share", &[TABLE], |args| {
        combined(args, &OBJECTS, Operation::Intersection)
    })
    .known_as(&["intersect"])
}
