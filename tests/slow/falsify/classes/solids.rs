//! Solids: several shapes combined.

use super::barely;
use crate::falsify::random::{Point, Random, moved, turned};
use crate::falsify::scenes::{Aim, Question, numbers};
use std::fmt::Write;

/// Returns a multiple of 1/64 near a number.
pub fn even(number: f64) -> f64 {
    (64.0 * number).round() / 64.0
}

/// Returns the type and the attributes of a closed shape around a point, about as large as `size`.
pub fn shape(random: &mut Random, at: Point, size: f64) -> String {
    let radius = size * random.between(0.4, 1.0);
    match random.below(7) {
        0 | 1 => format!("sphere center {} radius {radius:?}", numbers(at)),
        2 => {
            let scale = [0; 3].map(|_| random.between(0.5, 1.5));
            format!("ellipsoid center {} radius {radius:?} scale {}", numbers(at), numbers(scale))
        }
        3 => {
            let sides = [0; 3].map(|_| even(size * random.between(0.6, 1.8)).max(1.0 / 64.0));
            format!("box center {} size {}", numbers(at.map(even)), numbers(sides))
        }
        4 => {
            let (axis, height) = (random.axis(), size * random.between(0.5, 2.5));
            let base = moved(at, -0.5 * height, crate::falsify::random::unit(axis));
            let sizes = format!("height {height:?} radius {:?}", 0.6 * radius);
            format!("cylinder base {} direction {} {sizes}", numbers(base), numbers(axis))
        }
        5 => {
            let (axis, height) = (random.axis(), size * random.between(0.3, 1.5));
            let base = moved(at, -0.5 * height, crate::falsify::random::unit(axis));
            let sizes = format!("height {height:?} radius {:?}", 0.5 * radius);
            format!("capsule base {} direction {} {sizes}", numbers(base), numbers(axis))
        }
        _ => {
            let tube = 0.3 * radius;
            let axis = numbers(random.axis());
            format!("torus center {} direction {axis} radius {radius:?} tube {tube:?}", numbers(at))
        }
    }
}

/// The entities to which others refer, as text.
struct Patterns {
    text: String,
    count: usize,
}

impl Patterns {
    fn new() -> Self {
        Self { text: "material plain { ambient 1 1 1 }\n".to_owned(), count: 0 }
    }

    /// Adds an entity and returns its name.
    fn add(&mut self, of: &str) -> String {
        let (kind, rest) = of.split_once(' ').expect("a type and attributes");
        self.count += 1;
        let material = if ["union", "intersection", "difference", "place"].contains(&kind) {
            ""
        } else {
            "material plain "
        };
        writeln!(self.text, "{kind} p{} {{ {material}{rest} }}", self.count).expect("room");
        format!("p{}", self.count)
    }
}

pub const OPERATIONS: [&str; 3] = ["union", "intersection", "difference"];

/// Returns a random solid around a point.
fn solid(random: &mut Random, patterns: &mut Patterns, at: Point, size: f64, depth: u64) -> String {
    let operation = OPERATIONS[random.below(3) as usize];
    let count = 2 + random.below(3);
    let mut text = format!("{operation} objects");
    for _ in 0..count {
        let at = moved(at, 0.5 * size * random.between(0.0, 1.0), random.direction());
        let of = if depth > 0 && random.once_in(4) {
            solid(random, patterns, at, size, depth - 1)
        } else if random.once_in(5) {
            let name = {
                let of = shape(random, [0.0; 3], size);
                patterns.add(&of)
            };
            let rotation = [0; 3].map(|_| (8.0 * random.between(-20.0, 20.0)).round() / 8.0);
            let scale = [0; 3].map(|_| even(random.between(0.5, 1.5)));
            let place = format!("rotation {} scale {}", numbers(rotation), numbers(scale));
            format!("place object {name} translation {} {place}", numbers(at))
        } else {
            shape(random, at, size)
        };
        let name = patterns.add(&of);
        text += &format!(" {name}");
    }
    text
}

fn aim(random: &mut Random) -> Aim {
    if random.once_in(3) { Aim::new(random, 3.0) } else { Aim::plain(random, 3.0) }
}

fn asked(random: &mut Random, aim: &Aim, object: String, patterns: &Patterns) -> Question {
    let question = if random.once_in(8) { aim.picture(&[object]) } else { aim.many(random, &[object]) };
    question.with_patterns(&patterns.text)
}

/// Returns a scene of a solid; sometimes the viewer is inside of some of its shapes.
pub fn solids(random: &mut Random) -> Question {
    let (aim, mut patterns) = (aim(random), Patterns::new());
    let at = if random.once_in(6) {
        aim.eye
    } else {
        moved(aim.target, random.between(0.0, 1.0), random.direction())
    };
    let object = solid(random, &mut patterns, at, 2.0, 2);
    asked(random, &aim, object, &patterns)
}

/// Returns a scene of a solid around the viewer.
pub fn inside(random: &mut Random) -> Question {
    let (aim, mut patterns) = (aim(random), Patterns::new());
    let walls = format!("box center {} size 12 12 12", numbers(aim.eye.map(even)));
    let mut object = format!("difference objects {}", patterns.add(&walls));
    for _ in 0..2 + random.below(4) {
        let of = {
            let at = moved(aim.eye, random.between(1.0, 6.0), random.direction());
            shape(random, at, 2.0)
        };
        object += &format!(" {}", patterns.add(&of));
    }
    asked(random, &aim, object, &patterns)
}

/// Returns a scene of cylinders on one axis, and of boxes, that end in the same planes: turned, and as copies.
pub fn ends(random: &mut Random) -> Question {
    let (aim, mut patterns) = (aim(random), Patterns::new());
    let at = moved(aim.target, random.between(0.0, 1.0), random.direction());
    let is_copied = random.once_in(2);
    let base = if is_copied { [0.0; 3] } else { at };
    let axis = numbers(random.axis());
    let mut object = format!("{} objects", OPERATIONS[random.below(3) as usize]);
    for _ in 0..2 + random.below(3) {
        let (radius, half) = (random.between(0.3, 1.5), [0; 3].map(|_| 0.5 * random.whole(1, 3)));
        let of = if is_copied && random.once_in(2) {
            // Its lower side is that of an upright cylinder, if it is not moved.
            let center = [0.5 * random.whole(-1, 1), half[1], 0.5 * random.whole(-1, 1)];
            format!("box center {} size {}", numbers(center), numbers(half.map(|half| 2.0 * half)))
        } else {
            let direction = if is_copied { "0 1 0" } else { &axis };
            let sizes = format!("height {:?} radius {radius:?}", 2.0 * half[0]);
            format!("cylinder base {} direction {direction} {sizes}", numbers(base))
        };
        object += &format!(" {}", patterns.add(&of));
    }
    if is_copied {
        let rotation = [0; 3].map(|_| 15.0 * random.whole(-12, 12));
        let name = patterns.add(&object);
        object = format!("place object {name} translation {} rotation {}", numbers(at), numbers(rotation));
    }
    asked(random, &aim, object, &patterns)
}

/// Returns a scene of a solid, moved by bisection until a ray barely hits or barely misses it: the rays pass its
/// silhouette, which may be an edge where two shapes meet.
pub fn silhouettes(random: &mut Random) -> Question {
    let aim = aim(random);
    let side = turned(aim.u, aim.angle(random));
    let seed = random.below(1 << 32);
    let within = moved(aim.target, random.between(0.0, 0.5), random.direction());
    let question = |by: f64| {
        let (mut random, mut patterns) = (Random::new("a solid", seed), Patterns::new());
        let object = solid(&mut random, &mut patterns, moved(within, by, side), 2.0, 1);
        aim.question(&[object]).with_patterns(&patterns.text)
    };
    barely(random, question, 6.0, 52)
}

/// Returns a scene of boxes whose sides lie in the same planes, and of round shapes that touch them, with sides that
/// coincide: an opening flush with a side, a cylinder that stands on one.
pub fn flush(random: &mut Random) -> Question {
    let (aim, mut patterns) = (aim(random), Patterns::new());
    let at = aim.target.map(|number| number.round());
    let mut object = format!("{} objects", OPERATIONS[random.below(3) as usize]);
    for _ in 0..2 + random.below(3) {
        let mut step = |most: i64| 0.5 * random.whole(0, most);
        let (offset, half) = ([step(4), step(4), step(4)], [0.5 + step(2), 0.5 + step(2), 0.5 + step(2)]);
        let center = [0, 1, 2].map(|axis| at[axis] + offset[axis] - 1.0);
        let of = match random.below(6) {
            0 => format!("sphere center {} radius {:?}", numbers(center), half[0]),
            1 => {
                let base = [center[0], center[1] - half[1], center[2]];
                format!("cylinder base {} height {:?} radius {:?}", numbers(base), 2.0 * half[1], half[0])
            }
            _ => format!("box center {} size {}", numbers(center), numbers(half.map(|half| 2.0 * half))),
        };
        object += &format!(" {}", patterns.add(&of));
    }
    asked(random, &aim, object, &patterns)
}
