//! A box: a cuboid with its sides along the axes.

use tabray::prelude::*;
use tabray::shapes::outline;

static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the position of the centre").alias(&["centre"]).unit("world coordinates");
static SIZE: Pparm<DVec3> = Pparm::required("size", "the width, height and depth")
    .each(&["width", "height", "depth"])
    .unit("world units")
    .must("positive in each dimension", |size: &DVec3| size.min_element() > 0.0);

const TABLE: Table = &[&CENTER, &SIZE];

inventory::submit! {
    Entity::shape("box", "a cuboid with its sides along the axes", &[TABLE], |args| {
        let (center, half) = (args.get(&CENTER), 0.5 * args.get(&SIZE));
        let mut are_rounded = false;
        let [low, high] = [-half, half].map(|half| outline::sum(center, half, &mut are_rounded));
        let corners = [(low.x, low.z), (high.x, low.z), (high.x, high.z), (low.x, high.z)].map(DVec2::from);
        let solid = outline::prism(&corners, [low.y, high.y], false);
        let body = solid.and_then(|solid| outline::body(solid, are_rounded, false, args.accuracy()).ok());
        body.ok_or(Refusal {
            attribute: Some("size"),
            message: "is too small at its position: its sides coincide, or are too far away".to_owned(),
            help: "a side must be longer than the rounding of its coordinates, about 1e-16 of their size",
        })
    })
    .known_as(&["cube", "cuboid", "block"])
}
