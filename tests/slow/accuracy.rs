//! Measures the errors and the cost of each method, and writes `docs/data/accuracy.txt`.
//!
//! `cargo test --profile dist --test slow -- --ignored --nocapture accuracy`
#![allow(clippy::approx_constant, reason = "the notes' vase is 6.28 high")]

use crate::common;
use crate::oracle::hard::{self, KINDS, SETS};
use crate::oracle::rays::{self, BASE, Random};
use crate::oracle::revolution::Revolution;
use crate::oracle::tally::{Tally, Tolerance};
use crate::oracle::{Crossings, Surface, Truth};
use glam::{DVec3, dvec3};
use std::fmt::Write;
use std::hint::black_box;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use tabray::exact::Formula;
use tabray::geometry::{MISS, Ray, RayRange};
use tabray::world::{AnyShape, Facts, Hittable};

/// The number of rays of each kind for each profile.
const RAYS: usize = 1_000_000;

/// The number of rays for each distance from a sphere and from a plane.
const FAR_RAYS: usize = 100_000;

/// The number of random shapes of a kind for each set of rays, and the number of rays for each of them.
const HARD_SHAPES: usize = 7_000;
const HARD_RAYS: usize = 50;

/// The number of times that each method is timed; the minimum counts.
const ROUNDS: usize = 5;

/// The number of rays that are traced between two readings of the clock.
const ROUND: usize = 20_000;

const COMMAND: &str = "cargo test --profile dist --test slow -- --ignored --nocapture accuracy";

/// The methods, by their names in a camera's `accuracy`.
const METHODS: [&str; 4] = ["classic", "draft", "exact", "strict"];

/// The method of the notes' page on procedural surfaces: from where a ray enters the surface's heights to where it
/// leaves them, steps of 0.1 world units, then bisection to 1e-6.
struct Steps {
    profile: Formula,
    height: f64,
}

impl Hittable for Steps {
    fn distance(&self, ray: &Ray, within: &RayRange) -> f64 {
        let origin = ray.origin - BASE;
        let outside = |t: f64| {
            let at = origin + t * ray.dir;
            let radius = self.profile.at(at.y);
            at.x * at.x - radius * radius + at.z * at.z
        };
        let (one, other) = (-origin.y / ray.dir.y, (self.height - origin.y) / ray.dir.y);
        let (mut near, far) = (one.min(other).max(0.0), one.max(other).min(100.0));
        let mut at_near = outside(near);
        while near < far {
            let next = (near + 0.1).min(far);
            let at_next = outside(next);
            if (at_near < 0.0) != (at_next < 0.0) {
                let mut far = next;
                while far - near > 1e-6 {
                    let middle = 0.5 * (near + far);
                    if (at_near < 0.0) == (outside(middle) < 0.0) { near = middle } else { far = middle }
                }
                return within.keep(0.5 * (near + far));
            }
            (near, at_near) = (next, at_next);
        }
        MISS
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        DVec3::Y
    }

    fn facts(&self) -> Facts {
        Facts::unbounded(0.0)
    }
}

/// A shape whose hits are found by one of the methods.
type Shape = AnyShape;

/// Returns the tolerance for a method. A hit counts as one of another crossing if it is closer to that one and off by
/// more than the method promises.
fn tolerance(method: &str) -> Tolerance {
    let sure = if matches!(method, "steps" | "classic" | "draft") { 1e-2 } else { 1e-9 };
    Tolerance { sure, most: 0.05 }
}

/// Profiles, their heights in world units, and what they are.
const PROFILES: [(&str, f64, &str); 6] = [
    ("2 + sin(y)", 6.28, "the notes' vase"),
    ("1 + 0.3*sin(20*y)", 6.28, "a column with 20 waves"),
    ("-4/6*(y - 6)", 6.0, "the notes' cone"),
    ("0.3 + 2*exp(-(20*(y-3))^2)", 6.28, "a thin disc on a rod"),
    ("0.6 + 0.5*abs(y-3)", 6.28, "a waist with an edge"),
    ("0.5 + 0.25*floor(y)", 6.28, "stairs"),
];

fn shape(method: &str, object: &str) -> Shape {
    let mut model = common::model(&format!(
        "camera eye {{ pixeldim 640 480 worlddim 8 6 viewpoint 4 3 7 accuracy {method} }}
         material m {{ ambient 1 1 1 }}
         {object}"
    ));
    model.objects.remove(0).shape
}

/// Returns the distances of the first hits.
fn trace(shape: &Shape, rays: &[Ray]) -> Vec<f64> {
    rays.iter().map(|ray| shape.distance(black_box(ray), &RayRange::ALL)).collect()
}

/// Returns how long each shape takes for these rays. The shapes alternate, so that other work of the machine affects
/// all of them.
fn times(shapes: &[Shape], rays: &[Ray]) -> Vec<Duration> {
    let mut totals = vec![Duration::ZERO; shapes.len()];
    for rays in rays.chunks(ROUND).take(5) {
        let mut least = vec![Duration::MAX; shapes.len()];
        for _ in 0..ROUNDS {
            for (shape, least) in shapes.iter().zip(&mut least) {
                let start = Instant::now();
                black_box(trace(shape, rays));
                *least = start.elapsed().min(*least);
            }
        }
        for (total, least) in totals.iter_mut().zip(least) {
            *total += least;
        }
    }
    totals
}

fn tally(
    method: &str,
    rays: &[Ray],
    found: &[f64],
    truths: &[Truth],
    next: impl Fn(&Ray, f64) -> Truth,
    off_surface: impl Fn(&Ray, f64) -> f64,
) -> Tally {
    let mut tally = Tally::default();
    for ((ray, found), truth) in rays.iter().zip(found).zip(truths) {
        tally.count(
            *truth,
            *found,
            tolerance(method),
            |near| next(ray, near),
            |found| off_surface(ray, found),
        );
    }
    tally.finish()
}

/// Writes a table with the rows of all profiles for one set of rays.
fn revolution_table(set: &str, text: &mut String) {
    *text += "| profile | method | missed | invented | later | median error | maximum error | off the surface | time |\n";
    *text += "|---|---|---:|---:|---:|---:|---:|---:|---:|\n";
    for (formula, height, name) in PROFILES {
        let surface = Revolution::new(formula, BASE, height);
        let rays: Vec<Ray> = match set {
            "camera" => rays::camera(RAYS, 1.0).collect(),
            _ => rays::grazing(RAYS, 1.0, |random| rays::place_on(&surface, random)).collect(),
        };
        let truth = |ray: &Ray, near: f64| surface.first_hit(ray, near, Crossings::All);
        let truths: Vec<Truth> = rays.iter().map(|ray| truth(ray, 0.0)).collect();
        let place = format!("direction 0 1 0 base 4 0 -4 height {height:?}");
        let profile = Formula::parse(formula).expect("a formula");
        let steps: Shape = Steps { profile, height }.into();
        let object = format!("revsurf r {{ material m profile \"{formula}\" {place} }}");
        let shapes: Vec<_> =
            [steps].into_iter().chain(METHODS.map(|method| shape(method, &object))).collect();
        let methods = ["steps"].iter().chain(&METHODS);
        let times = times(&shapes, &rays);
        let off_surface = |ray: &Ray, distance: f64| {
            let off = surface.off_surface(ray, distance);
            if !formula.contains("floor") {
                return off;
            }
            // The ray may have hit a step, so that the point is close to an integer height.
            let height = surface.height_at(ray, distance);
            off.min((height - height.round()).abs())
        };
        for ((method, shape), time) in methods.zip(&shapes).zip(&times) {
            let found = trace(shape, &rays);
            let tally = tally(method, &rays, &found, &truths, truth, off_surface);
            println!("{name}, {set}, {method}: {tally}");
            let label = if *method == "steps" {
                let undecided = match tally.undecided {
                    0 => String::new(),
                    count => format!(", {count} undecided"),
                };
                format!("{name}: {} hits{undecided}", tally.hits)
            } else {
                String::new()
            };
            let Tally { missed, invented, later, .. } = tally;
            let (median, worst, off) = (tally.median(), tally.worst(), tally.off_surface);
            let ratio = time.as_secs_f64() / times[0].as_secs_f64();
            writeln!(
                text,
                "| {label} | `{method}` | {missed} | {invented} | {later} | {median:.1e} | {worst:.1e} | {off:.1e} | {ratio:.2} |"
            )
            .expect("text grows");
        }
    }
}

/// Writes a table of a shape's largest error from each distance, in units in the last place.
fn distance_table(object: &str, text: &mut String) {
    let surface = Surface::read(object);
    let truth = |ray: &Ray, near: f64| surface.first_hit(ray, near);
    *text += "| from |";
    for method in METHODS {
        write!(text, " `{method}` wrong | ulp |").expect("text grows");
    }
    *text += &format!("\n|---|{}\n", "---:|---:|".repeat(METHODS.len()));
    let shapes = METHODS.map(|method| shape(method, object));
    for exponent in 1..=9 {
        let distance = 10_f64.powi(exponent);
        let rays: Vec<Ray> = rays::aimed(FAR_RAYS, MIDDLE, 3.0, distance).collect();
        let truths: Vec<Truth> = rays.iter().map(|ray| truth(ray, 0.0)).collect();
        write!(text, "| 10^{exponent} |").expect("text grows");
        for (method, shape) in METHODS.iter().zip(&shapes) {
            let found = trace(shape, &rays);
            let tally = tally(method, &rays, &found, &truths, truth, |_, _| f64::INFINITY);
            println!("{object}, from {distance:e}, {method}: {tally}");
            write!(text, " {} | {} |", tally.wrong(), short(tally.ulps)).expect("text grows");
        }
        *text += "\n";
    }
}

/// Writes a table of random shapes with a formula for their hits, and of rays that are hard for them.
fn hard_table(text: &mut String) {
    *text += "| shape | rays | hits | ties |";
    for method in METHODS {
        write!(text, " `{method}` wrong | ulp |").expect("text grows");
    }
    *text += &format!("\n|---|---|---:|---:|{}\n", "---:|---:|".repeat(METHODS.len()));
    for kind in KINDS {
        for set in SETS {
            let mut random = Random::new(23);
            let mut tallies = METHODS.map(|_| Tally::default());
            for _ in 0..HARD_SHAPES {
                let subject = hard::subject(kind, &mut random);
                let shapes = METHODS.map(|method| shape(method, &subject.text));
                for _ in 0..HARD_RAYS {
                    let ray = subject.ray(set, &mut random);
                    let truth = subject.truth(&ray, 0.0);
                    for (tally, shape) in tallies.iter_mut().zip(&shapes) {
                        subject.count(tally, &**shape, &ray, truth);
                    }
                }
            }
            write!(text, "| {kind} | {set} | {} | {} |", tallies[0].hits, tallies[0].undecided)
                .expect("text grows");
            for (method, tally) in METHODS.iter().zip(&tallies) {
                println!("{kind}, {set}, {method}: {tally}");
                write!(text, " {} | {} |", tally.wrong(), short(tally.ulps)).expect("text grows");
            }
            *text += "\n";
        }
    }
}

/// Writes a number with one decimal place, in scientific notation from 100 on.
fn short(number: f64) -> String {
    if number < 100.0 { format!("{number:.1}") } else { format!("{number:.1e}") }
}

const MIDDLE: DVec3 = dvec3(4.0, 3.0, -4.0);

/// A lock: the two parts of the document are measured and written one after the other, and either can be measured
/// alone.
static PART: Mutex<()> = Mutex::new(());

/// The heading at which the second part of the document begins.
const SECOND_PART: &str = "## Shapes with a formula\n";

/// Replaces one of the two parts of the document.
fn write_part(change: impl FnOnce(&str, &str) -> String) {
    let path = common::root().join("docs/data/accuracy.txt");
    let text = std::fs::read_to_string(&path).expect("the document is there");
    let (first, second) = text.split_once(SECOND_PART).unwrap_or((&text, ""));
    std::fs::write(&path, change(first, second)).expect("the folder of the documents is there");
    println!("wrote {}", path.display());
}

#[test]
#[ignore = "runs for many minutes; its numbers are a document"]
fn hard_rays_are_measured() {
    let _alone = PART.lock();
    let rays = HARD_SHAPES * HARD_RAYS;
    let mut table = format!(
        "
{rays} rays of each set for each kind of shape, {HARD_RAYS} for each of {HARD_SHAPES} random ones, against whole numbers. Far
rays come from up to 1e9 away; grazing rays pass an outline or an edge at 1e-2 to 1e-15. Ties touch a shape or an edge.

"
    );
    hard_table(&mut table);
    write_part(|first, _| format!("{}\n\n{SECOND_PART}{table}", first.trim_end()));
}

#[test]
#[ignore = "runs for many minutes; its numbers are a document"]
fn the_accuracy_of_each_method_is_measured() {
    let _alone = PART.lock();
    let mut text = format!(
        "{COMMAND}

missed, invented, later, wrong: hits that are not the first. Errors are those of the distances of all other hits, in world
units; ulp: the greatest of them, in units in the last place; off the surface: the greatest distance of hits from it; time:
of a ray, relative to `steps`.

## Surfaces of revolution

### Camera rays

{RAYS} rays for each profile.

"
    );
    revolution_table("camera", &mut text);
    write!(
        text,
        "
### Grazing rays

{RAYS} tangents for each profile, up to an offset of 10^-2 to 10^-12.

"
    )
    .expect("text grows");
    revolution_table("grazing", &mut text);
    write!(
        text,
        "
## Spheres and planes from afar

{FAR_RAYS} rays from each distance.

### A sphere of radius 2

"
    )
    .expect("text grows");
    distance_table("sphere s { material m center 4 3 -4 radius 2 }", &mut text);
    text += "\n### A plane\n\n";
    distance_table("plane p { material m normal 0.3 1 0.5 point 4 3 -4 }", &mut text);
    write_part(|_, second| format!("{text}\n{SECOND_PART}{second}"));
}
