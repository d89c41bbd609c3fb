//! Random shapes with a formula for their hits, and rays that are hard for them: from afar, along edges, past
//! silhouettes, and almost within planes.

use super::rays::{Random, toward};
use super::tally::{Tally, Tolerance, ulp};
use super::{Surface, Truth, fplane_text, spelt};
use glam::{DMat3, DVec2, DVec3};
use tabray::geometry::{Ray, RayRange};
use tabray::world::Hittable;

/// A function that returns a random point of a surface and its normal, if it finds one.
type RandomPlace = dyn Fn(&mut Random) -> Option<(DVec3, DVec3)>;

/// A shape, as a scene's text and as its truth.
pub struct Subject {
    /// The text of the entity, with a material `m`.
    pub text: String,
    surface: Surface,
    /// The middle of a sphere that contains what rays are aimed at; `reach` is its radius in world units.
    middle: DVec3,
    reach: f64,
    /// The boundary that hard rays come close to.
    brink: Brink,
}

/// The boundary between a hit and a miss.
enum Brink {
    /// The silhouette, to which rays are tangent.
    Round(Box<RandomPlace>),
    /// The edges of a part of a plane, each with its ends and its inward direction.
    Edges(Vec<(DVec3, DVec3, DVec3)>),
    /// The directions in an unbounded plane with this unit normal.
    Endless(DVec3),
}

/// The kinds of shapes.
pub const KINDS: [&str; 6] = ["sphere", "ellipsoid", "quadric", "triangle", "plane", "fplane"];

/// The sets of rays.
pub const SETS: [&str; 3] = ["camera", "far", "grazing"];

fn vector(random: &mut Random, most: f64) -> DVec3 {
    DVec3::from([0; 3].map(|_| random.between(-most, most)))
}

/// Returns 10 to a random power.
fn magnitude(random: &mut Random, from: f64, to: f64) -> f64 {
    10_f64.powf(random.between(from, to))
}

/// Returns a random point, mostly behind the image plane.
fn place(random: &mut Random) -> DVec3 {
    vector(random, 8.0) - DVec3::new(0.0, 0.0, 12.0)
}

/// Returns a random shape of a kind.
pub fn subject(kind: &str, random: &mut Random) -> Subject {
    match kind {
        "sphere" => ellipsoid(random, true),
        "ellipsoid" => ellipsoid(random, false),
        "quadric" => quadric(random),
        "triangle" => triangle(random),
        "plane" => plane(random),
        "fplane" => rectangle(random),
        _ => panic!("no kind {kind}"),
    }
}

fn ellipsoid(random: &mut Random, is_sphere: bool) -> Subject {
    let center = place(random);
    // The ratio of the half axes is at most 1e9 : 1.
    let (radius, scale, text) = if is_sphere {
        let radius = magnitude(random, -3.0, 2.0);
        (radius, DVec3::ONE, format!("sphere s {{ material m center {} radius {radius:?} }}", spelt(center)))
    } else {
        let radius = magnitude(random, -1.0, 1.0);
        let widest = if random.below(2) == 0 { 1.0 } else { 4.5 };
        let scale = DVec3::from([0; 3].map(|_| magnitude(random, -widest, widest)));
        let (center, stretch) = (spelt(center), spelt(scale));
        (
            radius,
            scale,
            format!("ellipsoid e {{ material m center {center} radius {radius:?} scale {stretch} }}"),
        )
    };
    let round = move |random: &mut Random| {
        let at = random.direction();
        Some((center + radius * scale * at, (at / scale).normalize()))
    };
    Subject {
        surface: Surface::read(&text),
        text,
        middle: center,
        reach: radius * scale.max_element(),
        brink: Brink::Round(Box::new(round)),
    }
}

/// Returns the coefficients of `(p - m)·S(p - m) = j`.
fn moved(square: DMat3, middle: DVec3, j: f64) -> [f64; 10] {
    let linear = -2.0 * (square * middle);
    let [a, b, c] = [square.x_axis.x, square.y_axis.y, square.z_axis.z];
    let [d, e, f] = [2.0 * square.x_axis.y, 2.0 * square.x_axis.z, 2.0 * square.y_axis.z];
    [a, b, c, d, e, f, linear.x, linear.y, linear.z, j - middle.dot(square * middle)]
}

fn quadric(random: &mut Random) -> Subject {
    let mut coefficients: [f64; 10];
    let (mut middle, mut reach, mut boxed) = (DVec3::ZERO, 3.0, 1e9);
    match random.below(5) {
        // A sphere or a tilted ellipsoid, whose middle is up to 1e4 away from its `center`.
        0 => {
            middle = magnitude(random, 0.0, 4.0) * random.direction();
            let axes = DMat3::from_cols(random.direction(), random.direction(), random.direction());
            let square = if random.below(2) == 0 { DMat3::IDENTITY } else { axes * axes.transpose() };
            coefficients = moved(square, middle, magnitude(random, -1.0, 1.0));
        }
        // Integer coefficients: bowls, saddles, cones, cylinders and planes, clipped to a box.
        1 => {
            coefficients = [0; 10].map(|_| f64::from(random.below(7)) - 3.0);
            boxed = 4.0;
        }
        // A sphere that touches its box.
        2 => {
            let radius = random.between(0.1, 2.0);
            coefficients = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, radius * radius];
            boxed = radius;
        }
        // Two planes close to each other.
        3 => {
            let normal = DVec3::from([0; 3].map(|_| f64::from(random.below(5)) - 2.0));
            let normal = if normal == DVec3::ZERO { DVec3::ONE } else { normal };
            let square = DMat3::from_cols(normal.x * normal, normal.y * normal, normal.z * normal);
            coefficients = moved(square, DVec3::ZERO, magnitude(random, -16.0, 0.0));
            boxed = 50.0;
        }
        // Any coefficients.
        _ => {
            coefficients = [0; 10].map(|_| random.between(-1.0, 1.0));
            boxed = 6.0;
        }
    }
    if coefficients[..9].iter().all(|coefficient| *coefficient == 0.0) {
        coefficients[0] = 1.0;
    }
    if boxed < 50.0 {
        reach = 1.5 * boxed;
    }
    let factor = if random.below(4) == 0 { magnitude(random, -150.0, 150.0) } else { 1.0 };
    coefficients = coefficients.map(|coefficient| coefficient * factor);
    let center = place(random);
    let corners = [DVec3::splat(-boxed), DVec3::splat(boxed)];
    let text = format!(
        "quadric q {{ material m coefficients {} center {} box {} {} }}",
        coefficients.map(|coefficient| format!("{coefficient:?}")).join(" "),
        spelt(center),
        spelt(corners[0]),
        spelt(corners[1]),
    );
    let (surface, probe) = (Surface::read(&text), Surface::read(&text));
    let middle = center + middle;
    let round = move |random: &mut Random| {
        let ray = toward(middle + 5.0 * reach * random.direction(), random.in_ball(middle, reach));
        let hit = probe.first_hit(&ray, 0.0).hit()?;
        let [a, b, c, d, e, f, g, h, i, _] = coefficients.map(|coefficient| coefficient / factor);
        let at = ray.at(hit.t.high);
        let DVec3 { x, y, z } = at - center;
        let normal = DVec3::new(
            2.0 * a * x + d * y + e * z + g,
            d * x + 2.0 * b * y + f * z + h,
            e * x + f * y + 2.0 * c * z + i,
        );
        Some((at, normal.try_normalize()?))
    };
    Subject { text, surface, middle, reach, brink: Brink::Round(Box::new(round)) }
}

fn triangle(random: &mut Random) -> Subject {
    let a = place(random);
    let b = a + magnitude(random, -2.0, 2.0) * random.direction();
    // The triangle is as thin as 1e-12 of its length.
    let width = magnitude(random, -12.0, 0.0) * (b - a).length();
    let c = a + random.between(-0.5, 1.5) * (b - a) + width * random.direction();
    let text =
        format!("triangle t {{ material m vertex1 {} vertex2 {} vertex3 {} }}", spelt(a), spelt(b), spelt(c));
    let normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
    let edge = |from: DVec3, to: DVec3| (from, to, normal.cross(to - from).normalize_or(DVec3::X));
    Subject {
        surface: Surface::read(&text),
        text,
        middle: (a + b + c) / 3.0,
        reach: (b - a).length().max((c - a).length()),
        brink: Brink::Edges(vec![edge(a, b), edge(b, c), edge(c, a)]),
    }
}

/// Returns a random normal, not of unit length in general: in any direction, of small integers, or along an axis.
fn normal(random: &mut Random) -> DVec3 {
    match random.below(3) {
        0 => random.direction() * magnitude(random, -3.0, 3.0),
        1 => {
            let whole = DVec3::from([0; 3].map(|_| f64::from(random.below(7)) - 3.0));
            if whole == DVec3::ZERO { DVec3::ONE } else { whole }
        }
        _ => [DVec3::X, DVec3::NEG_Y, DVec3::Z][random.below(3) as usize],
    }
}

fn plane(random: &mut Random) -> Subject {
    let (normal, point) = (normal(random), place(random));
    let text = format!("plane p {{ material m normal {} point {} }}", spelt(normal), spelt(point));
    Subject {
        surface: Surface::read(&text),
        text,
        middle: point,
        reach: 3.0,
        brink: Brink::Endless(normal.normalize()),
    }
}

fn rectangle(random: &mut Random) -> Subject {
    let (normal, point) = (normal(random), place(random));
    let dimensions = DVec2::new(magnitude(random, -2.0, 1.5), magnitude(random, -2.0, 1.5));
    let unit = normal.normalize();
    let xdir = loop {
        let xdir = random.direction();
        if unit.cross(xdir).length() > 1e-3 {
            break xdir;
        }
    };
    let text = fplane_text(normal, point, xdir, dimensions);
    let y = unit.cross(xdir).normalize();
    let x = y.cross(unit);
    let corner = |along: f64, up: f64| point + along * dimensions.x * x + up * dimensions.y * y;
    let edges = vec![
        (corner(0.0, 0.0), corner(1.0, 0.0), y),
        (corner(0.0, 0.0), corner(0.0, 1.0), x),
        (corner(1.0, 1.0), corner(1.0, 0.0), -x),
        (corner(1.0, 1.0), corner(0.0, 1.0), -y),
    ];
    Subject {
        surface: Surface::read(&text),
        text,
        middle: corner(0.5, 0.5),
        reach: 0.7 * dimensions.length(),
        brink: Brink::Edges(edges),
    }
}

impl Subject {
    /// Returns the first hit of a ray beyond a distance.
    pub fn truth(&self, ray: &Ray, near: f64) -> Truth {
        self.surface.first_hit(ray, near)
    }

    /// Returns a random ray of a set.
    pub fn ray(&self, set: &str, random: &mut Random) -> Ray {
        match set {
            "camera" => {
                let origin = self.middle + self.reach * random.between(1.5, 8.0) * random.direction();
                toward(origin, self.target(random))
            }
            "far" => {
                let distance = self.reach.min(100.0) * magnitude(random, 1.0, 9.0);
                toward(self.middle + distance * random.direction(), self.target(random))
            }
            _ => self.grazing(random),
        }
    }

    /// Returns a point of the shape or close to it.
    fn target(&self, random: &mut Random) -> DVec3 {
        match &self.brink {
            Brink::Edges(edges) if random.below(4) != 0 => {
                let weights: Vec<f64> = edges.iter().map(|_| random.between(0.0, 1.0)).collect();
                let sum: DVec3 = edges.iter().zip(&weights).map(|((from, ..), weight)| *weight * *from).sum();
                sum / weights.iter().sum::<f64>()
            }
            _ => random.in_ball(self.middle, self.reach),
        }
    }

    /// Returns a ray that passes the boundary at 1e-2 to 1e-15, from close to it or from far away.
    fn grazing(&self, random: &mut Random) -> Ray {
        let apart = magnitude(random, -15.0, -2.0) * if random.below(2) == 0 { 1.0 } else { -1.0 };
        let farthest = if random.below(4) == 0 { 9.0 } else { 1.3 };
        let distance = magnitude(random, 0.0, farthest);
        match &self.brink {
            Brink::Round(place) => {
                let Some((at, normal)) = place(random) else { return self.ray("camera", random) };
                let (along, across) = normal.any_orthonormal_pair();
                let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
                let dir = (cos * along + sin * across).normalize();
                Ray { origin: at + apart * normal - distance * dir, dir }
            }
            Brink::Edges(edges) => {
                let (from, to, inward) = edges[random.below(edges.len() as u32) as usize];
                let at = from + random.between(-0.01, 1.01) * (to - from) + apart * inward;
                toward(at + distance * random.direction(), at)
            }
            Brink::Endless(normal) => {
                let (along, across) = normal.any_orthonormal_pair();
                let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
                let dir = (cos * along + sin * across + apart * *normal).normalize();
                let above = magnitude(random, -15.0, 1.0) * if random.below(2) == 0 { 1.0 } else { -1.0 };
                Ray { origin: self.middle + distance * along + above * *normal, dir }
            }
        }
    }

    /// Counts the program's hit of a ray, compared with its truth.
    pub fn count(&self, tally: &mut Tally, shape: &dyn Hittable, ray: &Ray, truth: Truth) {
        let found = shape.distance(ray, &RayRange::ALL);
        let hit = truth.hit();
        // A distance closer to another hit belongs to that hit, unless rounding makes the two hits nearly one.
        let sure = hit.map_or(0.0, |hit| 64.0 * ulp(hit.t.high));
        let slant = hit.map_or(1.0, |hit| shape.normal(ray.at(hit.t.high)).dot(ray.dir).abs());
        let off_surface = |found: f64| hit.map_or(0.0, |hit| (hit.t - found.into()).high.abs() * slant);
        let next = |near: f64| self.truth(ray, near);
        tally.count(truth, found, Tolerance { sure, most: f64::INFINITY }, next, off_surface);
    }
}
