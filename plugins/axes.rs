//! Axes of coordinates: rods with arrowheads and ticks.

use std::sync::Arc;
use tabray::prelude::*;

static CENTER: Pparm<DVec3> = Pparm::or("center", "the point where the axes meet", DVec3::ZERO)
    .alias(&["centre"])
    .unit("world coordinates");
static TO: Pparm<DVec3> =
    Pparm::required("to", "how far the axes reach from `center` to the tips of their arrowheads")
        .unit("world units")
        .must("above 0 along each axis", |to: &DVec3| to.min_element() > 0.0);
static FROM: Pparm<DVec3> = Pparm::or("from", "how far they reach to the other side", DVec3::ZERO)
    .unit("world units")
    .must("0 or less along each axis", |from: &DVec3| from.max_element() <= 0.0);
static TICKS: Pparm<f64> = Pparm::or("ticks", "the distance between ticks; 0 for none", 1.0)
    .unit("world units")
    .must("0 or more", |ticks| *ticks >= 0.0);
static RADIUS: Pparm<f64> =
    Pparm::or("radius", "the radius of the rods", 0.02).unit("world units").positive();

macro_rules! colour {
    ($name:literal, $alias:literal, $axis:literal, $colour:expr) => {
        Pparm::or($name, concat!("the factors of the ambient and diffuse colours along ", $axis), $colour)
            .alias(&[$alias])
            .each(COLOUR)
    };
}
static X_COLOUR: Pparm<Rgb> = colour!("xcolour", "xcolor", "x", Rgb::new(0.9, 0.1, 0.1));
static Y_COLOUR: Pparm<Rgb> = colour!("ycolour", "ycolor", "y", Rgb::new(0.1, 0.6, 0.1));
static Z_COLOUR: Pparm<Rgb> = colour!("zcolour", "zcolor", "z", Rgb::new(0.15, 0.25, 0.9));

const TABLE: Table = &[&CENTER, &TO, &FROM, &TICKS, &RADIUS, &X_COLOUR, &Y_COLOUR, &Z_COLOUR];

/// The most ticks of an axis.
const MAX_TICKS: f64 = 100.0;

/// The radius and the length of an arrowhead, and the radius and half the thickness of a tick, in radii of the rods.
const HEAD: [f64; 2] = [3.0, 9.0];
const TICK: [f64; 2] = [2.2, 0.35];

inventory::submit! {
    Entity::shape("axes", "axes of coordinates, with arrowheads and ticks", &[TABLE], |args| {
        let (to, from, ticks, radius) = (args.get(&TO), args.get(&FROM), args.get(&TICKS), args.get(&RADIUS));
        let refusal = |attribute, message: String, help| Refusal { attribute: Some(attribute), message, help };
        if to.min_element() <= HEAD[1] * radius {
            let message = format!("has arrowheads that are {} long, and an axis that is not longer", HEAD[1] * radius);
            return Err(refusal("to", message, "an arrowhead is nine times as long as the `radius` of its rod"));
        }
        if ticks > 0.0 && (to - from).max_element() / ticks > MAX_TICKS {
            let message = format!("has more than {MAX_TICKS} ticks on an axis");
            return Err(refusal("ticks", message, "set them farther apart, or leave them out: `ticks 0`"));
        }
        let material = args.material();
        let mut parts = vec![("middle".to_owned(), Body::implicit(Piece::Ball(1.5 * radius), Frame::at(args.get(&CENTER))), material.clone())];
        for (axis, colour) in [&X_COLOUR, &Y_COLOUR, &Z_COLOUR].into_iter().enumerate() {
            let name = ["x", "y", "z"][axis];
            let colour = args.get(colour);
            let (ambient, diffuse) = (material.ambient * colour, material.diffuse * colour);
            let coloured = Arc::new(Material { ambient, diffuse, ..(*material).clone() });
            let mut add = |what: String, piece: Piece, along: f64| {
                let base = args.get(&CENTER) + along * DVec3::AXES[axis];
                let frame = Frame::around(base, DVec3::AXES[axis]);
                parts.push((format!("{name} {what}"), Body::implicit(piece, frame), coloured.clone()));
            };
            let (low, neck) = (from[axis], to[axis] - HEAD[1] * radius);
            add("rod".to_owned(), Piece::Rod(radius, neck + radius - low), low);
            add("head".to_owned(), Piece::Cone(HEAD[0] * radius, HEAD[1] * radius), neck);
            for place in (1..).map(|count| f64::from(count) * ticks).take_while(|place| ticks > 0.0 && *place < neck.max(-low)) {
                for place in [place, -place].into_iter().filter(|place| *place < neck && *place >= low) {
                    let half = TICK[1] * radius;
                    add(format!("tick {place}"), Piece::Rod(TICK[0] * radius, 2.0 * half), place - half);
                }
            }
        }
        Body::union(parts)
    })
}

/// A closed piece of an axis, from the origin along y, given by its radius and its length.
enum Piece {
    Ball(f64),
    Rod(f64, f64),
    Cone(f64, f64),
}

impl Implicit for Piece {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        let n = N::constant;
        let off = x.powi(2) + z.powi(2);
        let ends = |height: f64| y * (y - n(height));
        match *self {
            Self::Ball(radius) => off + y.powi(2) - n(radius).powi(2),
            Self::Rod(radius, height) => (off - n(radius).powi(2)).max(ends(height)),
            Self::Cone(radius, height) => {
                let wall = off - (n(radius) * (n(1.0) - y / n(height))).powi(2);
                wall.max(ends(height))
            }
        }
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        None
    }

    fn bounds(&self) -> [DVec3; 2] {
        // The box must not touch the surface, or it would be in doubt on which side of it a hit is.
        let (out, low, high) = match *self {
            Self::Ball(radius) => (radius, -radius, radius),
            Self::Rod(radius, height) | Self::Cone(radius, height) => (radius, 0.0, height),
        };
        let up = 0.125 * (high - low);
        [DVec3::new(-1.125 * out, low - up, -1.125 * out), DVec3::new(1.125 * out, high + up, 1.125 * out)]
    }
}
