//! Rays that leave the hits of others: outward from a convex shape, they hit nothing; inward, its other side.

use crate::common::model_in;
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

/// The bodies whose common part is a convex shape around the origin, with numbers of their own.
enum Bodies {
    /// The centres of ellipsoids along the axes, their weights of the squares, and the values there.
    Ellipsoids(Vec<(DVec3, DVec3, f64)>),
    /// The unit normals of half-spaces, and their distances.
    HalfSpaces(Vec<(DVec3, f64)>),
}

impl Bodies {
    /// Returns the distance at which a ray from within leaves them, computed without its start.
    fn exit(&self, from: DVec3, dir: DVec3) -> f64 {
        match self {
            Self::Ellipsoids(all) => {
                let exit = |(center, weights, square): &(DVec3, DVec3, f64)| {
                    let off = from - center;
                    let [a, half, c] =
                        [weights.dot(dir * dir), weights.dot(off * dir), weights.dot(off * off) - square];
                    ((half * half - a * c).sqrt() - half) / a
                };
                all.iter().map(exit).fold(f64::INFINITY, f64::min)
            }
            Self::HalfSpaces(all) => {
                let ahead = all.iter().filter(|(normal, _)| normal.dot(dir) > 0.0);
                let exit =
                    |(normal, distance): &(DVec3, f64)| (distance - normal.dot(from)) / normal.dot(dir);
                ahead.map(exit).fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// Returns an icosahedron as an OBJ file, and its faces' planes.
fn icosahedron(size: f64) -> (String, Bodies) {
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
    let mut planes = Vec::new();
    for a in 0..corners.len() {
        for (b, c) in (a..corners.len()).flat_map(|b| (b..corners.len()).map(move |c| (b, c))) {
            if is_edge(a, b) && is_edge(b, c) && is_edge(a, c) {
                let normal = (corners[b] - corners[a]).cross(corners[c] - corners[a]).normalize();
                let is_outward = normal.dot(corners[a]) > 0.0;
                let [b, c] = if is_outward { [b, c] } else { [c, b] };
                writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("a string");
                let normal = if is_outward { normal } else { -normal };
                planes.push((normal, normal.dot(corners[a])));
            }
        }
    }
    assert_eq!(planes.len(), 20);
    (text, Bodies::HalfSpaces(planes))
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
    let ball = |center, radius: f64| (center, DVec3::ONE, radius * radius);
    let lens = Bodies::Ellipsoids(vec![ball(DVec3::X * 0.5, 1.25), ball(DVec3::X * -0.5, 1.25)]);
    let weights = DVec3::new(1.0, 2.0, 0.5);
    let mut shapes = vec![
        ("sphere s { material m center 0 0 0 radius 1 }".to_owned(), 1.0, Bodies::Ellipsoids(vec![ball(DVec3::ZERO, 1.0)])),
        (
            "implicit s { material m formula \"x^2 + 2*y^2 + z^2/2 - 1\" box -2 -2 -2 2 2 2 }".to_owned(),
            1.0,
            Bodies::Ellipsoids(vec![(DVec3::ZERO, weights, 1.0)]),
        ),
        (
            "implicit s { material m formula \"x^2 + y^2 + z^2 + 0*sin(x) - 1\" box -2 -2 -2 2 2 2 }".to_owned(),
            1.0,
            Bodies::Ellipsoids(vec![ball(DVec3::ZERO, 1.0)]),
        ),
        (
            "sphere a { material m center 0.5 0 0 radius 1.25 } sphere b { material m center -0.5 0 0 radius 1.25 }
             intersection s { objects a b }"
                .to_owned(),
            1.0,
            lens,
        ),
        (
            "box s { material m center 0 0 0 size 2 2 2 }".to_owned(),
            1.0,
            Bodies::HalfSpaces(DVec3::AXES.into_iter().flat_map(|axis| [(axis, 1.0), (-axis, 1.0)]).collect()),
        ),
    ];
    for (name, size) in [("tiny.obj", 1e-6), ("one.obj", 1.0), ("huge.obj", 1e6)] {
        let (text, planes) = icosahedron(size);
        fs::write(folder.path().join(name), text).expect("a file");
        shapes.push((format!("mesh s {{ material m file {name} }}"), size, planes));
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
        let first: Vec<QueryRay> = (0..each)
            .map(|_| {
                let (from, toward) = (5.0 * *size * dice.direction(), 0.4 * *size * dice.direction());
                QueryRay::new(from, toward - from).expect("a ray")
            })
            .collect();
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
        for (((point, outward, _), (dir, _)), answer) in
            starts.iter().zip(&second).zip(query.proven(&rays, false))
        {
            all += 1;
            let is_right = if dir.dot(*outward) > 0.0 {
                answer.verdict == Verdict::Miss
            } else {
                let exit = bodies.exit(*point, *dir);
                answer.verdict == Verdict::Hit && (answer.t - exit).abs() <= 1e-6 * exit
            };
            match answer.verdict {
                _ if is_right => {}
                Verdict::Undecided | Verdict::Edge | Verdict::Tie => open += 1,
                _ => wrong.push(format!("{object}: from {point} along {dir}: {answer:?}")),
            }
        }
    }
    println!("{all} rays, {} wrong, {open} open", wrong.len());
    assert!(wrong.is_empty(), "{} of {all}: {:#?}", wrong.len(), &wrong[..wrong.len().min(5)]);
    assert!(1000 * open <= all, "{open} of {all} are open");
}
