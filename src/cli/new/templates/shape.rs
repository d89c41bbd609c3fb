//! A template: a cube with round edges. Say here what it is, and where its formula comes from.

use crate::prelude::*;

// Each attribute is one of these: its name, what it is, its unit and its rule. `required` has to be given; `or`
// has a default. The reader, its messages and the reference are made from them.
static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the point in its middle").alias(&["centre"]).unit("world coordinates");
static SIZE: Pparm<f64> = Pparm::required("size", "the distance from its center to its sides")
    .unit("world units")
    .must("positive", |size| *size > 0.0);

// The attributes in the order of the dump. Every shape has `material` by itself.
const TABLE: Table = &[&CENTER, &SIZE];

// What scenes call it, what it is, and how it is made of values that have been checked.
inventory::submit! {
    Entity::shape("template", "a cube with round edges", &[TABLE], |args| {
        Ok(Body::implicit(Template { size: args.get(&SIZE) }, Frame::at(args.get(&CENTER))))
    })
}

/// A cube with round edges, around the origin.
struct Template {
    size: f64,
}

// A shape that is one formula. One with a method of its own to find where a ray meets it implements `Hittable`
// instead, as the box in `docs/plugins.md` does; `Bracketed` and `Certified` are for what is faster and proven.
impl Implicit for Template {
    /// Below 0 inside of the shape, above 0 outside, and 0 on it.
    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let [x, y, z] = at.map(|coordinate| coordinate / N::constant(self.size));
        x.powi(4) + y.powi(4) + z.powi(4) - N::constant(1.0)
    }

    /// Two corners of a box that holds all of it.
    fn bounds(&self) -> [DVec3; 2] {
        let corner = DVec3::splat(self.size);
        [-corner, corner]
    }
}
