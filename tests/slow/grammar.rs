//! Tries to prove the program wrong about formulas: every function over every operator, with rays along the axes, in the
//! planes of poles and cuts, and from afar. The oracle evaluates the formula as it is written. See CONTRIBUTING.md.
//!
//! `cargo test --test slow -- --ignored --nocapture many_random_formulas`

use crate::common::registry;
use crate::falsify::random::{Point, Random, moved};
use crate::falsify::scenes::numbers;
use crate::falsify::setting;
use crate::oracle::curved::Roots;
use crate::oracle::dyadic::Dyadic;
use crate::oracle::fast::Fast;
use crate::oracle::first;
use crate::oracle::formula::{Formula, Sides};
use crate::oracle::number::{Jet, Number};
use crate::oracle::ray::Ray;
use crate::oracle::text::Scene;
use crate::oracle::wide::Wide;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::env;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tabray::query::{Answer, Query, QueryRay, Verdict};
use tabray::scene;

/// The number of rays of each scene.
const RAYS: usize = 16;

/// The numbers of pieces into which a ray is cut at most, in `f64` and in 320 bits, for most rays and for some.
const QUICK: [usize; 2] = [1000, 0];
const CAREFUL: [usize; 2] = [1000, 300];

/// Functions of a formula F, and perhaps of two others, A and B.
const FUNCTIONS: &str = "\
    F; sin(F); cos(F); tan(F); asin(F); acos(F); atan(F); exp(F); ln(F); sqrt(F); abs(F); floor(F); ceil(F); \
    round(F); trunc(F); fract(F); cbrt(F); log(F); log2(F); log10(F); sinh(F); cosh(F); tanh(F); asinh(F); \
    acosh(F); atanh(F); heaviside(F); sign(F); atan2(F, B); atan2(B, F); atan2(F, A); hypot(F, B); min(F, B); \
    max(F, A, B); mod(F, 0.7); mod(B, F); step(F, B); step(0.3, F); clamp(F, -0.5, 0.7); clamp(B, -1, F); \
    mix(F, B, 0.3); mix(A, B, F); smoothstep(-1, 1, F); smin(F, B, 0.5); smax(F, A, 0.4); if(F < B, F, A); \
    if(B >= 0.2, F, A); if(F > 0, B, A*B); if(x <= F, sqrt(F), ln(B)); F^0.5; F^1.5; F^-0.5";

/// What stands below a function.
const OPERATORS: &str = "\
    A; A + B; A - B; A*B; A/B; 1/A; A^2; A^3; A^-1; A^-2; A^-3; A/B/A; A/(B/A); -A; A*B/A; (A^2 - B^2)/(A - B); \
    A - 1/B; A/B + B/A; 1/(1/A); A/(A^2 + B^2); A/abs(B); sqrt(A)*B; A^2/B^2; A/sqrt(B)";

/// How a function is used; G is the formula so far.
const AROUND: &str = "\
    G; G; G; G - A; G + B; A - G; B*G; G/B; A/G; G^2 - A; G*G - B; 1/G; G*sqrt(A); sqrt(G); abs(G) - B; \
    G + A/B";

const LEAVES: &str = "\
    x; y; z; x; y; z; x; y; z; x - z; x + y/2; 2*y; z - 0.5; 1 - x; x*y; x^2 + z^2; x^2 + y^2 + z^2; \
    y + 1.5; 0.3*x - y; z/2; y^2; -x; x*z + 1; x - 2*y + z";

const CONSTANTS: &str = "\
    0; 1; 0.5; -1; 0.25; 1.5707963267948966; 3.141592653589793; 2; -0.5; 0.3; -2; 0.1";

fn items(list: &str) -> Vec<&str> {
    list.split("; ").collect()
}

fn one_of<'l>(random: &mut Random, list: &'l str) -> &'l str {
    let items = items(list);
    items[random.below(items.len() as u64) as usize]
}

/// Puts formulas in the places of capital letters.
fn filled(random: &mut Random, pattern: &str, inner: &str) -> String {
    let [a, b] = [0; 2].map(|_| one_of(random, LEAVES));
    let mut text = String::new();
    for letter in pattern.chars() {
        match letter {
            'A' => write!(text, "({a})").expect("room"),
            'B' => write!(text, "({b})").expect("room"),
            'F' | 'G' => write!(text, "({inner})").expect("room"),
            _ => text.push(letter),
        }
    }
    text
}

/// A formula, its pair of function and operator, and a point at which it may be 0.
struct Subject {
    formula: String,
    pair: String,
    near: Point,
}

fn subject(random: &mut Random, number: u64, half: f64) -> Subject {
    let (functions, operators) = (items(FUNCTIONS), items(OPERATORS));
    let pair = number as usize % (functions.len() * operators.len());
    let (function, operator) = (functions[pair % functions.len()], operators[pair / functions.len()]);
    let inner = filled(random, operator, "");
    let mut formula = filled(random, function, &inner);
    for _ in 0..random.below(3) {
        let patterns = if random.once_in(4) { FUNCTIONS } else { AROUND };
        let pattern = one_of(random, patterns);
        formula = filled(random, pattern, &formula);
    }
    let near = [0; 3].map(|_| (1000.0 * random.between(-half, half)).round() / 1000.0);
    let at = near.map(|at| Jet::constant(Fast::exact(&Dyadic::from(at))));
    let there = Formula::read(&formula).on(at.each_ref(), &mut Sides::default());
    let value = there.map_or(f64::NAN, |there| there.jet.value.low);
    if value.abs() < 1e6 && !random.once_in(4) {
        let digits = 10_f64.powf(random.whole(1, 6));
        formula = format!("{formula} - {:?}", (value * digits).round() / digits).replace("- -", "+ ");
    } else {
        formula = format!("{formula} - {}", one_of(random, CONSTANTS)).replace("- -", "+ ");
    }
    Subject { formula, pair: format!("{function} over {operator}"), near }
}

/// Returns a ray whose origin and direction are exact as they are.
fn ray(random: &mut Random, near: Point, half: f64) -> [Point; 2] {
    let small = |random: &mut Random| [0; 3].map(|_| 0.5 * random.whole(-5, 5));
    let from_to = |from: Point, to: Point| [from, [0, 1, 2].map(|axis| to[axis] - from[axis])];
    match random.below(9) {
        0 | 1 => {
            let from = moved(near, random.between(3.0, 8.0) * half, random.direction());
            from_to(from, near)
        }
        2 => {
            let to = [0; 3].map(|_| random.between(-half, half));
            from_to(moved(to, random.between(0.5, 8.0) * half, random.direction()), to)
        }
        // Along an axis.
        kind @ (3 | 4) => {
            let at = if kind == 3 { near } else { small(random) };
            let (mut from, mut dir, axis) = (at, [0.0; 3], random.below(3) as usize);
            let sign = random.sign();
            from[axis] = -sign * (half + random.whole(1, 4));
            dir[axis] = sign * if random.once_in(2) { 1.0 } else { random.power(-2.0, 2.0) };
            [from, dir]
        }
        // Through points where formulas are 0/0.
        5 => {
            let (from, to) = (small(random).map(|at| 4.0 * at), small(random));
            if from == to { from_to([-4.0; 3], [0.0, 0.5, 0.0]) } else { from_to(from, to) }
        }
        // In a plane through the origin.
        6 => {
            let (mut from, mut to) = (moved(near, 6.0, random.direction()), near);
            let axis = random.below(3) as usize;
            (from[axis], to[axis]) = (0.0, 0.0);
            from_to(from, to)
        }
        7 => from_to(moved(near, random.power(1.0, 7.0), random.direction()), near),
        _ => [[0; 3].map(|_| random.between(-half, half)), random.direction()],
    }
}

/// A scene with a fault, whose first line tells the ray, what is right, and what the program says.
struct Kept {
    kind: &'static str,
    pair: String,
    text: String,
}

/// What is found in a run.
#[derive(Default)]
struct Tally {
    scenes: usize,
    refused: usize,
    rays: usize,
    hits: usize,
    misses: usize,
    /// Rays that the oracle decides and the program does not.
    undecided: usize,
    /// Rays that the oracle leaves open somewhere.
    open: usize,
    /// Rays about which the tracer is wrong, and not the proof.
    traced: usize,
    /// The number of rays of each kind of fault.
    wrong: BTreeMap<&'static str, usize>,
    /// A scene of each kind of fault for each pair of function and operator.
    kept: Vec<Kept>,
}

impl Tally {
    fn keep(&mut self, kind: &'static str, pair: &str, text: impl FnOnce() -> String) {
        const MAX_KEPT: usize = 400;
        let is_new = !self.kept.iter().any(|kept| (kept.kind, &*kept.pair) == (kind, pair));
        if is_new && self.kept.len() < MAX_KEPT {
            self.kept.push(Kept { kind, pair: pair.to_owned(), text: text() });
        }
    }

    fn merged(mut self, other: Self) -> Self {
        for (mine, its) in [
            (&mut self.scenes, other.scenes),
            (&mut self.refused, other.refused),
            (&mut self.rays, other.rays),
            (&mut self.hits, other.hits),
            (&mut self.misses, other.misses),
            (&mut self.undecided, other.undecided),
            (&mut self.open, other.open),
            (&mut self.traced, other.traced),
        ] {
            *mine += its;
        }
        for (kind, count) in other.wrong {
            *self.wrong.entry(kind).or_default() += count;
        }
        for Kept { kind, pair, text } in other.kept {
            self.keep(kind, &pair, || text);
        }
        self
    }
}

/// Asks about the rays of a random scene: a surface by a formula, or a copy of one.
fn ask(seed: u64, number: u64) -> Tally {
    let (random, mut tally) = (&mut Random::new("grammar", seed << 40 | number), Tally::default());
    let half = [2.0, 2.0, 1.5, 1.0][random.below(4) as usize];
    let Subject { formula, pair, near } = subject(random, number, half);
    let around = if random.once_in(4) {
        let [scale, turn, to] = [0; 3].map(|_| [0; 3].map(|_| 0.125 * random.whole(4, 12)));
        let turn = if random.once_in(2) { [0.0; 3] } else { turn.map(|angle| 80.0 * angle - 60.0) };
        let [scale, turn, to] = [scale, turn, to].map(numbers);
        format!("place p {{ object f scale {scale} rotation {turn} translation {to} }}\n")
    } else {
        String::new()
    };
    let size = numbers([-half, -half, -half, half, half, half]);
    let text = format!(
        "look_at eye {{ pixeldim 64 48  position 3 2 4  target 0 0 0  angle 45 }}\n\
         material m {{ ambient 1 1 1 }}\n\
         implicit f {{ material m  formula \"{formula}\"  box {size} }}\n{around}"
    );
    let told = |[from, dir]: &[Point; 2], first: &Option<Wide>, said: String| {
        let (from, dir, right) = (numbers(*from), numbers(*dir), spelt(first));
        format!("# {from} {dir}: {right}; the program: {said}; {pair}\n{text}")
    };
    let rays: Vec<_> = (0..RAYS).map(|_| ray(random, near, half)).collect();
    tally.scenes += 1;
    let scene = Scene::read(&text, "");
    let truth = |[from, dir]: &[Point; 2], most: [usize; 2]| {
        first::roots(&scene.objects[0], &Ray::as_is(&scene, *from, *dir), most)
    };
    let loaded = match scene::read(registry(), "scene", Path::new(""), text.as_bytes(), None) {
        Ok(loaded) => loaded,
        Err(report) => {
            // What is refused as nowhere 0 has no hits.
            tally.refused += 1;
            let report = report.to_string();
            for ray in rays.iter().filter(|_| report.contains("nowhere")) {
                let first = truth(ray, QUICK).first;
                if first.is_some() {
                    *tally.wrong.entry("refused").or_default() += 1;
                    tally.keep("refused", &pair, || told(ray, &first, report.lines().take(1).collect()));
                }
            }
            return tally;
        }
    };
    let query = Query::new(&loaded.model);
    for ray in &rays {
        let [from, dir] = ray.map(DVec3::from);
        let Some(exact) = QueryRay::new(from, dir) else { continue };
        let exact = std::slice::from_ref(&exact);
        let answer = query.proven(exact, false)[0];
        tally.rays += 1;
        let roots = truth(ray, if tally.rays == 1 { CAREFUL } else { QUICK });
        let is_known = roots.open.is_empty();
        tally.open += usize::from(!is_known);
        match answer.verdict {
            Verdict::Hit => tally.hits += 1,
            Verdict::Miss => tally.misses += 1,
            _ => tally.undecided += usize::from(is_known),
        }
        let said = |of: &Answer| {
            let Answer { verdict, proof, bounds, .. } = of;
            format!("{verdict:?} by {proof:?} in [{:?}, {:?}]", bounds.low, bounds.high)
        };
        if let Some(kind) = fault(&scene, ray, &answer, &roots) {
            *tally.wrong.entry(kind).or_default() += 1;
            tally.keep(kind, &pair, || told(ray, &roots.first, said(&answer)));
        } else if is_known {
            let traced = query.traced(exact)[0];
            let is_right = match (&roots.first, traced.verdict) {
                (None, Verdict::Miss) => true,
                (Some(first), Verdict::Hit) => {
                    (first.near() - traced.t).abs() < 1e-6 * (1.0 + traced.t.abs())
                }
                _ => false,
            };
            if !is_right {
                tally.traced += 1;
                let said =
                    || format!("{:?} traced at {:?}, and proven {}", traced.verdict, traced.t, said(&answer));
                tally.keep("traced", &pair, || told(ray, &roots.first, said()));
            }
        }
    }
    tally
}

fn spelt(first: &Option<Wide>) -> String {
    first.as_ref().map_or("no hit is certain".to_owned(), |at| format!("a hit at t = {:?}", at.near()))
}

/// Returns the kind of fault of an answer, if it has one.
fn fault(
    scene: &Scene,
    [from, dir]: &[Point; 2],
    answer: &Answer,
    roots: &Roots<Wide>,
) -> Option<&'static str> {
    let is_below = |one: &Wide, other: &Wide| one.high().sub(&other.low()).is_negative();
    let (low, high) = (answer.bounds.low, answer.bounds.high);
    match answer.verdict {
        Verdict::Miss => roots.first.as_ref().map(|_| "miss"),
        Verdict::Hit => {
            let claim = Wide::f64(low).hull(&Wide::f64(high));
            let meets = |of: &Wide| !is_below(&claim, of) && !is_below(of, &claim);
            let is_open = roots.open.iter().any(|[low, high]| meets(&low.hull(high)));
            if !is_open && !roots.first.as_ref().is_some_and(meets) {
                return Some("hit");
            }
            // A place of few digits in the bounds, at which the formula is not defined.
            let even = (low * 1024.0).round() / 1024.0;
            let is_in = is_open && low <= even && even <= high;
            let ray = Ray::as_is(scene, *from, *dir);
            (is_in && first::is_undefined(&scene.objects[0], &ray, even)).then_some("undefined")
        }
        // What is known up to a place holds.
        _ => {
            let is_before = |first: &Wide| low.is_finite() && is_below(first, &Wide::f64(low));
            roots.first.as_ref().is_some_and(is_before).then_some("late")
        }
    }
}

/// Asks about at least so many rays, in scenes from a number on; the environment may change both.
fn run(first: f64, rays: f64) {
    let (rays, seed) = (setting("GRAMMAR_RAYS", rays) as u64, setting("GRAMMAR_SEED", 0.0) as u64);
    let first = setting("GRAMMAR_FIRST", first) as u64;
    let scenes = first..first + rays.div_ceil(RAYS as u64);
    let tally = scenes.into_par_iter().map(|number| ask(seed, number)).reduce(Tally::default, Tally::merged);
    let Tally { scenes, refused, rays, hits, misses, undecided, open, traced, wrong, kept } = &tally;
    println!(
        "{rays} rays in {scenes} scenes, {refused} of them refused: {hits} hits and {misses} misses are proven, \
         {undecided} that the oracle decides are not, and it leaves {open} open; {traced} traced wrong; wrong: {wrong:?}"
    );
    if let Ok(folder) = env::var("GRAMMAR_KEEP") {
        fs::create_dir_all(&folder).expect("room for a folder");
        for (index, Kept { kind, text, .. }) in kept.iter().enumerate() {
            fs::write(Path::new(&folder).join(format!("{kind}-{index}.ray")), text).expect("room for a file");
        }
    }
    let worst = kept.iter().find(|kept| wrong.contains_key(kept.kind)).map_or("", |kept| &kept.text);
    assert!(wrong.is_empty(), "{wrong:?}, such as\n{worst}");
}

#[test]
fn proofs_about_a_few_random_formulas_are_right() {
    run(16.0, 512.0);
}

#[test]
#[ignore = "takes minutes"]
fn proofs_about_many_random_formulas_are_right() {
    run(0.0, 1e6);
}
