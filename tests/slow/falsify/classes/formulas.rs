//! Surfaces by formulas of scenes, and the simple shapes.

use super::barely;
use crate::falsify::random::{Point, Random, cross, dot, moved, turned, unit};
use crate::falsify::scenes::{Aim, Question, numbers};

/// Returns a number with two decimals.
fn short(random: &mut Random, low: f64, high: f64) -> f64 {
    (100.0 * random.between(low, high)).round() / 100.0
}

/// Returns a formula, half the side of its box, and whether its origin is inside of a closed surface.
fn formula(random: &mut Random) -> (String, f64, bool) {
    let k = short(random, 0.5, 2.0);
    match random.below(11) {
        0 => ("x^2 + y^2/2 + z^2 - 1".to_owned(), 2.0, true),
        1 => (format!("(x^2 + z^2)*(1 + y/4) + y^2/2 - {k:?}"), 2.5, false),
        2 => {
            let (to, from) = (short(random, 0.3, 0.9), short(random, 0.1, 0.6));
            let one = format!("0.5/((x - {to:?})^2 + y^2 + z^2)");
            (format!("1 - {one} - {from:?}/((x + 0.6)^2 + y^2 + z^2)"), 3.0, false)
        }
        3 => {
            let text = "sin(W*x)*cos(W*y) + sin(W*y)*cos(W*z) + sin(W*z)*cos(W*x)";
            (text.replace('W', &random.whole(1, 4).to_string()), 2.0, false)
        }
        4 => (format!("(x^2 + y^2 + z^2 + {k:?})^2 - 4*{k:?}*(x^2 + z^2) - 0.1"), 3.0, false),
        5 => ("x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8".to_owned(), 3.0, false),
        6 => (format!("max(abs(x), max(abs(y), abs(z)/{k:?})) - 1"), 2.5, true),
        7 => ("x^2 + z^2 - y^2/4".to_owned(), 2.0, false),
        8 => (format!("(x^2 + 2.25*z^2 + y^2 - 1)^3 - (x^2 + 0.1125*z^2)*y^3 - {k:?}/100"), 2.0, true),
        9 => (format!("y - exp(-{k:?}*(x^2 + z^2))*cos(3*x)"), 2.0, false),
        _ => (format!("min(x^2 + y^2 + z^2 - 1, abs(y - {k:?}) + x^2 - 0.04)"), 2.5, true),
    }
}

fn implicit(text: &str, center: Point, half: [f64; 6]) -> String {
    format!("implicit formula \"{text}\" center {} box {}", numbers(center), numbers(half))
}

fn ends(random: &mut Random, half: f64) -> [f64; 6] {
    if random.once_in(3) {
        let mut cut = || short(random, 0.3, 1.0) * half;
        return [-cut(), -cut(), -cut(), cut(), cut(), cut()];
    }
    [-half, -half, -half, half, half, half]
}

fn viewer(random: &mut Random) -> Aim {
    if random.once_in(3) { Aim::new(random, 6.0) } else { Aim::plain(random, 6.0) }
}

fn asked(random: &mut Random, aim: &Aim, object: String) -> Question {
    if random.once_in(16) { aim.picture(&[object]) } else { aim.many(random, &[object]) }
}

/// Returns a scene of a surface by its formula.
pub fn implicits(random: &mut Random) -> Question {
    let aim = viewer(random);
    let (text, half, _) = formula(random);
    let center = moved(aim.target, half * random.between(0.0, 0.7), random.direction());
    let object = implicit(&text, center, ends(random, half));
    asked(random, &aim, object)
}

/// Returns a scene of a closed surface around the viewer.
pub fn inside(random: &mut Random) -> Question {
    let aim = Aim::new(random, 2.0);
    let (text, half) = loop {
        let (text, half, is_closed) = formula(random);
        if is_closed {
            break (text, half);
        }
    };
    let center = moved(aim.eye, random.between(0.0, 0.4), random.direction());
    aim.many(random, &[implicit(&text, center, [-half, -half, -half, half, half, half])])
}

/// Returns a scene of a surface, moved by bisection until the ray barely hits or barely misses it.
pub fn silhouettes(random: &mut Random) -> Question {
    let aim = if random.once_in(2) { Aim::new(random, 4.0) } else { Aim::plain(random, 4.0) };
    let (text, half, _) = formula(random);
    let side = turned(aim.u, aim.angle(random));
    let within = moved(aim.target, random.between(0.0, 0.5), random.direction());
    let question = |by: f64| {
        let object = implicit(&text, moved(within, by, side), [-half, -half, -half, half, half, half]);
        aim.question(&[object])
    };
    barely(random, question, 2.0 * half, 60)
}

/// Returns the name and the attributes of a round shape but its place and axis, and its height and radius.
fn round(random: &mut Random) -> (&'static str, String, f64, f64) {
    let (height, radius) = (random.power(-0.7, 0.7), random.power(-0.7, 0.5));
    let sizes = format!("height {height:?} radius {radius:?}");
    match random.below(4) {
        0 => ("cylinder", sizes, height, radius),
        1 => ("cylinder", sizes + " open yes", height, radius),
        2 => ("capsule", sizes, height, radius),
        _ => ("disc", format!("radius {radius:?}"), 0.0, radius),
    }
}

fn placed(kind: &str, sizes: &str, base: Point, axis: Point) -> String {
    let [at, along] = if kind == "disc" { ["center", "normal"] } else { ["base", "direction"] };
    format!("{kind} {at} {} {along} {} {sizes}", numbers(base), numbers(axis))
}

/// Returns a scene of a cylinder, a tube, a capsule or a disc.
pub fn rounds(random: &mut Random) -> Question {
    let aim = viewer(random);
    let (kind, sizes, height, radius) = round(random);
    let axis = random.axis();
    let base = moved(aim.target, -height * random.between(0.0, 1.0), unit(axis));
    let base = if random.once_in(8) { aim.eye } else { moved(base, 0.7 * radius, random.direction()) };
    asked(random, &aim, placed(kind, &sizes, base, axis))
}

/// Returns a scene of such a shape whose rim, or whose wall's silhouette, the ray passes up to a small offset.
pub fn rims(random: &mut Random) -> Question {
    let aim = Aim::new(random, 4.0);
    let (kind, sizes, height, radius) = round(random);
    let axis = random.axis();
    let up = unit(axis);
    let direction = if random.once_in(2) { turned(aim.u, aim.angle(random)) } else { random.direction() };
    let out = unit(moved(direction, -dot(direction, up), up));
    let by = height * if random.once_in(2) { random.below(2) as f64 } else { random.between(0.0, 1.0) };
    let base = moved(moved(aim.target, -radius * (1.0 + random.offset()), out), -by, up);
    if !dot(out, out).is_finite() {
        return rounds(random);
    }
    aim.question(&[placed(kind, &sizes, base, axis)])
}

/// Returns a scene of a turned piece.
pub fn lathes(random: &mut Random) -> Question {
    let aim = viewer(random);
    let (mut height, mut points) = (0.0, String::new());
    let count = random.whole(2, 12) as usize;
    for index in 0..count {
        height += if index == 0 { 0.0 } else { short(random, 0.1, 1.2) };
        points += &format!("{height:?} {:?} ", short(random, 0.1, 1.5));
    }
    let axis = random.axis();
    let base = moved(aim.target, -height * random.between(0.0, 1.0), unit(axis));
    let object = format!("lathe points {points} base {} direction {}", numbers(base), numbers(axis));
    asked(random, &aim, object)
}

/// Returns a multiple of 1/1024 near a number, so that sums of a few of them are exact.
fn even(number: f64) -> f64 {
    (1024.0 * number).round() / 1024.0
}

/// Returns a scene of a box.
pub fn boxes(random: &mut Random) -> Question {
    let aim = viewer(random);
    let size = [0; 3].map(|_| even(random.power(-0.7, 0.7)).max(1.0 / 512.0));
    let center = moved(aim.target, random.between(0.0, 1.0), random.direction()).map(even);
    let center = if random.once_in(8) { aim.eye.map(even) } else { center };
    asked(random, &aim, format!("box center {} size {}", numbers(center), numbers(size)))
}

/// Returns a scene of a convex polygon, whose corners lie in one plane exactly.
pub fn polygons(random: &mut Random) -> Question {
    let aim = viewer(random);
    let vector = |random: &mut Random| [0; 3].map(|_| 0.125 * random.whole(-16, 16));
    let (one, other) = loop {
        let (one, other) = (vector(random), vector(random));
        let across = cross(one, other);
        if dot(across, across) > 0.0 {
            break (one, other);
        }
    };
    let count = random.whole(3, 9) as usize;
    let (turn, middle) = (random.between(0.0, 1.0), aim.target.map(even));
    let corner = |index: usize| {
        let angle = std::f64::consts::TAU * (index as f64 + turn) / count as f64;
        numbers(moved(moved(middle, even(angle.cos()), one), even(angle.sin()), other))
    };
    let points: Vec<_> = (0..count).map(corner).collect();
    asked(random, &aim, format!("polygon points {}", points.join(" ")))
}

/// Returns a scene of a prism of a convex polygon.
pub fn prisms(random: &mut Random) -> Question {
    let aim = viewer(random);
    let count = random.whole(3, 9) as usize;
    let radius = random.between(0.3, 2.0);
    let corner = |index: usize| {
        let angle = std::f64::consts::TAU * index as f64 / count as f64;
        numbers([even(radius * angle.cos()), even(radius * angle.sin())])
    };
    let points: Vec<_> = (0..count).map(corner).collect();
    let base = moved(aim.target, random.between(0.0, 1.0), random.direction()).map(even);
    let height = even(random.power(-0.7, 0.7)).max(1.0 / 1024.0);
    let open = if random.once_in(3) { "yes" } else { "no" };
    let object =
        format!("prism points {} base {} height {height:?} open {open}", points.join(" "), numbers(base));
    asked(random, &aim, object)
}
