//! Planes, rectangles and triangles.

use super::meshes::{Copy, PATTERN};
use crate::falsify::random::{Point, Random, cross, dot, moved, turned, unit};
use crate::falsify::scenes::{Aim, Question, numbers};
use std::fmt::Write;

fn plane(normal: Point, point: Point) -> String {
    format!("plane normal {} point {}", numbers(normal), numbers(point))
}

/// Returns a random normal, which need not have unit length.
fn normal(random: &mut Random) -> Point {
    if random.once_in(4) {
        return random.axis();
    }
    let length = random.power(-3.0, 3.0);
    random.direction().map(|part| part * length)
}

/// Returns a scene of three planes seen through random pixels, or of one plane hit near z = 0.01, where planes end.
pub fn planes(random: &mut Random) -> Question {
    let mut aim = if random.once_in(3) { Aim::new(random, 9.0) } else { Aim::plain(random, 9.0) };
    if random.once_in(4) {
        // The plane is hit near z = 0.01.
        let by = (0.01 * (1.0 + random.offset()) - aim.target[2]) / aim.u[2];
        aim.target = moved(aim.target, by, aim.u);
        let object = plane(normal(random), aim.target);
        return aim.question(&[object]);
    }
    let objects: Vec<_> = (0..3)
        .map(|_| plane(normal(random), moved(aim.target, random.between(0.0, 3.0), random.direction())))
        .collect();
    if random.once_in(4) { aim.picture(&objects) } else { aim.many(random, &objects) }
}

/// Returns a scene of a plane that is parallel to the ray up to a small offset, so that it is hit near, far away or not
/// at all.
pub fn parallel(random: &mut Random) -> Question {
    let aim = Aim::new(random, 6.0);
    let side = turned(aim.u, aim.angle(random));
    let tilt = random.offset();
    let n = unit(moved(side, tilt, aim.u));
    let length = if random.once_in(2) { 1.0 } else { random.power(-2.0, 2.0) };
    let n = n.map(|part| part * length);
    let at = match random.below(3) {
        0 => aim.target,
        1 => moved(aim.eye, random.offset() * 10.0, side),
        _ => moved(aim.target, random.power(-3.0, 3.0), cross(side, aim.u)),
    };
    let mut objects = vec![plane(n, at)];
    if random.once_in(2) {
        objects.push(plane(random.direction(), moved(aim.target, random.power(-1.0, 4.0), aim.u)));
    }
    aim.question(&objects)
}

fn rectangle(n: Point, xdir: Point, corner: Point, size: [f64; 2]) -> String {
    format!(
        "fplane normal {} xdir {} dimensions {} point {}",
        numbers(n),
        numbers(xdir),
        numbers(size),
        numbers(corner)
    )
}

/// Returns a scene of a rectangle, often with an edge or a corner that the ray meets up to a small offset.
pub fn rectangles(random: &mut Random) -> Question {
    let aim = if random.once_in(2) { Aim::new(random, 9.0) } else { Aim::plain(random, 9.0) };
    let n = normal(random);
    let one = turned(n, aim.angle(random));
    let other = unit(cross(n, one));
    let size = [random.power(-2.0, 2.0), random.power(-2.0, 2.0)];
    let part = |random: &mut Random, size: f64| match random.below(4) {
        0 => random.between(0.0, size),
        1 => size * random.offset(),
        2 => size * (1.0 + random.offset()),
        _ => random.between(-0.2, 1.2) * size,
    };
    let (u, v) = (part(random, size[0]), part(random, size[1]));
    let corner = moved(moved(aim.target, -u, one), -v, other);
    // `xdir` need not lie in the rectangle's plane.
    let lean = random.between(-1.0, 1.0) / dot(n, n).sqrt();
    let xdir = if random.once_in(2) { one } else { moved(one, lean, n) };
    let mut objects = vec![rectangle(n, xdir, corner, size)];
    if random.once_in(3) {
        objects.push(plane(normal(random), moved(aim.target, 1.0, aim.u)));
    }
    if random.once_in(6) { aim.many(random, &objects) } else { aim.question(&objects) }
}

fn triangle([a, b, c]: [Point; 3]) -> String {
    format!("triangle vertex1 {} vertex2 {} vertex3 {}", numbers(a), numbers(b), numbers(c))
}

/// Returns a scene of two triangles with a common edge, close to which the ray passes.
pub fn triangles(random: &mut Random) -> Question {
    let aim = if random.once_in(2) { Aim::new(random, 9.0) } else { Aim::plain(random, 9.0) };
    let size = if random.once_in(2) { random.between(0.5, 4.0) } else { aim.far * random.power(-5.0, -0.5) };
    let along = random.direction();
    let side = cross(along, aim.u);
    let near = moved(aim.target, size * random.offset(), side);
    let part = match random.below(3) {
        0 => random.offset(),
        1 => 1.0 + random.offset(),
        _ => random.between(0.0, 1.0),
    };
    let a = moved(near, -part * size, along);
    let b = moved(a, size, along);
    let corner = |random: &mut Random, side: Point| {
        moved(moved(near, size * random.between(0.2, 1.5), side), 0.5 * size, random.direction())
    };
    let (c, d) = (corner(random, side), corner(random, side.map(|part| -part)));
    let objects = [triangle([a, b, c]), triangle([b, a, d])];
    match random.below(8) {
        0 => aim.many(random, &objects),
        1 => aim.picture(&objects),
        _ => aim.question(&objects),
    }
}

/// Returns a scene of a thin triangle just in front of or behind another triangle, often seen near an edge.
pub fn slivers(random: &mut Random) -> Question {
    let aim = Aim::plain(random, 3.0);
    let [length, width] = [random.power(0.0, 3.0), random.power(-8.0, -1.0)];
    let along = random.direction();
    let side = unit(cross(along, random.direction()));
    let part = random.between(0.02, 0.98);
    let across = match random.below(3) {
        0 => random.offset(),
        _ => random.between(0.0, 1.0),
    };
    // The tip is at one end; at `part` of the length the triangle is `part * width` wide.
    let tip = moved(moved(aim.target, -part * length, along), -across * part * width, side);
    let end = moved(tip, length, along);
    let sliver = [tip, end, moved(end, width, side)];
    let gap = random.sign() * random.power(-14.0, -2.0);
    let depth = aim.target[2] - gap;
    let other = if random.once_in(2) {
        let wall = |x: f64, y: f64| [aim.target[0] + x, aim.target[1] + y, depth];
        [wall(-10.0, -9.0), wall(10.0, -9.0), wall(0.0, 12.0)]
    } else {
        let n = turned(along, aim.angle(random));
        let at = moved(aim.target, gap, aim.u);
        let one = unit(cross(n, random.direction()));
        let two = unit(cross(n, one));
        [moved(at, 5.0, one), moved(moved(at, -5.0, one), 5.0, two), moved(moved(at, -5.0, one), -5.0, two)]
    };
    let mut objects = vec![triangle(sliver), triangle(other)];
    if random.once_in(2) {
        objects.reverse();
    }
    aim.question(&objects)
}

/// Returns a scene of surfaces in one plane, whose coordinates are integers: the first one in the scene must be seen.
pub fn rugs(random: &mut Random) -> Question {
    let aim = Aim::plain(random, 3.0);
    let n = loop {
        let n = [0; 3].map(|_| random.whole(-3, 3));
        if n != [0.0; 3] {
            break n;
        }
    };
    let point = [random.whole(0, 8), random.whole(0, 6), random.whole(-9, -1)];
    // These are vectors of integers in the plane.
    let mut along = [n[1], -n[0], 0.0];
    if along == [0.0; 3] {
        along = [1.0, 0.0, 0.0];
    }
    let across = cross(n, along);
    let place =
        |random: &mut Random| moved(moved(point, random.whole(-2, 2), along), random.whole(-1, 1), across);
    let mut object = || {
        let at = place(random);
        let size = [random.whole(2, 12), random.whole(2, 12)];
        match random.below(4) {
            0 => {
                let many = random.whole(1, 3);
                plane(n.map(|part| part * many), at)
            }
            1 => plane(n, at),
            2 => triangle([at, moved(at, random.whole(1, 4), along), moved(at, random.whole(1, 4), across)]),
            _ => rectangle(n, moved(along, random.whole(0, 2), n), at, size),
        }
    };
    let objects = [object(), object(), object()];
    if random.once_in(2) { aim.many(random, &objects) } else { aim.picture(&objects) }
}

/// Returns a scene of copies, and copies of copies, of planes and of parts of planes, hit where copies of planes end or
/// anywhere else: at z = 0.01 in the world, whatever their own z is.
pub fn placed(random: &mut Random) -> Question {
    let (mut aim, is_at_end) = (Aim::plain(random, 3.0), random.once_in(2));
    if is_at_end {
        let by = (0.01 * (1.0 + random.offset()) - aim.target[2]) / aim.u[2];
        aim.target = moved(aim.target, by, aim.u);
    }
    let mut patterns = PATTERN.to_owned();
    let mut objects = Vec::new();
    for index in 0..random.whole(1, 3) as usize {
        let (n, point) = (normal(random), [0; 3].map(|_| random.between(-8.0, 8.0)));
        let one = turned(n, random.between(0.0, 6.0));
        let other = unit(cross(n, one));
        let corner = moved(moved(point, -4.0, one), -3.0, other);
        let of = match random.below(3) {
            0 => plane(n, point),
            1 => rectangle(n, one, corner, [8.0, 6.0]),
            _ => triangle([corner, moved(corner, 12.0, one), moved(corner, 12.0, other)]),
        };
        let (kind, rest) = of.split_once(' ').expect("a type and attributes");
        writeln!(patterns, "{kind} own{index} {{ material own {rest} }}").expect("room");
        let (mut name, mut spot) = (format!("own{index}"), point);
        if random.once_in(3) {
            let at = [0; 3].map(|_| random.between(-9.0, 9.0));
            let attributes = Copy::new(random, 1.0).attributes(&name, spot, at);
            name += "copy";
            writeln!(patterns, "place {name} {{ material own {attributes} }}").expect("room");
            spot = at;
        }
        let at = moved(aim.target, random.between(0.0, 0.5) * index as f64, random.direction());
        objects.push(format!("place {}", Copy::new(random, 1.0).attributes(&name, spot, at)));
    }
    let question = match random.below(4) {
        _ if is_at_end => aim.question(&objects),
        0 => aim.picture(&objects),
        _ => aim.many(random, &objects),
    };
    question.with_patterns(&patterns)
}
