//! A template: a cube with rounded edges. Describe it here, and say where its formula comes from.

use tabray::prelude::*;

// Each attribute has a name, a meaning, a unit and a rule. One made with `required` must be given, one made with `or`
// has a default. The parser, its messages and the reference are made from these descriptions.
static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the position of the centre").alias(&["centre"]).unit("world coordinates");
static SIZE: Pparm<f64> =
    Pparm::required("size", "the distance from the centre to the sides").unit("world units").positive();

// The attributes in the order of the dump. Every shape has `material` without listing it.
const TABLE: Table = &[&CENTER, &SIZE];

// Its name in scenes, its meaning, and how it is made from values that have been checked.
inventory::submit! {
    Entity::shape("template", "a cube with rounded edges", &[TABLE], |args| {
        Ok(Body::implicit(Template { size: args.get(&SIZE) }, Frame::at(args.get(&CENTER))))
    })
}

/// A cube with rounded edges, centred on the origin.
struct Template {
    size: f64,
}

// A shape given by one formula. A shape with its own method of finding hits implements `Hittable` instead, as the box
// in `docs/plugins.md` does; `Bracketed` and `Certified` are for shapes that are faster and whose hits are proven.
impl Implicit for Template {
    /// Returns a value below 0 inside the shape, above 0 outside, and 0 on its surface.
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let [x, y, z] = at.map(|coordinate| coordinate / N::constant(self.size));
        x.powi(4) + y.powi(4) + z.powi(4) - N::constant(1.0)
    }

    /// Returns two corners of a box that contains the shape.
    fn bounds(&self) -> [DVec3; 2] {
        let corner = DVec3::splat(self.size);
        [-corner, corner]
    }
}
