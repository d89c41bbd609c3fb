//! Axes of coordinates: rods with arrowheads and ticks, and numbers that face the camera.

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
static NUMBERS: Pparm<f64> = Pparm::or(
    "numbers",
    "the height of the coordinates at the ticks and of the names at the tips, which face the scene's camera; 0 for none",
    0.0,
)
.unit("world units")
.must("0 or more", |numbers| *numbers >= 0.0);

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

const TABLE: Table = &[&CENTER, &TO, &FROM, &TICKS, &RADIUS, &NUMBERS, &X_COLOUR, &Y_COLOUR, &Z_COLOUR];

/// The most ticks of an axis.
const MAX_TICKS: f64 = 100.0;

/// The radius and the length of an arrowhead, and the radius and half the thickness of a tick, in radii of the rods.
const HEAD: [f64; 2] = [3.0, 9.0];
const TICK: [f64; 2] = [2.2, 0.35];

/// The most parts of axes, which their numbers count most of.
const MAX_PARTS: usize = 1024;

/// Half of the width of strokes, and the distance of numbers from ticks, where a number is 6 high.
const INK: f64 = 0.42;
const GAP: f64 = 2.0;

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
        let (unit, view, mut labels) = (args.get(&NUMBERS) / 6.0, View::of(args), Vec::new());
        for (axis, colour) in [&X_COLOUR, &Y_COLOUR, &Z_COLOUR].into_iter().enumerate() {
            let (name, along) = (["x", "y", "z"][axis], DVec3::AXES[axis]);
            let colour = args.get(colour);
            let (ambient, diffuse) = (material.ambient * colour, material.diffuse * colour);
            let coloured = Arc::new(Material { ambient, diffuse, ..(*material).clone() });
            let mut add = |what: String, piece: Piece, base: DVec3, toward: DVec3| {
                let frame = Frame::around(args.get(&CENTER) + base, toward);
                parts.push((format!("{name} {what}"), Body::implicit(piece, frame), coloured.clone()));
            };
            let (low, neck) = (from[axis], to[axis] - HEAD[1] * radius);
            add("rod".to_owned(), Piece::Rod(radius, neck + radius - low), low * along, along);
            add("head".to_owned(), Piece::Cone(HEAD[0] * radius, HEAD[1] * radius), neck * along, along);
            let mut texts = vec![(name.to_owned(), to[axis] * along, view.ahead(along))];
            // Seen from its end, an axis would have all its numbers at one place.
            let image = |at: DVec3| args.setting.camera.project(args.get(&CENTER) + at);
            let digit = view.vector(6.0 * unit * DVec2::Y);
            let is_point = match [low * along, neck * along, neck * along + digit].map(image) {
                [Projected::At(one), Projected::At(other), Projected::At(up)] => one.distance(other) < up.distance(other),
                _ => false,
            };
            for place in (1..).map(|count| f64::from(count) * ticks).take_while(|place| ticks > 0.0 && *place < neck.max(-low)) {
                for place in [place, -place].into_iter().filter(|place| *place < neck && *place >= low) {
                    let half = TICK[1] * radius;
                    add(format!("tick {place}"), Piece::Rod(TICK[0] * radius, 2.0 * half), (place - half) * along, along);
                    if !is_point {
                        texts.push((number(args.get(&CENTER)[axis] + place, ticks), place * along, view.beside(along, 0.5 * (to + from))));
                    }
                }
            }
            for (text, at, to) in texts.into_iter().filter(|_| unit > 0.0) {
                let (strokes, size) = written(&text);
                let off = TICK[0] * radius + unit * (GAP + 0.5 * to.abs().dot(size));
                let middle = at + view.vector(off * to);
                let place = |at: DVec2| middle + view.vector(unit * (at - 0.5 * size));
                labels.push(Label { at: args.get(&CENTER) + middle, up: view.vector(6.0 * unit * DVec2::Y), text: text.clone() });
                for [from, to] in strokes.into_iter().filter(|_| args.is_pattern || !args.setting.labels_apart) {
                    let toward = if from == to { DVec2::Y } else { to - from };
                    let piece = Piece::Stroke(INK * unit, unit * (to - from).length());
                    add(text.clone(), piece, place(from), view.vector(toward));
                }
            }
        }
        if parts.len() > MAX_PARTS {
            let message = format!("has numbers of more than {MAX_PARTS} strokes");
            return Err(refusal("numbers", message, "set the `ticks` farther apart, or leave out the numbers"));
        }
        Ok(Body { labels, ..Body::union(parts)? })
    })
}

/// The directions of the image in space, in which numbers are written.
struct View {
    right: DVec3,
    up: DVec3,
}

impl View {
    fn of(args: &Args) -> Self {
        let camera = &args.setting.camera;
        let [x, y] = camera.pixels.map(|side| 0.5 * side as f64);
        let at = |x: f64, y: f64| {
            let ray = camera.ray(x, y);
            ray.origin + ray.dir
        };
        let right = (at(x + 1.0, y) - at(x, y)).try_normalize().unwrap_or(DVec3::X);
        let up = (at(x, y + 1.0) - at(x, y)).reject_from_normalized(right);
        Self { right, up: up.try_normalize().unwrap_or(DVec3::Y) }
    }

    fn vector(&self, at: DVec2) -> DVec3 {
        at.x * self.right + at.y * self.up
    }

    fn seen(&self, vector: DVec3) -> DVec2 {
        DVec2::new(vector.dot(self.right), vector.dot(self.up))
    }

    /// Returns the direction in which an axis is seen; down where it is seen from its end.
    fn ahead(&self, along: DVec3) -> DVec2 {
        let seen = self.seen(along);
        if seen.length() > 0.1 { seen.normalize() } else { DVec2::NEG_Y }
    }

    /// Returns the direction from an axis to its numbers: away from the middle of all axes; below or left of an axis
    /// through the middle.
    fn beside(&self, along: DVec3, middle: DVec3) -> DVec2 {
        let (side, away) = (self.ahead(along).perp(), self.seen(along * along.dot(middle) - middle));
        let inward = if away.dot(side).abs() > 1e-9 { -away.dot(side) } else { side.y + 1e-9 * side.x };
        if inward > 0.0 { -side } else { side }
    }
}

/// Writes a coordinate without the rounding of a multiple of the distance between ticks.
fn number(place: f64, ticks: f64) -> String {
    let place = if place.abs() < 1e-9 * ticks { 0.0 } else { place };
    format!("{place:.11e}").parse::<f64>().unwrap_or(place).to_string()
}

/// Returns the strokes of a text, each from a point to another, and the text's width and height. A digit is 4 wide and 6
/// high.
fn written(text: &str) -> (Vec<[DVec2; 2]>, DVec2) {
    let (mut strokes, mut left) = (Vec::new(), 0.0);
    for letter in text.chars() {
        let mut width = 0.0_f64;
        for line in glyph(letter).split(',') {
            let point = |code: &[u8]| DVec2::from([0, 1].map(|side| f64::from(code[side]) - f64::from(b'0')));
            let points: Vec<_> = line.split_whitespace().map(|code| point(code.as_bytes())).collect();
            width = points.iter().fold(width, |width, point| width.max(point.x));
            strokes.extend(points.windows(2).map(|pair| [pair[0], pair[1]].map(|at| at + left * DVec2::X)));
        }
        left += width + 2.0;
    }
    (strokes, DVec2::new(left - 2.0, 6.0))
}

/// Returns the lines of a letter through points, each given by its x and its y; `.` is below 0 by 2.
fn glyph(letter: char) -> &'static str {
    match letter {
        '0' => "10 30 41 45 36 16 05 01 10",
        '1' => "04 26 20",
        '2' => "05 16 36 45 44 00 40",
        '3' => "05 16 36 45 44 33 42 41 30 10 01,13 33",
        '4' => "30 36 02 42",
        '5' => "46 06 03 33 42 41 30 10 01",
        '6' => "45 36 16 05 01 10 30 41 42 33 13 02",
        '7' => "06 46 10",
        '8' => "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33",
        '9' => "01 10 30 41 45 36 16 05 04 13 33 44",
        '-' => "03 33",
        '.' => "00 00",
        'x' => "00 44,04 40",
        'y' => "04 21,44 0.",
        'z' => "04 44 00 40",
        _ => "",
    }
}

/// A closed piece of an axis, from the origin along y, given by its radius and its length.
enum Piece {
    Ball(f64),
    Rod(f64, f64),
    Cone(f64, f64),
    /// With round ends around both points.
    Stroke(f64, f64),
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
            Self::Stroke(radius, height) => off + (-y).ramp(2) + (y - n(height)).ramp(2) - n(radius).powi(2),
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
            Self::Stroke(radius, height) => (radius, -radius, height + radius),
        };
        let up = 0.125 * (high - low);
        [DVec3::new(-1.125 * out, low - up, -1.125 * out), DVec3::new(1.125 * out, high + up, 1.125 * out)]
    }
}
