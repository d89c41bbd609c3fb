//! The notes' camera: the viewer, and the image plane at z = 0 through which the viewer looks.

use std::sync::Arc;
use tabray::prelude::*;

static WORLDDIM: Pparm<DVec2> = Pparm::required("worlddim", "the width and height of the image plane")
    .alias(&["world_dim"])
    .each(&["width", "height"])
    .unit("world units")
    .must("positive in each dimension", |size: &DVec2| size.min_element() > 0.0)
    .dumped("world_dim", " \n");
static VIEWPOINT: Pparm<DVec3> = Pparm::required("viewpoint", "the position of the viewer")
    .alias(&["view_point"])
    .pose(Pose::Position)
    .unit("world coordinates")
    .must("off the image plane (z other than 0)", |at: &DVec3| at.z != 0.0)
    .dumped("view_point", "\n");

const TABLE: Table = &[&WORLDDIM, &VIEWPOINT];

inventory::submit! {
    Entity::camera("camera", "the viewer, and an image plane that extends right and up from the world's origin", &[TABLE], |args| {
        if args.get(&VIEWPOINT).abs().max_element() < MIN_LENGTH {
            return Err(Refusal {
                attribute: Some("viewpoint"),
                message: "is so close to the image plane that squared distances underflow".to_owned(),
                help: "1e-152 world units is the smallest distance that can be squared",
            });
        }
        Ok(Arc::new(Pinhole { screen: args.get(&WORLDDIM), viewpoint: args.get(&VIEWPOINT) }))
    })
}
