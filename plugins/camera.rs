//! The camera: the viewer, and the screen in the plane z = 0 that the viewer looks through.

use crate::prelude::*;

static PIXELDIM: Pparm<[i64; 2]> = Pparm::required("pixeldim", "the width and height of the picture")
    .alias(&["pixel_dim"])
    .unit("pixels")
    .must("from 1 to 100000 each way", |size: &[i64; 2]| size.iter().all(|side| (1..=100_000).contains(side)))
    .dumped("pixel_dim", " \n");
static WORLDDIM: Pparm<DVec2> = Pparm::required("worlddim", "the width and height of the screen")
    .alias(&["world_dim"])
    .unit("world units")
    .must("positive each way", |size: &DVec2| size.min_element() > 0.0)
    .dumped("world_dim", " \n");
static VIEWPOINT: Pparm<DVec3> = Pparm::required("viewpoint", "where the viewer is")
    .alias(&["view_point"])
    .unit("world coordinates")
    .must("in front of the screen (z above 0)", |at: &DVec3| at.z > 0.0)
    .dumped("view_point", "\n");

static SAMPLES: Pparm<i64> =
    Pparm::or("samples", "how many rays look through each pixel, to smooth edges", 1)
        .must("from 1 to 65536", |samples| (1..=Sampler::MOST.into()).contains(samples))
        .not_dumped();

static ACCURACY: Pparm<Accuracy> =
    Pparm::or("accuracy", "how exactly shapes find their hits", Accuracy::Exact).not_dumped();

const TABLE: Table = &[&PIXELDIM, &WORLDDIM, &VIEWPOINT, &SAMPLES, &ACCURACY];

inventory::submit! {
    Entity::camera("camera", "the viewer, and a screen from the world's origin to the right and up", &[TABLE], |args| {
        if args.get(&VIEWPOINT).abs().max_element() < LEAST_LENGTH {
            return Err(Refusal {
                attribute: Some("viewpoint"),
                message: "is so near to the screen that the squares of distances vanish".to_owned(),
                help: "1e-152 world units is the least distance that can be squared",
            });
        }
        Ok(Camera {
            // The rules keep the whole numbers in range.
            pixels: args.get(&PIXELDIM).map(|side| side as usize),
            screen: args.get(&WORLDDIM),
            viewpoint: args.get(&VIEWPOINT),
            samples: args.get(&SAMPLES) as u32,
            sampler: Sampler::default(),
            // The notes' way of calling has a default of its own.
            accuracy: args.get_given(&ACCURACY).unwrap_or(args.accuracy()),
        })
    })
}
