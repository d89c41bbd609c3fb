//! A surface by its formula: the points where it is 0.

use std::sync::OnceLock;
use tabray::prelude::*;
use tabray::shapes::Clip;
use tabray::shapes::field::{self, Reduced, Regularity};

static FORMULA: Pparm<Field> = Pparm::required(
    "formula",
    "the formula, which is 0 on the surface, below 0 inside of it and above 0 outside",
)
.known_as(&["equation", "expression", "f", "function"]);
static WHERE: Pparm<Option<Field>> = Pparm::or(
    "where",
    "a formula that cuts off the surface where it is below 0; where it is 0, the surface ends",
    None,
);
static CENTER: Pparm<DVec3> = Pparm::or("center", "the origin of the formula's coordinates", DVec3::ZERO)
    .alias(&["centre"])
    .unit("world coordinates");
static BOX: Pparm<Option<[f64; 6]>> = Pparm::or(
    "box",
    "the box that clips the surface, as its low and its high corner relative to `center`; where it clips, the \
     surface is open and shows its inside",
    None,
)
.known_as(&["bounding_box", "bounds", "contained_by", "extent", "range"])
.each(&["low x", "low y", "low z", "high x", "high y", "high z"])
.unit("world units")
.must("a low corner and a high corner above it", |corners| {
    corners.is_none_or(|[a, b, c, x, y, z]| a < x && b < y && c < z)
});
static CLIP: Pparm<Option<NamedBody>> = Pparm::or(
    "clip",
    "a closed object, defined earlier in the scene, that clips the surface in place of a `box`; it is not seen itself",
    None,
);
static CAPPED: Pparm<bool> = Pparm::or(
    "capped",
    "whether the faces of `clip` close what they cut: they are seen, with their own material, where the formula is below 0",
    false,
);

static EXTENT: OneOf = OneOf { meaning: "what clips the surface", names: &["box", "clip"] };

const TABLE: Table = &[&FORMULA, &WHERE, &CENTER, &BOX, &CLIP, &EXTENT, &CAPPED];

inventory::submit! {
    Entity::shape("implicit", "a surface by its formula", &[TABLE], |args| {
        let (clip, is_capped) = (args.get(&CLIP).map(|object| Clip::of(&object)).transpose()?, args.get(&CAPPED));
        let corners = match &clip {
            Some(clip) => clip.corners(args.get(&CENTER)),
            None => corners(args.get(&BOX).unwrap_or_default()),
        };
        let (mut field, mut given) = (args.get(&FORMULA), Vec::new());
        while let Some([rest, condition]) = field.conditional() {
            given.push(("formula", condition));
            field = rest;
        }
        given.extend(args.get(&WHERE).map(|condition| ("where", condition)));
        let Reduced { formula, denominator, warnings } = field::reduced(field);
        let ends = corners.map(|corner| corner.to_array());
        let (formula, domain) = (formula.clone().within(ends), formula.domain(ends));
        let is_clipped = clip.is_some();
        let extent = if is_clipped { "the box around its `clip`" } else { "its box" };
        let refusal = |what: &str, help| Refusal {
            attribute: Some("formula"),
            message: format!("has a formula that is {what} in {extent}"),
            help,
        };
        if domain.as_ref().is_some_and(|domain| field::bounds(domain, corners).high < 0.0) {
            return Err(refusal(
                "nowhere defined",
                "a square root, a logarithm and a power with a fraction are defined from 0 upward: change the formula, or \
                 the box",
            ));
        }
        if field::overflows(&formula, corners) {
            return Err(refusal(
                "nowhere a finite number",
                "its values are greater than 1.8e308: make its coefficients smaller",
            ));
        }
        if field::is_nowhere(&formula, corners) {
            return Err(refusal(
                "nowhere 0",
                if is_clipped {
                    "no object is in view, as the surface is where the formula is 0: change the formula, or what clips it"
                } else {
                    "the surface is where the formula is 0: change the formula, or the box"
                },
            ));
        }
        let mut condition = Vec::new();
        for (attribute, given) in given {
            for given in [given.domain(ends), Some(given)].into_iter().flatten() {
                if field::bounds(&given, corners).high < 0.0 {
                    return Err(Refusal {
                        attribute: Some(attribute),
                        message: format!("has a condition that is nowhere 0 or more in {extent}"),
                        help: "the surface is where this formula is not below 0: change it, or its sign",
                    });
                }
                condition.push(given);
            }
        }
        let is_negated = denominator.is_some_and(|denominator| field::bounds(&denominator, corners).low <= 0.0);
        let surface = Surface { formula, domain, condition, is_negated, corners, is_clipped, why_not_closed: OnceLock::new() };
        let body = Body { warnings, ..Body::implicit(surface, Frame::at(args.get(&CENTER))) };
        match clip {
            Some(clip) => clip.cut(args, body, is_capped),
            None if is_capped => Err(Refusal {
                attribute: Some("capped"),
                message: "is capped, but has no `clip`".to_owned(),
                help: "caps are faces of the object that clips it: give it a `clip` in place of its `box`",
            }),
            None => Ok(body),
        }
    })
    .known_as(&["isosurface", "sdf"])
}

fn corners([x, y, z, x2, y2, z2]: [f64; 6]) -> [DVec3; 2] {
    [DVec3::new(x, y, z), DVec3::new(x2, y2, z2)]
}

/// The surface where a scene's formula is 0.
struct Surface {
    formula: Field,
    /// A formula that is below 0 where the formula of the surface is not defined, if there are such places in the box.
    domain: Option<Field>,
    /// Formulas that are below 0 where the scene cuts the surface off.
    condition: Vec<Field>,
    /// Whether the scene's formula divides by a value that may be 0 or less in the box.
    is_negated: bool,
    corners: [DVec3; 2],
    /// Whether an object within the box clips the surface, so that the box does not.
    is_clipped: bool,
    /// Found when it is first asked for, as that may take tenths of a second.
    why_not_closed: OnceLock<Option<&'static str>>,
}

impl Surface {
    fn find_why_not_closed(&self) -> Option<&'static str> {
        if !self.condition.is_empty() {
            Some("its condition cuts its surface")
        } else if self.domain.is_some() {
            Some("its formula is not defined everywhere in its box")
        } else if self.is_negated {
            Some("its formula divides by what may be 0 or less in its box")
        } else if !self.is_clipped && !field::is_outside(&self.formula, self.corners) {
            Some("its box may cut its surface")
        } else {
            match field::regularity(&self.formula, self.corners) {
                Regularity::Bounded => None,
                Regularity::MayJump => Some(
                    "its formula may step from below 0 to above it, as by `floor` or `if`, which leaves a gap in its surface",
                ),
                Regularity::TooCostly => Some(
                    "its formula has too many operations to check that no step of it leaves a gap in its surface",
                ),
            }
        }
    }
}

impl Implicit for Surface {
    const IS_IN_WIDE_BOX: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.formula.at(at)
    }

    fn is_cut(&self) -> bool {
        self.domain.is_some() || !self.condition.is_empty()
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.condition
            .iter()
            .chain(&self.domain)
            .map(|one| one.at(at))
            .reduce(N::min)
            .unwrap_or(N::constant(1.0))
    }

    fn condition<N: Scalar>(&self, at: [N; 3]) -> N {
        self.condition.iter().map(|one| one.at(at)).reduce(N::min).unwrap_or(N::constant(1.0))
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

    fn is_box_exact(&self) -> bool {
        true
    }
}
