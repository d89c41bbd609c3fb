//! A union: what lies in any of several objects.

use tabray::prelude::*;
use tabray::shapes::{Objects, Operation, combined};

static OBJECTS: Pparm<Objects> = Pparm::required(
    "objects",
    "the objects, defined earlier in the scene; they are seen only as parts of it",
)
.known_as(&["children", "operands", "shapes", "solids"]);

const TABLE: Table = &[&OBJECTS as &dyn Row];

inventory::submit! {
    Entity::of_objects("union", "several objects as one: what lies in any of them", &[TABLE], |args| {
        combined(args, &OBJECTS, Operation::Union)
    })
    .known_as(&["merge", "csg"])
}
