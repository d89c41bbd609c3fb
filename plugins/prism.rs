//! A prism: a polygon extended upward.

use tabray::prelude::*;
use tabray::shapes::outline;

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
        let (base, mut are_rounded) = (args.get(&BASE), false);
        let mut from_base = |x: f64, y: f64, z: f64| outline::sum(base, DVec3::new(x, y, z), &mut are_rounded);
        let corner = |point: &DVec2| {
            let DVec3 { x, z, .. } = from_base(point.x, 0.0, point.y);
            DVec2::new(x, z)
        };
        let corners: Vec<_> = args.get(&POINTS).0.iter().map(corner).collect();
        let top = from_base(0.0, args.get(&HEIGHT), 0.0).y;
        let is_open = args.get(&OPEN);
        let solid = outline::prism(&corners, [base.y, top], is_open);
        // As with a tube, its inside is seen.
        let body = solid.and_then(|solid| outline::body(solid, are_rounded, is_open, args.accuracy()).ok());
        body.ok_or(Refusal {
            attribute: Some("points"),
            message: "is too small at its position: some of its edges meet, or are too far away".to_owned(),
            help: "an edge must be longer than the rounding of its coordinates, about 1e-16 of their size",
        })
    })
}
