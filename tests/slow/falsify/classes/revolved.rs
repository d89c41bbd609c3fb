//! Surfaces of revolution, tori and hearts.
#![allow(clippy::approx_constant, reason = "the notes' vase is 6.28 high")]

use super::barely;
use crate::falsify::random::{Point, Random, cross, dot, moved, turned, unit};
use crate::falsify::scenes::{Aim, Question, numbers};

/// A profile's attribute, the same profile as a Rust function, and a suitable height in world units.
type Profile = (String, Box<dyn Fn(f64) -> f64>, f64);

fn surfer(random: &mut Random) -> Profile {
    let height = if random.once_in(2) { 6.28 } else { random.between(0.5, 8.0) };
    match random.below(4) {
        0 => ("surfer 0".to_owned(), Box::new(|y: f64| 2.0 + y.sin()), height),
        1 => ("surfer 1".to_owned(), Box::new(|y: f64| -4.0 / 6.0 * (y - 6.0)), height),
        2 => ("surfer 2".to_owned(), Box::new(|y: f64| 1.0 + 0.5 * y.cos()), height),
        _ => ("surfer 3".to_owned(), Box::new(|y: f64| 1.0 + 0.5 * y.sin()), height),
    }
}

fn formula(random: &mut Random) -> Profile {
    let quoted = |text: String| format!("profile \"{text}\"");
    let middle = (random.between(0.5, 5.5) * 100.0).round() / 100.0;
    match random.below(12) {
        0 => {
            let thin = 10_f64.powf(random.whole(2, 14));
            let text = quoted(format!("max(0.3 - y, 2 - {thin:?}*(y-{middle})^2)"));
            (text, Box::new(move |y| (0.3 - y).max(2.0 - thin * (y - middle).powi(2))), 6.0)
        }
        1 => {
            let many = random.whole(2, 40);
            let text = quoted(format!("1 + 0.3*sin({many}*y)"));
            (text, Box::new(move |y| 1.0 + 0.3 * (many * y).sin()), 6.28)
        }
        2 => {
            let text = quoted(format!("0.6 + 0.5*abs(y-{middle})"));
            (text, Box::new(move |y| 0.6 + 0.5 * (y - middle).abs()), 6.0)
        }
        3 => {
            let thin = random.power(1.0, 4.0).round();
            let text = quoted(format!("0.3 + 2*exp(-({thin:?}*(y-{middle}))^2)"));
            (text, Box::new(move |y| 0.3 + 2.0 * (-(thin * (y - middle)).powi(2)).exp()), 6.28)
        }
        4 => {
            let radius = random.whole(1, 3);
            let text = quoted(format!("sqrt({radius}^2 - (y-{radius})^2)"));
            (text, Box::new(move |y| (radius * radius - (y - radius).powi(2)).max(0.0).sqrt()), 2.0 * radius)
        }
        5 => (quoted("y^2 - 2*y + 0.5".to_owned()), Box::new(|y| y * y - 2.0 * y + 0.5), 3.0),
        6 => (quoted("min(2, 1/abs(y-3))".to_owned()), Box::new(|y| (1.0 / (y - 3.0).abs()).min(2.0)), 6.0),
        7 => (quoted("max(0.2, ln(y))".to_owned()), Box::new(|y| y.ln().max(0.2)), 6.0),
        8 => (quoted("y^y/10".to_owned()), Box::new(|y| y.powf(y) / 10.0), 3.0),
        9 => {
            let tall = random.power(1.0, 4.0).round();
            (
                quoted(format!("1 + 0.001*sin(y/{tall:?})")),
                Box::new(move |y| 1.0 + 0.001 * (y / tall).sin()),
                tall,
            )
        }
        10 => (quoted("sin(y)".to_owned()), Box::new(f64::sin), 12.0),
        _ => {
            let text = quoted("1.5 - 0.2*y + 0.1*sin(5*y)*cos(3*y)".to_owned());
            (text, Box::new(|y| 1.5 - 0.2 * y + 0.1 * (5.0 * y).sin() * (3.0 * y).cos()), 6.0)
        }
    }
}

fn revolved(text: &str, axis: Point, base: Point, height: f64) -> String {
    format!("revsurf {text} direction {} base {} height {height:?}", numbers(axis), numbers(base))
}

/// Returns a scene of a surface of revolution near the target, seen through random pixels or in a whole image.
fn seen(random: &mut Random, profile: Profile, far: f64) -> Question {
    let aim = if random.once_in(3) { Aim::new(random, far) } else { Aim::plain(random, far) };
    let (text, _, height) = profile;
    let axis = random.axis();
    let base = moved(aim.target, -height * random.between(0.0, 1.0), unit(axis));
    let base = if random.once_in(5) { aim.eye } else { base };
    let objects = [revolved(&text, axis, base, height)];
    if random.once_in(8) { aim.picture(&objects) } else { aim.many(random, &objects) }
}

/// Returns a scene of one of the notes' surfaces.
pub fn surfers(random: &mut Random) -> Question {
    let profile = surfer(random);
    seen(random, profile, 9.0)
}

/// Returns a scene of a surface whose profile is a formula: thin discs, waves, kinks, ends on the axis.
pub fn formulas(random: &mut Random) -> Question {
    let profile = formula(random);
    seen(random, profile, 6.0)
}

/// Returns a scene of a surface that the ray is tangent to up to a small offset, or that it meets at the rim.
pub fn tangents(random: &mut Random) -> Question {
    let aim = Aim::new(random, 8.0);
    let (text, profile, height) = if random.once_in(2) { surfer(random) } else { formula(random) };
    let at_rim = random.once_in(3);
    let y = if !at_rim {
        height * random.between(0.0, 1.0)
    } else if random.once_in(2) {
        random.offset()
    } else {
        height * (1.0 + random.offset())
    };
    let radius = profile(y.clamp(0.0, height));
    let slope = (profile((y + 1e-6).min(height)) - profile((y - 1e-6).max(0.0))) / 2e-6;
    let by = if at_rim { 1.0 } else { 1.0 + random.offset() };
    // The axis is such that the surface's normal at this height is perpendicular to the ray.
    let normal = if at_rim { random.direction() } else { turned(aim.u, aim.angle(random)) };
    let beside = unit(cross(normal, random.direction()));
    // normal = (out - slope * axis) / sqrt(1 + slope^2), in the plane of `normal` and `beside`.
    let root = (1.0 + slope * slope).sqrt();
    let out = moved(normal.map(|part| part / root), slope / root, beside);
    let axis = moved(beside.map(|part| part / root), -slope / root, normal);
    if !(dot(axis, axis).is_finite() && radius.is_finite()) {
        return surfers(random);
    }
    let base = moved(moved(aim.target, -radius * by, out), -y, axis);
    let length = random.power(-1.0, 1.0);
    let axis = axis.map(|part| part * length);
    aim.question(&[revolved(&text, axis, base, height)])
}

/// Returns a scene of a torus. In half of the scenes the ray is tangent to it up to a small offset.
pub fn tori(random: &mut Random) -> Question {
    let is_aimed = random.once_in(2);
    let aim = if is_aimed || random.once_in(3) { Aim::new(random, 8.0) } else { Aim::plain(random, 8.0) };
    let (radius, tube) = (random.power(-0.5, 1.0), random.power(-1.5, 0.3));
    let axis = random.axis();
    let up = unit(axis);
    let center = if is_aimed {
        // normal = out * cos + up * sin, perpendicular to the ray.
        let normal = turned(aim.u, aim.angle(random));
        let height = dot(normal, up);
        let out = unit(moved(normal, -height, up));
        let by = tube * (1.0 + random.offset());
        moved(
            moved(aim.target, -by, normal),
            -radius,
            if random.once_in(2) { out } else { out.map(|part| -part) },
        )
    } else {
        moved(aim.target, radius * random.between(0.0, 1.1), random.direction())
    };
    let object = format!(
        "torus center {} direction {} radius {radius:?} tube {tube:?}",
        numbers(center),
        numbers(axis)
    );
    match random.below(16) {
        0 => aim.picture(&[object]),
        _ if is_aimed => aim.question(&[object]),
        _ => aim.many(random, &[object]),
    }
}

/// Returns a scene of a heart, near or far away.
pub fn hearts(random: &mut Random) -> Question {
    let aim = if random.once_in(3) { Aim::new(random, 8.0) } else { Aim::plain(random, 8.0) };
    let size = random.power(-0.5, 1.0);
    let object = |center: Point| format!("heart center {} size {size:?}", numbers(center));
    if random.once_in(4) {
        // The ray passes close to the heart's cleft, its tip or one of its sides.
        let near = [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0 / 3.0]];
        let near = near[random.below(4) as usize];
        let near = moved(near, random.offset(), random.direction());
        let center = moved(aim.target, -size, near);
        return aim.question(&[object(center)]);
    }
    let center = moved(aim.target, size * random.between(0.0, 1.0), random.direction());
    if random.once_in(16) { aim.picture(&[object(center)]) } else { aim.many(random, &[object(center)]) }
}

/// Returns a scene of one of these shapes, moved by bisection until the ray barely hits or barely misses it.
pub fn silhouettes(random: &mut Random) -> Question {
    let aim = match random.below(3) {
        0 => Aim::new(random, 1.0),
        1 => Aim::new(random, 7.0),
        _ => Aim::plain(random, 9.0),
    };
    let (axis, side) = (random.axis(), turned(aim.u, aim.angle(random)));
    let inside = moved(aim.target, random.between(0.0, 0.5), random.direction());
    let (before, after, reach) = match random.below(3) {
        0 => {
            let size = random.power(-0.5, 0.5);
            ("heart center ".to_owned(), format!("size {size:?}"), 4.0 * size)
        }
        1 => {
            let (radius, tube) = (random.power(-0.3, 0.5), random.power(-1.5, 0.0));
            let after = format!("direction {} radius {radius:?} tube {tube:?}", numbers(axis));
            ("torus center ".to_owned(), after, 3.0 * (radius + tube))
        }
        _ => {
            let (text, _, height) = if random.once_in(2) { surfer(random) } else { formula(random) };
            let after = format!("direction {} height {height:?} {text}", numbers(axis));
            ("revsurf base ".to_owned(), after, 2.0 * height + 20.0)
        }
    };
    let question = |by: f64| {
        let at = moved(inside, by, side);
        aim.question(&[format!("{before}{} {after}", numbers(at))])
    };
    barely(random, question, reach, 60)
}
