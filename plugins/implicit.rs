//! A surface by its formula: the points where it is 0.

use std::sync::OnceLock;
use tabray::prelude::*;
use tabray::shapes::field::{self, Reduced};

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
        let Reduced { formula, denominator, warnings } = field::reduced(args.get(&FORMULA));
        let ends = corners.map(|corner| corner.to_array());
        let (formula, domain) = (formula.clone().within(ends), formula.domain(ends));
        let refusal = |what: &str, help| Refusal {
            attribute: Some("formula"),
            message: format!("has a formula that is {what} in its box"),
            help,
        };
        if domain.as_ref().is_some_and(|domain| field::bounds(domain, corners).high < 0.0) {
            return Err(refusal(
                "nowhere defined",
                "a square root, a logarithm and a power with a fraction are defined from 0 upward: change the formula, or \
                 the box",
            ));
        }
        if field::is_nowhere(&formula, corners) {
            return Err(refusal(
                "nowhere 0",
                "the surface is where the formula is 0: change the formula, or the box",
            ));
        }
        let is_negated = denominator.is_some_and(|denominator| field::bounds(&denominator, corners).low <= 0.0);
        let surface = Surface { formula, domain, is_negated, corners, why_not_closed: OnceLock::new() };
        Ok(Body { warnings, ..Body::implicit(surface, Frame::at(args.get(&CENTER))) })
    })
    .known_as(&["isosurface", "sdf"])
}

/// The surface where a scene's formula is 0.
struct Surface {
    formula: Field,
    /// A formula that is below 0 where that of the surface is not defined, if there are such places in the box.
    domain: Option<Field>,
    /// Whether the scene's formula divides by what may be 0 or less in the box.
    is_negated: bool,
    corners: [DVec3; 2],
    /// Found when it is first asked for, as that may take tenths of a second.
    why_not_closed: OnceLock<Option<&'static str>>,
}

impl Surface {
    fn find_why_not_closed(&self) -> Option<&'static str> {
        if self.domain.is_some() {
            Some("its formula is not defined everywhere in its box")
        } else if self.is_negated {
            Some("its formula divides by what may be 0 or less in its box")
        } else if !field::is_outside(&self.formula, self.corners) {
            Some("its box may cut its surface")
        } else if !field::is_regular(&self.formula, self.corners) {
            Some("its formula may jump where it would have to be 0")
        } else {
            None
        }
    }
}

impl Implicit for Surface {
    const IS_IN_WIDE_BOX: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.formula.at(at)
    }

    fn is_cut(&self) -> bool {
        self.domain.is_some()
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.domain.as_ref().map_or(N::constant(1.0), |domain| domain.at(at))
    }

    fn field(&self) -> Option<&Field> {
        Some(&self.formula)
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        *self.why_not_closed.get_or_init(|| self.find_why_not_closed())
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.corners
    }
}
