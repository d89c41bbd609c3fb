//! A difference: what is left of an object when others are taken away.

use tabray::prelude::*;
use tabray::shapes::{Objects, Operation, combined};

static OBJECTS: Pparm<Objects> = Pparm::required(
    "objects",
    "the object and the objects taken away from it, defined earlier in the scene; they are seen only as parts of \
     this one",
)
.known_as(&["children", "operands", "shapes", "solids"]);

const TABLE: Table = &[&OBJECTS as &dyn Row];

inventory::submit! {
    Entity::of_objects("difference", "what is left of an object when others are taken away", &[TABLE], |args| {
        combined(args, &OBJECTS, Operation::Difference)
    })
    .known_as(&["subtract", "subtraction"])
}
