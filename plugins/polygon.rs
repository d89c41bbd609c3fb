//! A polygon: a flat surface with straight edges.

use tabray::prelude::*;
use tabray::shapes::outline;

static POINTS: Pparm<List<DVec3, 3, 256>> =
    Pparm::required("points", "the corners; the side from which they run counterclockwise is lit")
        .unit("world coordinates")
        .must(
            "corners in one plane, to a billionth of the polygon's size, whose edges do not meet",
            |points: &List<DVec3, 3, 256>| triangles(&points.0).is_some(),
        );

const TABLE: Table = &[&POINTS as &dyn Row];

inventory::submit! {
    Entity::shape("polygon", "a flat surface with straight edges", &[TABLE], |args| {
        let List(points) = args.get(&POINTS);
        let faces = triangles(&points).unwrap_or_default();
        outline::body(outline::polygon(points, faces), false, false, args.accuracy()).map_err(|_| Refusal {
            attribute: Some("points"),
            message: "has no area".to_owned(),
            help: "the corners must not lie on one line",
        })
    })
}

/// Cuts a polygon into triangles; `None` if it is not flat, or meets itself.
fn triangles(points: &[DVec3]) -> Option<Vec<[u32; 3]>> {
    let points: Vec<_> = points.iter().map(DVec3::to_array).collect();
    let points: Vec<_> = outline::to_unit_size(&points).into_iter().map(DVec3::from).collect();
    let first = points[0];
    let pairs = points[1..].iter().zip(&points[2..]);
    let normal: DVec3 = pairs.map(|(one, other)| (*one - first).cross(*other - first)).sum();
    let size = points.iter().map(|point| (*point - first).abs().max_element()).fold(0.0, f64::max);
    let upright = normal.try_normalize()?;
    if points.iter().any(|point| (*point - first).dot(upright).abs() > 1e-9 * size) {
        return None;
    }
    let axis = normal.abs().max_position();
    let flat: Vec<_> =
        points.iter().map(|point| DVec2::new(point[(axis + 1) % 3], point[(axis + 2) % 3])).collect();
    outline::triangles(&flat)
}
