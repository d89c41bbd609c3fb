//! A prism: a polygon extended upward.

use crate::prelude::*;
use crate::shapes::outline;

static POINTS: Pparm<List<DVec2, 3, 256>> =
    Pparm::required("points", "the corners of the polygon: the x and the z of each, relative to `base`")
        .each(&["x", "z"])
        .unit("world coordinates")
        .must("a polygon whose edges do not meet", |points: &List<DVec2, 3, 256>| {
            outline::is_simple(&points.0)
        });
static BASE: Pparm<DVec3> =
    Pparm::or("base", "the point from which the corners are measured", DVec3::ZERO).unit("world coordinates");
static HEIGHT: Pparm<f64> = Pparm::required("height", "the distance from the lower end to the upper one")
    .unit("world units")
    .positive();
static OPEN: Pparm<bool> = Pparm::or("open", "whether its two ends are left out", false);

const TABLE: Table = &[&POINTS, &BASE, &HEIGHT, &OPEN];

inventory::submit! {
    Entity::shape("prism", "a polygon extended upward", &[TABLE], |args| {
        let base = args.get(&BASE);
        let corners: Vec<_> =
            args.get(&POINTS).0.iter().map(|point| *point + DVec2::new(base.x, base.z)).collect();
        let solid = outline::prism(&corners, [base.y, base.y + args.get(&HEIGHT)], args.get(&OPEN));
        let body = solid.and_then(|solid| outline::body(solid, args.accuracy()).ok());
        body.ok_or(Refusal {
            attribute: Some("points"),
            message: "is too small at its position: some of its edges meet, or are too far away".to_owned(),
            help: "an edge must be longer than the rounding of its coordinates, about 1e-16 of their size",
        })
    })
}
