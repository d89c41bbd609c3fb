//! A copy of another object in another place, which shares its shape.

use tabray::geometry::Placement;
use tabray::prelude::*;

static OBJECT: Pparm<NamedBody> = Pparm::required(
    "object",
    "the object to be placed, defined earlier in the scene; it is seen only where it is placed",
);
static SCALE: Pparm<DVec3> =
    Pparm::or("scale", "the scale factors along the object's x, y and z", DVec3::ONE)
        .must("positive in each dimension", |scale: &DVec3| scale.min_element() > 0.0);
static ROTATION: Pparm<Rotation> = Pparm::or(
    "rotation",
    "the angles by which the scaled object is rotated around x, then y, then z, or an axis and the angle around it, counterclockwise",
    Rotation::NONE,
)
.must("around a nonzero axis", Rotation::has_axis);
static TRANSLATION: Pparm<DVec3> =
    Pparm::or("translation", "where the object's origin lies", DVec3::ZERO).unit("world coordinates");

/// The maximum number of copies within each other. Margins for rounding grow by a factor of up to 3.5 with each level
/// of copies; from 24 copies on, spheres of radius 1 were seen with wrong pixels.
const MAX_DEPTH: u32 = 12;

const TABLE: Table = &[&OBJECT, &SCALE, &ROTATION, &TRANSLATION];

inventory::submit! {
    Entity::of_objects("place", "a copy of an object in another place", &[TABLE], |args| {
        let placement = Placement {
            scale: args.get(&SCALE),
            rotation: args.get(&ROTATION),
            translation: args.get(&TRANSLATION),
        };
        let object = args.get(&OBJECT).get().cloned().ok_or(Refusal {
            attribute: Some("object"),
            message: "refers to an object that has not been made".to_owned(),
            help: "define the object before it is placed",
        })?;
        if object.depth == MAX_DEPTH {
            return Err(Refusal {
                attribute: Some("object"),
                message: format!("is a copy of a copy, more than {MAX_DEPTH} deep"),
                help: "rounding grows with each copy: place the first object instead",
            });
        }
        Ok(Body::placed(&object, (placement, args.planes_end_at()), args.material_of_all()))
    })
    .known_as(&["translate", "rotate", "transform", "instance", "move", "scale", "rotation", "translation"])
}
