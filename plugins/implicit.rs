//! A surface by its formula: the points where it is 0.

use tabray::prelude::*;
use tabray::shapes::field;

static FORMULA: Pparm<Field> = Pparm::required(
    "formula",
    "the formula, which is 0 on the surface, below 0 inside of it and above 0 outside",
);
static CENTER: Pparm<DVec3> = Pparm::or("center", "the origin of the formula's coordinates", DVec3::ZERO)
    .alias(&["centre"])
    .unit("world coordinates");
static BOX: Pparm<[f64; 6]> = Pparm::required(
    "box",
    "the box that clips the surface, as its low and its high corner relative to `center`; where it clips, the surface is \
     open, and its inside is seen",
)
.each(&["low x", "low y", "low z", "high x", "high y", "high z"])
.unit("world units")
.must("a low corner and a high corner above it", |[a, b, c, x, y, z]: &[f64; 6]| a < x && b < y && c < z);

const TABLE: Table = &[&FORMULA, &CENTER, &BOX];

inventory::submit! {
    Entity::shape("implicit", "a surface by its formula", &[TABLE], |args| {
        let [x, y, z, x2, y2, z2] = args.get(&BOX);
        let corners = [DVec3::new(x, y, z), DVec3::new(x2, y2, z2)];
        let (formula, warnings) = field::reduced(args.get(&FORMULA));
        let formula = formula.within(corners.map(|corner| corner.to_array()));
        let surface = Surface { formula, corners };
        field::check(&surface.formula, surface.corners).map_err(|fault| {
            let (what, help) = fault.message();
            Refusal { attribute: Some("formula"), message: format!("has a formula {what}"), help }
        })?;
        Ok(Body { warnings, ..Body::implicit(surface, Frame::at(args.get(&CENTER))) })
    })
    .known_as(&["isosurface", "sdf"])
}

/// The surface where a scene's formula is 0.
struct Surface {
    formula: Field,
    corners: [DVec3; 2],
}

impl Implicit for Surface {
    const IS_IN_WIDE_BOX: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.formula.at(at)
    }

    fn field(&self) -> Option<&Field> {
        Some(&self.formula)
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        (!field::is_outside(&self.formula, self.corners)).then_some("its box may cut its surface")
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.corners
    }
}
