//! Spheres, ellipsoids and quadrics.

use crate::falsify::random::{Point, Random, across, cross, dot, moved, turned, unit};
use crate::falsify::scenes::{Aim, Question, numbers};

fn sphere(aim: &Aim, center: Point, radius: f64) -> String {
    format!("sphere center {} radius {}", aim.lengths(center), aim.length(radius))
}

/// Returns a random radius in world units, sometimes in proportion to the target's distance.
fn size(random: &mut Random, aim: &Aim) -> f64 {
    match random.below(3) {
        0 => random.between(0.5, 3.0),
        1 => aim.far * random.power(-5.0, 0.0),
        _ => random.power(-3.0, 2.0),
    }
}

/// Returns a scene of three spheres, seen through random pixels or in a whole image.
pub fn spheres(random: &mut Random) -> Question {
    let aim = if random.once_in(3) { Aim::new(random, 9.0) } else { Aim::plain(random, 9.0) };
    let objects: Vec<_> = (0..3)
        .map(|_| {
            let radius = random.between(0.5, 2.5);
            let center = moved(aim.target, random.between(0.0, 3.0), random.direction());
            sphere(&aim, center, radius)
        })
        .collect();
    if random.once_in(4) { aim.picture(&objects) } else { aim.many(random, &objects) }
}

/// Returns a scene of a sphere that the ray is tangent to up to a small offset, sometimes with another sphere behind
/// it.
pub fn sphere_tangents(random: &mut Random) -> Question {
    let aim = Aim::new(random, 9.0);
    let radius = size(random, &aim);
    let side = turned(aim.u, aim.angle(random));
    let center = moved(aim.target, radius * (1.0 + random.offset()), side);
    let mut objects = vec![sphere(&aim, center, radius)];
    if random.once_in(2) {
        let behind = moved(aim.target, radius * random.between(1.0, 5.0), aim.u);
        objects.push(sphere(&aim, behind, radius));
    }
    aim.question(&objects)
}

/// Returns a scene of a sphere around the viewer, as one of three shapes.
pub fn inside(random: &mut Random) -> Question {
    let aim = Aim::new(random, 4.0);
    let radius = random.power(-1.0, 5.0);
    let part = if random.once_in(2) { random.between(0.0, 0.99) } else { 1.0 - random.offset().abs() };
    let away = moved([0.0; 3], part * radius, random.direction());
    let center = moved(aim.eye, 1.0, away);
    let object = match random.below(3) {
        0 => sphere(&aim, center, radius),
        1 => format!("ellipsoid center {} radius {} scale 1 1 1", aim.lengths(center), aim.length(radius)),
        _ => format!(
            "quadric coefficients 1 1 1 0 0 0 0 0 0 {:?} center {} box {}",
            radius * radius,
            aim.lengths(center),
            numbers([-2.0, -2.0, -2.0, 2.0, 2.0, 2.0].map(|side| side * radius)),
        ),
    };
    aim.many(random, &[object])
}

/// Returns a scene of any size for which squares of lengths stay within the range of f64.
pub fn scales(random: &mut Random) -> Question {
    let far = if random.once_in(2) { 1.0 } else { 12.0 };
    let mut aim = Aim::new(random, far);
    aim.scaled(random.whole(-498, 470) as i32);
    let radius = size(random, &aim);
    let side = turned(aim.u, aim.angle(random));
    let near = if random.once_in(2) { random.between(0.0, 1.2) } else { 1.0 + random.offset() };
    let center = moved(aim.target, radius * near, side);
    let mut objects = vec![sphere(&aim, center, radius)];
    if random.once_in(2) {
        let normal = random.direction();
        objects.push(format!(
            "plane normal {} point {}",
            numbers(normal),
            aim.lengths(moved(aim.target, radius * random.between(0.5, 3.0), aim.u)),
        ));
    }
    aim.question(&objects)
}

fn stretch(random: &mut Random) -> Point {
    match random.below(3) {
        0 => [0; 3].map(|_| random.power(-0.5, 0.5)),
        1 => [0; 3].map(|_| random.power(-4.5, 4.5)),
        _ => {
            let mut scale = [1.0; 3];
            scale[random.below(3) as usize] = random.power(-9.0, 0.0);
            scale
        }
    }
}

fn ellipsoid(aim: &Aim, center: Point, radius: f64, scale: Point) -> String {
    format!("ellipsoid center {} radius {} scale {}", aim.lengths(center), aim.length(radius), numbers(scale))
}

/// Returns a scene of two ellipsoids, seen through random pixels or in a whole image.
pub fn ellipsoids(random: &mut Random) -> Question {
    let aim = if random.once_in(3) { Aim::new(random, 9.0) } else { Aim::plain(random, 9.0) };
    let objects: Vec<_> = (0..2)
        .map(|_| {
            let (scale, radius) = (stretch(random), random.between(0.5, 2.5));
            // The target is somewhere inside the ellipsoid.
            let inside = moved([0.0; 3], random.between(0.0, 1.0), random.direction());
            let center = [0, 1, 2].map(|axis| aim.target[axis] + radius * scale[axis] * inside[axis]);
            ellipsoid(&aim, center, radius, scale)
        })
        .collect();
    if random.once_in(4) { aim.picture(&objects) } else { aim.many(random, &objects) }
}

/// Returns a scene of an ellipsoid that the ray is tangent to up to a small offset.
pub fn ellipsoid_tangents(random: &mut Random) -> Question {
    let aim = Aim::new(random, 9.0);
    let (scale, radius) = (stretch(random), size(random, &aim));
    let squeezed = unit([0, 1, 2].map(|axis| aim.u[axis] / scale[axis]));
    let side = turned(squeezed, aim.angle(random));
    let by = radius * (1.0 + random.offset());
    let center = [0, 1, 2].map(|axis| aim.target[axis] + by * scale[axis] * side[axis]);
    let object = ellipsoid(&aim, center, radius, scale);
    aim.question(&[object])
}

fn quadric(k: [f64; 10], center: Point, low: Point, high: Point) -> String {
    format!(
        "quadric coefficients {} center {} box {} {}",
        numbers(k),
        numbers(center),
        numbers(low),
        numbers(high)
    )
}

fn value(k: &[f64; 10], [x, y, z]: Point) -> f64 {
    k[0] * x * x
        + k[1] * y * y
        + k[2] * z * z
        + k[3] * x * y
        + k[4] * x * z
        + k[5] * y * z
        + k[6] * x
        + k[7] * y
        + k[8] * z
}

fn gradient(k: &[f64; 10], [x, y, z]: Point) -> Point {
    [
        2.0 * k[0] * x + k[3] * y + k[4] * z + k[6],
        2.0 * k[1] * y + k[3] * x + k[5] * z + k[7],
        2.0 * k[2] * z + k[4] * x + k[5] * y + k[8],
    ]
}

/// Returns the coefficients of a random quadric, of one of many kinds.
fn coefficients(random: &mut Random) -> [f64; 10] {
    let mut k = [0.0; 10];
    match random.below(4) {
        0 => k = k.map(|_| random.between(-2.0, 2.0)),
        1 => k = k.map(|_| random.whole(-3, 3)),
        2 => {
            for axis in 0..3 {
                k[axis] = random.whole(-1, 1);
            }
        }
        _ => k = k.map(|_| if random.once_in(3) { 0.0 } else { random.sign() * random.power(-4.0, 4.0) }),
    }
    if k[..9].iter().all(|part| *part == 0.0) {
        k[random.below(9) as usize] = 1.0;
    }
    k
}

/// Returns a scene of two random quadrics with a point near the target, seen through random pixels or in a whole image.
pub fn quadrics(random: &mut Random) -> Question {
    let aim = if random.once_in(3) { Aim::new(random, 6.0) } else { Aim::plain(random, 6.0) };
    let objects: Vec<_> = (0..2)
        .map(|_| {
            let mut k = coefficients(random);
            let from = moved([0.0; 3], random.between(0.0, 3.0), random.direction());
            k[9] = value(&k, from);
            let center = [0, 1, 2].map(|axis| aim.target[axis] - from[axis]);
            let reach = random.between(1.0, 6.0);
            quadric(k, center, [-reach; 3], [reach; 3])
        })
        .collect();
    if random.once_in(4) { aim.picture(&objects) } else { aim.many(random, &objects) }
}

/// Returns a scene of a quadric that the ray is tangent to up to a small offset.
pub fn quadric_tangents(random: &mut Random) -> Question {
    let aim = Aim::new(random, 6.0);
    let mut k = coefficients(random);
    let from = moved([0.0; 3], random.between(0.1, 2.0), random.direction());
    // The linear terms make the gradient perpendicular to the ray.
    let along = dot(gradient(&k, from), aim.u);
    for axis in 0..3 {
        k[6 + axis] -= along * aim.u[axis];
    }
    if k[..9].iter().all(|part| *part == 0.0) {
        k[0] = 1.0;
    }
    k[9] = value(&k, from) * (1.0 + random.offset());
    let center = [0, 1, 2].map(|axis| aim.target[axis] - from[axis]);
    aim.question(&[quadric(k, center, [-20.0; 3], [20.0; 3])])
}

/// Returns a scene of a sphere that the linear terms move 10 to 10^4.5 world units away from its `center`.
pub fn quadric_moved(random: &mut Random) -> Question {
    let aim = Aim::new(random, 5.0);
    let away = moved([0.0; 3], random.power(1.0, 4.5), random.direction());
    let radius = random.power(-1.0, 1.0);
    let near = if random.once_in(2) { random.between(0.0, 1.1) } else { 1.0 + random.offset() };
    let ball = moved(aim.target, near * radius, turned(aim.u, aim.angle(random)));
    let center = moved(ball, -1.0, away);
    let many = random.power(-3.0, 3.0);
    let [x, y, z] = away.map(|part| -2.0 * part * many);
    let constant = (radius * radius - dot(away, away)) * many;
    let k = [many, many, many, 0.0, 0.0, 0.0, x, y, z, constant];
    let reach = 2.0 * radius;
    aim.question(&[quadric(k, center, away.map(|part| part - reach), away.map(|part| part + reach))])
}

/// Returns a scene of a sphere in a box that touches it, or of a cylinder whose box cuts it where the ray meets it.
pub fn quadric_boxes(random: &mut Random) -> Question {
    let aim = if random.once_in(2) { Aim::plain(random, 3.0) } else { Aim::new(random, 5.0) };
    let radius = (random.between(0.1, 3.0) * 100.0).round() / 100.0;
    if random.once_in(2) {
        // The ray meets the sphere near a pole, where the sphere touches the box.
        let mut pole = [0.0; 3];
        pole[random.below(3) as usize] = random.sign();
        if dot(pole, aim.u) > 0.0 {
            pole = pole.map(|part| -part);
        }
        let by = if random.once_in(4) { 0.0 } else { random.power(-9.0, -1.0) };
        let near = unit(moved(pole, by, random.direction()));
        let center = moved(aim.target, -radius, near);
        let k = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, radius * radius];
        return aim.question(&[quadric(k, center, [-radius; 3], [radius; 3])]);
    }
    let k = [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, radius * radius];
    let angle = random.between(0.0, 6.3);
    let from = [radius * angle.cos(), random.between(-1.0, 1.0), radius * angle.sin()];
    let center = moved(aim.target, -1.0, from);
    let mut high = [radius, 0.0, radius];
    high[1] = from[1] + random.offset();
    aim.question(&[quadric(k, center, [-radius, from[1] - 2.0, -radius], high)])
}

/// Returns a scene of a double plane, or of a pair of planes close to each other.
pub fn quadric_pairs(random: &mut Random) -> Question {
    let aim = Aim::new(random, 4.0);
    let n = if random.once_in(2) { [0; 3].map(|_| random.whole(-3, 3)) } else { random.direction() };
    let n = if n == [0.0; 3] { [1.0, 1.0, 1.0] } else { n };
    let apart = if random.once_in(6) { 0.0 } else { random.power(-20.0, -1.0) };
    let from = cross(n, random.direction()).map(|part| part * random.between(0.0, 3.0));
    let k = [
        n[0] * n[0],
        n[1] * n[1],
        n[2] * n[2],
        2.0 * n[0] * n[1],
        2.0 * n[0] * n[2],
        2.0 * n[1] * n[2],
        0.0,
        0.0,
        0.0,
        apart,
    ];
    let center = moved(aim.target, -1.0, from);
    let object = quadric(k, center, [-50.0; 3], [50.0; 3]);
    if random.once_in(2) { aim.question(&[object]) } else { aim.many(random, &[object]) }
}

/// Returns a scene of a cone seen near its apex, or of an equation with tiny or huge coefficients.
pub fn quadric_cones(random: &mut Random) -> Question {
    let aim = Aim::new(random, 5.0);
    let many = match random.below(3) {
        0 => 1.0,
        1 => random.power(-301.0, -100.0),
        _ => random.power(100.0, 200.0),
    };
    let steep = random.between(0.2, 3.0);
    let mut k = [many, -steep * many, many, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    if random.once_in(3) {
        k[9] = many * random.offset();
    }
    if random.once_in(4) {
        k = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, many, 0.0, -many, many];
    }
    let off = moved([0.0; 3], random.offset(), random.direction());
    let center = moved(aim.target, 1.0, off);
    let object = quadric(k, center, [-3.0; 3], [3.0; 3]);
    if random.once_in(2) { aim.question(&[object]) } else { aim.many(random, &[object]) }
}

/// Returns a scene of shapes that meet the ray at the same point, up to a small offset.
pub fn meeting(random: &mut Random) -> Question {
    let aim = Aim::new(random, 6.0);
    let mut objects: Vec<String> = (0..2)
        .map(|_| {
            let off = if random.once_in(2) { random.offset() } else { 0.0 };
            let at = moved(aim.target, off, aim.u);
            let mut normal = random.direction();
            if dot(normal, aim.u) > 0.0 {
                normal = normal.map(|part| -part);
            }
            let radius = random.power(-1.0, 2.0);
            let center = moved(at, -radius, normal);
            match random.below(4) {
                0 => format!("plane normal {} point {}", numbers(normal), numbers(at)),
                1 => sphere(&aim, center, radius),
                2 => ellipsoid(&aim, center, radius, [1.0; 3]),
                _ => {
                    let k = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, radius * radius];
                    quadric(k, center, [-2.0 * radius; 3], [2.0 * radius; 3])
                }
            }
        })
        .collect();
    if random.once_in(3) {
        let [one, other] = across(aim.u);
        let corner = moved(moved(aim.target, -1.0, one), -1.0, other);
        objects.push(format!(
            "fplane normal {} xdir {} dimensions 2 2 point {}",
            numbers(aim.u),
            numbers(one),
            numbers(corner)
        ));
    }
    aim.question(&objects)
}
