//! Rays that leave the hits of others: outward from a convex shape, they hit nothing; inward, its other side. Where that
//! is, numbers of 320 bits tell, from the true hit of the first ray on.

use crate::common::model_in;
use crate::oracle::number::Number;
use crate::oracle::wide::Wide;
use glam::DVec3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::fmt::Write;
use std::fs;
use tabray::query::{Answer, Query, QueryRay, Start, Verdict};
use tempfile::TempDir;

/// The number of secondary rays of each shape, unless the environment's SECONDARY_RAYS says how many there are of all.
const RAYS: usize = 13_000;

/// The least cosine between a ray and the normal at its start. Rounding decides about rays that graze the shape.
const GRAZING: f64 = 0.01;

/// The most that proven bounds may be apart, as a fraction of the shape's size or of the first ray.
const NARROW: f64 = 1e-9;

type Vector = [Wide; 3];

fn exact(of: DVec3) -> Vector {
    of.to_array().map(Wide::f64)
}

fn each_axis(of: impl Fn(usize) -> Wide) -> Vector {
    [of(0), of(1), of(2)]
}

fn sub(one: &Vector, other: &Vector) -> Vector {
    each_axis(|axis| one[axis].sub(&other[axis]))
}

fn dot(one: &Vector, other: &Vector) -> Wide {
    let term = |axis: usize| one[axis].mul(&other[axis]);
    term(0).add(&term(1)).add(&term(2))
}

fn cross(one: &Vector, other: &Vector) -> Vector {
    let term = |a: usize, b: usize| one[a].mul(&other[b]).sub(&one[b].mul(&other[a]));
    [term(1, 2), term(2, 0), term(0, 1)]
}

/// A body whose boundary is a quadric or a plane.
enum Body {
    /// The centre of an ellipsoid along the axes, the weights of the squares, and the value there.
    Ellipsoid(DVec3, DVec3, f64),
    /// Three points of the boundary of a half-space, counterclockwise as seen from outside.
    HalfSpace([DVec3; 3]),
}

impl Body {
    /// Returns where a line enters the body and where it leaves it; an end is infinite if it does not.
    fn span(&self, from: &Vector, dir: &Vector) -> [Wide; 2] {
        match self {
            Self::Ellipsoid(center, weights, square) => {
                let (off, weights) = (sub(from, &exact(*center)), exact(*weights));
                let weighted = |of: &Vector| each_axis(|axis| weights[axis].mul(&of[axis]));
                let (a, half) = (dot(&weighted(dir), dir), dot(&weighted(dir), &off));
                let c = dot(&weighted(&off), &off).sub(&Wide::f64(*square));
                let root = half.square().sub(&a.mul(&c)).root();
                [half.neg().sub(&root).div(&a), root.sub(&half).div(&a)]
            }
            Self::HalfSpace(corners) => {
                let [a, b, c] = corners.map(exact);
                let normal = cross(&sub(&b, &a), &sub(&c, &a));
                let slope = dot(&normal, dir);
                let at = dot(&normal, &sub(&a, from)).div(&slope);
                match slope.is_negative() {
                    true => [at, Wide::huge()],
                    false => [Wide::huge().neg(), at],
                }
            }
        }
    }
}

/// Returns where a line enters the common part of bodies, and where it leaves it.
fn span(bodies: &[Body], from: &Vector, dir: &Vector) -> [Wide; 2] {
    let all = bodies.iter().map(|body| body.span(from, dir));
    let both = all.reduce(|[enters, leaves], [next, end]| [enters.max(&next), leaves.min(&end)]);
    both.expect("a body")
}

/// Tells whether an answer has a number within its bounds, and these close together.
fn holds(answer: &Answer, right: &Wide, size: f64) -> bool {
    let [low, high] = [answer.bounds.low, answer.bounds.high];
    let outside = [right.high().sub(&Wide::f64(low)), Wide::f64(high).sub(&right.low())];
    answer.verdict == Verdict::Hit && high - low < NARROW * size && !outside.iter().any(Wide::is_negative)
}

/// Returns an icosahedron as an OBJ file, and the half-spaces of its faces.
fn icosahedron(size: f64) -> (String, Vec<Body>) {
    let mut corners = Vec::new();
    for (one, other) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let [short, long] = [one, other * 1.618_033_988_749_895].map(|part| size * part);
        corners.extend([
            DVec3::new(0.0, short, long),
            DVec3::new(short, long, 0.0),
            DVec3::new(long, 0.0, short),
        ]);
    }
    let is_edge =
        |one: usize, other: usize| (corners[one].distance(corners[other]) / size - 2.0).abs() < 1e-6;
    let mut text = String::new();
    corners.iter().for_each(|at| writeln!(text, "v {} {} {}", at.x, at.y, at.z).expect("a string"));
    let mut bodies = Vec::new();
    for a in 0..corners.len() {
        for (b, c) in (a..corners.len()).flat_map(|b| (b..corners.len()).map(move |c| (b, c))) {
            if is_edge(a, b) && is_edge(b, c) && is_edge(a, c) {
                let normal = (corners[b] - corners[a]).cross(corners[c] - corners[a]);
                let [b, c] = if normal.dot(corners[a]) > 0.0 { [b, c] } else { [c, b] };
                writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("a string");
                bodies.push(Body::HalfSpace([a, b, c].map(|corner| corners[corner])));
            }
        }
    }
    assert_eq!(bodies.len(), 20);
    (text, bodies)
}

/// Returns the half-spaces of a cube from -1 to 1.
fn cube() -> Vec<Body> {
    let side = |axis: usize, sign: f64| {
        let (own, next) = (sign * DVec3::AXES[axis], DVec3::AXES[(axis + 1) % 3]);
        Body::HalfSpace([own, own + next, own + own.cross(next)])
    };
    (0..3).flat_map(|axis| [side(axis, 1.0), side(axis, -1.0)]).collect()
}

struct Dice(Pcg64);

impl Dice {
    /// Returns a vector that is in all directions equally often.
    fn direction(&mut self) -> DVec3 {
        loop {
            let mut number = || (self.0.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
            let vector = DVec3::new(number(), number(), number());
            if (1e-3..1.0).contains(&vector.length()) {
                return vector.normalize();
            }
        }
    }
}

/// Returns the point, the outward normal and the start of a hit.
fn start(query: &Query, ray: &QueryRay, answer: &Answer) -> (DVec3, DVec3, Start) {
    assert_eq!(answer.verdict, Verdict::Hit, "{ray:?}");
    let at = query.surroundings(ray, answer).expect("a hit");
    let object = answer.object.expect("an object");
    let start = query.start(query.number(object), query.surface(answer).expect("a surface"));
    let outward = if at.normal.dot(at.point) > 0.0 { at.normal } else { -at.normal };
    (at.point, outward, start.expect("a start"))
}

#[test]
fn rays_that_leave_hits_meet_what_is_there_and_not_their_start() {
    let count = std::env::var("SECONDARY_RAYS").ok().and_then(|text| text.parse::<usize>().ok());
    let folder = TempDir::new().expect("a folder");
    let ball = |x: f64, radius: f64| Body::Ellipsoid(DVec3::X * x, DVec3::ONE, radius * radius);
    let weights = DVec3::new(1.0, 2.0, 0.5);
    let mut shapes = vec![
        ("sphere s { material m center 0 0 0 radius 1 }".to_owned(), 1.0, vec![ball(0.0, 1.0)]),
        (
            "implicit s { material m formula \"x^2 + 2*y^2 + z^2/2 - 1\" box -2 -2 -2 2 2 2 }".to_owned(),
            1.0,
            vec![Body::Ellipsoid(DVec3::ZERO, weights, 1.0)],
        ),
        (
            "implicit s { material m formula \"x^2 + y^2 + z^2 + 0*sin(x) - 1\" box -2 -2 -2 2 2 2 }".to_owned(),
            1.0,
            vec![ball(0.0, 1.0)],
        ),
        (
            "sphere a { material m center 0.5 0 0 radius 1.25 } sphere b { material m center -0.5 0 0 radius 1.25 }
             intersection s { objects a b }"
                .to_owned(),
            1.0,
            vec![ball(0.5, 1.25), ball(-0.5, 1.25)],
        ),
        (
            "box s { material m center 0 0 0 size 2 2 2 }".to_owned(),
            1.0,
            cube(),
        ),
    ];
    for (name, size) in [("tiny.obj", 1e-6), ("one.obj", 1.0), ("huge.obj", 1e6)] {
        let (text, bodies) = icosahedron(size);
        fs::write(folder.path().join(name), text).expect("a file");
        shapes.push((format!("mesh s {{ material m file {name} }}"), size, bodies));
    }
    let each = count.map_or(RAYS, |count| count.div_ceil(shapes.len()));
    let (mut wrong, mut open, mut all) = (Vec::new(), 0, 0);
    for (number, (object, size, bodies)) in shapes.iter().enumerate() {
        let text = format!(
            "camera eye {{ pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }} material m {{ ambient 1 1 1 }} {object}"
        );
        let model = model_in(folder.path(), &text);
        let query = Query::new(&model);
        let mut dice = Dice(Pcg64::new(number as u128, 11));
        let lines: Vec<_> = (0..each)
            .map(|_| {
                let (from, toward) = (5.0 * *size * dice.direction(), 0.4 * *size * dice.direction());
                [from, toward - from]
            })
            .collect();
        let first: Vec<_> =
            lines.iter().map(|[from, dir]| QueryRay::new(*from, *dir).expect("a ray")).collect();
        let hits = query.proven(&first, false);
        let starts: Vec<_> =
            first.iter().zip(&hits).map(|(ray, answer)| start(&query, ray, answer)).collect();
        let second: Vec<_> = starts
            .iter()
            .map(|(point, outward, start)| {
                loop {
                    let dir = dice.direction();
                    if dir.dot(*outward).abs() > GRAZING {
                        break (dir, QueryRay::new(*point, dir).expect("a ray").leaving(*start));
                    }
                }
            })
            .collect();
        let rays: Vec<_> = second.iter().map(|(_, ray)| ray.clone()).collect();
        let answers = query.proven(&rays, false);
        for (index, (((point, outward, _), (dir, _)), answer)) in
            starts.iter().zip(&second).zip(answers).enumerate()
        {
            all += 1;
            let [from, toward] = lines[index].map(exact);
            let [entry, _] = span(bodies, &from, &toward);
            let start = each_axis(|axis| from[axis].add(&entry.mul(&toward[axis])));
            let [_, exit] = span(bodies, &start, &exact(*dir));
            let is_right = holds(&hits[index], &entry, 1.0)
                && if dir.dot(*outward) > 0.0 {
                    answer.verdict == Verdict::Miss
                } else {
                    holds(&answer, &exit, *size)
                };
            match answer.verdict {
                _ if is_right => {}
                Verdict::Undecided | Verdict::Edge | Verdict::Tie => open += 1,
                _ => wrong
                    .push(format!("{object}: from {point} along {dir}: {answer:?}, not {:?}", exit.near())),
            }
        }
    }
    println!("{all} rays, {} wrong, {open} open", wrong.len());
    assert!(wrong.is_empty(), "{} of {all}: {:#?}", wrong.len(), &wrong[..wrong.len().min(5)]);
    assert!(1000 * open <= all, "{open} of {all} are open");
}
