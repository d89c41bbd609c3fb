//! The camera: the viewer, and the image plane at z = 0 through which the viewer looks.

use crate::prelude::*;

static PIXELDIM: Pparm<[i64; 2]> = Pparm::required("pixeldim", "the width and height of the image")
    .alias(&["pixel_dim"])
    .each(&["width", "height"])
    .unit("pixels")
    .between(1.0, 100_000.0)
    .dumped("pixel_dim", " \n");
static WORLDDIM: Pparm<DVec2> = Pparm::required("worlddim", "the width and height of the image plane")
    .alias(&["world_dim"])
    .each(&["width", "height"])
    .unit("world units")
    .must("positive in each dimension", |size: &DVec2| size.min_element() > 0.0)
    .dumped("world_dim", " \n");
static VIEWPOINT: Pparm<DVec3> = Pparm::required("viewpoint", "the position of the viewer")
    .alias(&["view_point"])
    .unit("world coordinates")
    .must("in front of the image plane (z above 0)", |at: &DVec3| at.z > 0.0)
    .dumped("view_point", "\n");

static SAMPLES: Pparm<i64> = Pparm::or("samples", "the number of samples per pixel, to smooth edges", 1)
    .between(1.0, Sampler::MOST as f64)
    .not_dumped();

static ACCURACY: Pparm<Accuracy> =
    Pparm::or("accuracy", "how exactly hits are computed", Accuracy::Exact).not_dumped();

const TABLE: Table = &[&PIXELDIM, &WORLDDIM, &VIEWPOINT, &SAMPLES, &ACCURACY];

inventory::submit! {
    Entity::camera("camera", "the viewer, and an image plane that extends right and up from the world's origin", &[TABLE], |args| {
        if args.get(&VIEWPOINT).abs().max_element() < LEAST_LENGTH {
            return Err(Refusal {
                attribute: Some("viewpoint"),
                message: "is so close to the image plane that squared distances underflow".to_owned(),
                help: "1e-152 world units is the smallest distance that can be squared",
            });
        }
        Ok(Camera {
            adaptive: None,
            certain: false,
            scramble: 0,
            exposure: 0.0,
            // The attributes' rules ensure that these casts are lossless.
            pixels: args.get(&PIXELDIM).map(|side| side as usize),
            screen: args.get(&WORLDDIM),
            viewpoint: args.get(&VIEWPOINT),
            samples: args.get(&SAMPLES) as u32,
            sampler: Sampler::default(),
            // The notes' command line has a default accuracy of its own.
            accuracy: args.get_given(&ACCURACY).unwrap_or(args.accuracy()),
        })
    })
}
