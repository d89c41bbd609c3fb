//! Shapes far from the world's origin: what is computed from their coordinates has few digits left.

use super::solids::{OPERATIONS, even, shape};
use crate::falsify::random::{Point, Random, moved, unit};
use crate::falsify::scenes::{Question, numbers};
use crate::oracle::first::{self as oracle, Truth};
use crate::oracle::ray::Ray;
use crate::oracle::solid;
use crate::oracle::text::{Scene, Shape};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::ptr;

/// The size of the images in pixels: odd, so that the middle of one is the middle of a pixel.
const SIZE: [usize; 2] = [13, 9];

/// The number of bisections that find an edge to the last digit.
const STEPS: u64 = 52;

/// The number of directions among which two are searched that see different surfaces.
const TRIES: usize = 12;

/// Returns a coordinate up to about 2.7e11 from 0, which is 10^12 times the size of the smallest shapes.
fn coordinate(random: &mut Random) -> f64 {
    match random.below(4) {
        0 => 0.0,
        1 => random.sign() * 2_f64.powf(random.whole(20, 38)),
        _ => (random.sign() * random.power(6.0, 11.4)).round(),
    }
}

/// Returns the type and the attributes of a convex prism, whose corners have few digits: they are rounded in the world.
fn prism(random: &mut Random, at: Point) -> String {
    let (count, out) = (3 + random.below(4), random.between(0.6, 1.4));
    let mut points = String::new();
    for corner in 0..count {
        let angle = (corner as f64 + random.between(0.0, 0.5)) / count as f64 * TAU;
        write!(points, " {:?} {:?}", even(out * angle.cos()), even(out * angle.sin())).expect("room");
    }
    let height = even(random.between(0.3, 2.0));
    format!("prism points{points} base {} height {height:?}", numbers(at.map(even)))
}

/// Returns the type and the attributes of a closed shape whose sides are where those of others are.
fn flush(random: &mut Random, around: Point) -> String {
    let at = around.map(|place| place + 0.5 * random.whole(-2, 2));
    let half = [0; 3].map(|_| 0.25 * random.whole(1, 5));
    let (base, height) = (moved(at, -half[1], [0.0, 1.0, 0.0]), 2.0 * half[1]);
    match random.below(4) {
        0 => format!("sphere center {} radius {:?}", numbers(at), half[0]),
        1 => format!("cylinder base {} height {height:?} radius {:?}", numbers(base), half[0]),
        _ => format!("box center {} size {}", numbers(at), numbers(half.map(|half| 2.0 * half))),
    }
}

/// Returns the objects of a scene, as text: two or three shapes that cross each other, mostly combined.
fn objects(random: &mut Random, around: Point) -> String {
    let mut text = String::new();
    let (is_flush, is_solid) = (random.once_in(3), !random.once_in(5));
    let count = if is_solid { 2 + random.below(2) as usize } else { 2 };
    for index in 0..count {
        let at = moved(around, random.between(0.0, 0.6), random.direction());
        let of = match random.below(4) {
            _ if is_flush => flush(random, around),
            0 => prism(random, at),
            _ => shape(random, at, 1.2),
        };
        let (kind, rest) = of.split_once(' ').expect("a type and attributes");
        let colour = ["1e300 0 0", "0 1e300 0", "0 0 1e300"][index];
        writeln!(text, "material m{index} {{ ambient {colour} }}").expect("room");
        writeln!(text, "{kind} o{index} {{ material m{index} {rest} }}").expect("room");
    }
    if is_solid {
        let names: String = (0..count).map(|index| format!(" o{index}")).collect();
        let operation = OPERATIONS[random.below(3) as usize];
        writeln!(text, "{operation} all {{ objects{names} }}").expect("room");
    }
    text
}

/// Returns the shape whose surface a ray meets first, which may be a part of a solid; null for a miss.
fn seen(scene: &Scene, ray: &Ray) -> *const Shape {
    let Truth { first: Some(first), place: Some(place), .. } = oracle::first(scene, ray) else {
        return ptr::null();
    };
    solid::crossed(&scene.objects[first], ray, &place).map_or(ptr::null(), |(shape, ..)| ptr::from_ref(shape))
}

/// Returns a scene of shapes far away from the world's origin, seen from nearby. The middle of the image is moved by
/// bisection to where two of the surfaces meet, or to a silhouette.
pub fn edges(random: &mut Random) -> Question {
    let around = loop {
        let around = [0; 3].map(|_| coordinate(random));
        if around != [0.0; 3] {
            break around;
        }
    };
    let out = 0.5 * random.whole(6, 20);
    let eye = if random.once_in(2) {
        moved(around, out, random.direction())
    } else {
        let steps = [0; 3].map(|_| 0.5 * random.whole(-12, 12));
        [0, 1, 2].map(|axis| around[axis] + if axis == 2 { out } else { steps[axis] })
    };
    let text = objects(random, around);
    let toward = |random: &mut Random| {
        let at = moved(around, random.between(0.0, 1.5), random.direction());
        unit([0, 1, 2].map(|axis| at[axis] - eye[axis]))
    };
    let scene = Scene::read(&text, "");
    // So far away that the rounding of the target does not matter.
    let far = around.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
    let target = |dir: Point| moved(eye, far, dir);
    let view = |dir: Point| {
        let at = target(dir);
        seen(&scene, &Ray::as_is(&scene, eye, [0, 1, 2].map(|axis| at[axis] - eye[axis])))
    };
    let mut near = toward(random);
    let of_near = view(near);
    let other = (0..TRIES).map(|_| toward(random)).find(|dir| view(*dir) != of_near);
    if let Some(mut other) = other {
        let steps = if random.once_in(3) { random.below(STEPS) } else { STEPS };
        for _ in 0..steps {
            let middle = unit([0, 1, 2].map(|axis| near[axis] + other[axis]));
            if view(middle) == of_near { near = middle } else { other = middle }
        }
    }
    let [width, height] = SIZE;
    let (angle, up) = (random.power(-3.0, 0.5), random.direction());
    let camera = format!(
        "look_at eye {{ pixeldim {width} {height} position {} target {} angle {angle:?} up {} }}\n",
        numbers(eye),
        numbers(target(near)),
        numbers(up)
    );
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
    Question { text: camera + &text, mesh: String::new(), pixels, is_picture: true }
}
