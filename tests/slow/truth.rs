//! The program's hits compared with the true ones, to the last digits of the program's numbers.
#![allow(clippy::approx_constant, reason = "the notes' vase is 6.28 high")]

use crate::common::model;
use crate::oracle::rays::{self, BASE, Random};
use crate::oracle::revolution::Revolution;
use crate::oracle::tally::{Tally, Tolerance, ulp};
use crate::oracle::{Crossings, Surface, Truth, fplane_text, spelt};
use glam::{DMat3, DVec3, dvec2, dvec3};
use hashbrown::HashMap;
use std::cell::RefCell;
use tabray::exact::{Float, Wide};
use tabray::geometry::{MISS, Ray, RayRange, Side, Sight};
use tabray::scene::Model;
use tabray::world::certify::{self, Enclosure, Precision};

/// The number of rays of each set.
const RAYS: usize = 10_000;

/// The number of rays of the sets that matter most.
const MANY_RAYS: usize = 20_000;

/// The tolerance for the notes' methods, which stop at 1e-4 world units.
const ROUGHLY: Tolerance = Tolerance { sure: 1e-3, most: 0.05 };

/// Returns the model of a scene with one object.
fn scene(accuracy: &str, object: &str) -> Model {
    model(&format!(
        "camera eye {{ pixeldim 640 480 worlddim 8 6 viewpoint 4 3 7 accuracy {accuracy} }}
         material m {{ ambient 1 1 1 }}
         {object}"
    ))
}

/// Returns the distance of the object's first hit.
fn distance(model: &Model, ray: &Ray) -> f64 {
    model.objects[0].shape.distance(ray, &RayRange::ALL)
}

/// A shape, and the truth that its hits are compared with.
struct Subject<'s> {
    /// The shape's name in messages.
    name: &'s str,
    model: &'s Model,
    /// The factor by which its scene is larger than that of the notes.
    scale: f64,
    /// The error above which a hit counts as one of another crossing, in world units of a scene of the notes' size.
    most: f64,
    /// Returns the first hit of a ray beyond a distance.
    truth: &'s dyn Fn(&Ray, f64) -> Truth,
    /// Returns how far the point at a distance along a ray is from the surface.
    off_surface: &'s dyn Fn(&Ray, f64) -> f64,
}

impl Subject<'_> {
    fn tally(&self, rays: impl Iterator<Item = Ray>, tolerance: Tolerance) -> Tally {
        let mut tally = Tally::default();
        for ray in rays {
            let found = distance(self.model, &ray);
            let next = |near: f64| (self.truth)(&ray, near);
            tally.count((self.truth)(&ray, 0.0), found, tolerance, next, |found| {
                (self.off_surface)(&ray, found)
            });
        }
        tally.finish()
    }

    /// Returns the faults of a set of rays: hits that are missed, invented or not the first; more than one and
    /// 1 of 1000 rays without a truth; hits more than `off_surface` world units away from the surface; distances off by
    /// more than `ulps` units in the last place.
    fn faults(&self, set: &str, rays: &[Ray], off_surface: f64, ulps: f64) -> Vec<String> {
        // No crossing is taken for another one, however close to each other they are.
        let tolerance = Tolerance { sure: 1e-9 * self.scale, most: self.most * self.scale };
        let tally = self.tally(rays.iter().copied(), tolerance);
        let name = format!("{}, {set} x {:e}", self.name, self.scale);
        println!("{name}: {tally}");
        let mut faults = Vec::new();
        if let Some((index, truth, found)) = tally.first_wrong {
            faults.push(format!("wrong: {name}: {tally}\n  {:?}: {truth:?}, not {found:?}", rays[index]));
        }
        if tally.undecided > 1 + tally.rays / 1000 || tally.off_surface > off_surface || tally.ulps > ulps {
            faults.push(format!("inexact: {name}: {tally}"));
        }
        faults
    }
}

/// Returns the unit in the last place of the greatest distance of the rays' origins from a point.
fn rounding(rays: &[Ray], from: DVec3) -> f64 {
    rays.iter().map(|ray| ulp((ray.origin - from).length())).fold(0.0, f64::max)
}

#[track_caller]
fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

// Surfaces of revolution

/// Returns a formula for a scene that is `scale` times as large.
fn scaled(formula: &str, scale: f64) -> String {
    if scale == 1.0 {
        formula.to_owned()
    } else {
        format!("{scale:?}*({})", formula.replace('y', &format!("(y/{scale:?})")))
    }
}

/// Returns the surface of revolution of a formula in a scene of this scale: its text and its truth.
fn revsurf(formula: &str, height: f64, scale: f64) -> (String, Revolution) {
    let (formula, base, height) = (scaled(formula, scale), scale * BASE, scale * height);
    let place = format!("direction 0 1 0 base {} height {height:?}", spelt(base));
    let text = format!("revsurf r {{ material m profile \"{formula}\" {place} }}");
    (text, Revolution::new(&formula, base, height))
}

/// Returns the truth of the surface of revolution of a formula, and a model of the same surface.
fn revolution(accuracy: &str, formula: &str, height: f64, scale: f64) -> (Revolution, Model) {
    let (text, surface) = revsurf(formula, height, scale);
    (surface, scene(accuracy, &text))
}

/// Checks that all sets of rays find the true hits of a formula's surface.
#[track_caller]
fn finds_the_revolution(name: &str, formula: &str, height: f64) {
    let mut faults = Vec::new();
    for scale in [1.0, 1e-3, 1e6] {
        let (surface, model) = revolution("exact", formula, height, scale);
        let off_surface = |ray: &Ray, distance: f64| {
            let off = surface.off_surface(ray, distance);
            if !formula.contains("floor") {
                return off;
            }
            // The ray may have hit a step, so that the point is close to an integer height.
            let step = surface.height_at(ray, distance) / scale;
            off.min(scale * (step - step.round()).abs())
        };
        let subject = Subject {
            name,
            model: &model,
            scale,
            most: 1e-5,
            truth: &|ray, near| surface.first_hit(ray, near, Crossings::All),
            off_surface: &off_surface,
        };
        let middle = scale * (BASE + dvec3(0.0, height / 2.0, 0.0));
        let reach = surface.radius().hypot(scale * height / 2.0);
        let mut check = |set: &str, rays: &mut dyn Iterator<Item = Ray>| {
            let rays: Vec<Ray> = rays.collect();
            let off_surface = 1e-14 * scale + rounding(&rays, middle);
            faults.extend(subject.faults(set, &rays, off_surface, f64::INFINITY));
        };
        // The truth takes 0.1 ms: at the notes' scale, a surface is tested with as many rays as the time allows here.
        // `tests/slow/accuracy.rs` traces a million.
        let (many, few) = if scale == 1.0 { (MANY_RAYS, RAYS / 2) } else { (RAYS / 4, RAYS / 4) };
        check("camera", &mut rays::camera(many, scale));
        check("grazing", &mut rays::grazing(many, scale, |random| rays::place_on(&surface, random)));
        check("inside", &mut rays::inside(few, middle, reach));
        check("far 1e4", &mut rays::aimed(few, middle, reach, scale * 1e4));
        check("far 1e7", &mut rays::aimed(few, middle, reach, scale * 1e7));
    }
    assert_none(&faults);
}

/// Profiles, and the heights of their surfaces in world units.
const VASE: (&str, f64) = ("2 + sin(y)", 6.28);
const NASTY: (&str, f64) = ("1 + 0.3*sin(20*y)", 6.28);
const CONE: (&str, f64) = ("-4/6*(y - 6)", 6.0);
const FLANGE: (&str, f64) = ("0.3 + 2*exp(-(20*(y-3))^2)", 6.28);
const KINK: (&str, f64) = ("0.6 + 0.5*abs(y-3)", 6.28);
const TUBE: (&str, f64) = ("1.5", 6.0);
const JUMP: (&str, f64) = ("0.5 + 0.25*floor(y)", 6.28);

#[test]
fn a_vase_is_found() {
    finds_the_revolution("vase", VASE.0, VASE.1);
}

#[test]
fn a_wavy_column_is_found() {
    finds_the_revolution("nasty", NASTY.0, NASTY.1);
}

#[test]
fn a_cone_is_found() {
    finds_the_revolution("cone", CONE.0, CONE.1);
}

#[test]
fn a_thin_disc_is_found() {
    finds_the_revolution("flange", FLANGE.0, FLANGE.1);
}

#[test]
fn a_waist_with_an_edge_is_found() {
    finds_the_revolution("kink", KINK.0, KINK.1);
}

#[test]
fn stairs_are_found() {
    finds_the_revolution("jump", JUMP.0, JUMP.1);
}

#[test]
fn a_tube_is_found() {
    finds_the_revolution("tube", TUBE.0, TUBE.1);
}

/// Checks thin discs, truncated poles, roots and waves: all rays find what is there and nothing else.
#[test]
fn profiles_that_hide_in_thin_parts_are_found() {
    let mut faults = Vec::new();
    for (formula, height) in [
        ("max(0.3 - y, 2 - 1e14*(y-3.1)^2)", 6.0),
        ("max(0.2, 2 - 1e8*(y-3.1)^2)", 6.0),
        ("min(2, 1/abs(y-3))", 6.0),
        ("max(0.2, ln(y))", 6.0),
        ("y^y/10", 3.0),
        ("0.5 + sin(9*y)", 6.0),
        ("abs(y-3)^0.5 + 0.1", 6.0),
        ("y^2 - 6*y + 9", 6.0),
        ("2 - 1e3*abs(y-2)", 4.0),
    ] {
        let (surface, model) = revolution("exact", formula, height, 1.0);
        let subject = Subject {
            name: formula,
            model: &model,
            scale: 1.0,
            most: 1e-5,
            truth: &|ray, near| surface.first_hit(ray, near, Crossings::All),
            off_surface: &|ray, distance| surface.off_surface(ray, distance),
        };
        let middle = BASE + dvec3(0.0, height / 2.0, 0.0);
        let reach = 2.0_f64.hypot(height / 2.0);
        for (set, rays) in [
            ("camera", rays::camera(500, 1.0).collect::<Vec<Ray>>()),
            ("inside", rays::inside(250, middle, reach).collect()),
            ("far 1e4", rays::aimed(250, middle, reach, 1e4).collect()),
        ] {
            faults.extend(subject.faults(set, &rays, 1e-13 + rounding(&rays, middle), f64::INFINITY));
        }
    }
    assert_none(&faults);
}

/// Checks the truth itself: the function changes its sign at the hit, and not before it.
#[test]
fn the_truth_of_a_revolution_is_where_the_function_first_changes_its_sign() {
    for (formula, height) in [VASE, NASTY, CONE, FLANGE, KINK, TUBE, JUMP] {
        let surface = Revolution::new(formula, BASE, height);
        let line = tabray::exact::Formula::parse(formula).expect("a formula");
        for ray in rays::camera(500, 1.0).chain(rays::inside(500, BASE + dvec3(0.0, 3.0, 0.0), 4.0)) {
            let outside = |t: f64| {
                let at = ray.at(t) - BASE;
                let radius = line.at(at.y);
                let there = (0.0..=height).contains(&at.y) && radius >= 0.0;
                there.then_some(at.x * at.x + at.z * at.z > radius * radius)
            };
            let end = match surface.first_hit(&ray, 0.0, Crossings::All) {
                Truth::Hit(hit) => {
                    let t = hit.t.high;
                    let (before, after) = (outside(t - 1e-9), outside(t + 1e-9));
                    assert!(before != after, "{formula}: {ray:?}, {hit:?}");
                    t - 1e-9
                }
                Truth::Miss => 30.0,
                Truth::Undecided => panic!("{formula}: {ray:?}"),
            };
            let steps = 5_000;
            let mut last = None;
            for t in (1..steps).map(|step| end * f64::from(step) / f64::from(steps)) {
                let now = outside(t);
                assert!(last.is_none() || now.is_none() || now == last, "{formula}: {ray:?} at {t}");
                last = now;
            }
        }
    }
}

/// A cone is both a surface of revolution and a quadric.
#[test]
fn two_truths_of_a_cone_agree() {
    let surface = Revolution::new(CONE.0, BASE, CONE.1);
    let quadric = Surface::read(&format!(
        "quadric q {{ material m coefficients 9 -4 9 0 0 0 0 0 0 0 center {} box -9 -6 -9 9 0 9 }}",
        spelt(BASE + dvec3(0.0, 6.0, 0.0))
    ));
    let grazing = rays::grazing(RAYS, 1.0, |random| rays::place_on(&surface, random));
    for ray in rays::camera(RAYS, 1.0).chain(grazing) {
        let (one, other) = (surface.first_hit(&ray, 0.0, Crossings::All), quadric.first_hit(&ray, 0.0));
        match (one, other) {
            (Truth::Hit(one), Truth::Hit(other)) => {
                let apart = (one.t - other.t).high.abs();
                assert!(apart * one.slope.abs() < 1e-25, "{ray:?}: {one:?} {other:?}");
            }
            (Truth::Undecided, _) | (_, Truth::Undecided) => {}
            (one, other) => assert_eq!(one, other, "{ray:?}"),
        }
    }
}

/// The notes' method finds the hits away from the silhouette, with errors near the 1e-4 at which it stops.
#[test]
fn the_notes_method_finds_the_vase_but_for_its_silhouette() {
    let (surface, model) = revolution("classic", VASE.0, VASE.1, 1.0);
    let subject = Subject {
        name: "vase, classic",
        model: &model,
        scale: 1.0,
        most: ROUGHLY.most,
        truth: &|ray, near| surface.first_hit(ray, near, Crossings::All),
        off_surface: &|ray, distance| surface.off_surface(ray, distance),
    };
    let tally = subject.tally(rays::camera(RAYS, 1.0), ROUGHLY);
    println!("vase, classic: {tally}");
    assert!(tally.hits > RAYS / 4, "{tally}");
    assert!(tally.wrong() * 20 < tally.hits, "{tally}");
    assert!(tally.worst() < 1e-3, "{tally}");
}

// Shapes with a formula for their hits

/// The middle of the bounded shapes, and how far they reach from it, in world units.
const MIDDLE: DVec3 = dvec3(4.0, 3.0, -4.0);
const REACH: f64 = 3.0;

/// A shape's text in a scene of some scale, and its truth.
type Spelt = (String, Box<dyn Fn(&Ray, f64) -> Truth>);

/// Returns a shape's text and its truth.
fn with_truth(text: String) -> Spelt {
    let surface = Surface::read(&text);
    (text, Box::new(move |ray, near| surface.first_hit(ray, near)))
}

fn sphere(scale: f64) -> Spelt {
    let (center, radius) = (scale * MIDDLE, scale * 2.0);
    with_truth(format!("sphere s {{ material m center {} radius {radius:?} }}", spelt(center)))
}

fn ellipsoid(scale: f64) -> Spelt {
    let (center, radius, stretch) = (scale * MIDDLE, scale, dvec3(2.0, 0.3, 1.1));
    with_truth(format!(
        "ellipsoid e {{ material m center {} radius {radius:?} scale {} }}",
        spelt(center),
        spelt(stretch)
    ))
}

/// Returns a hyperboloid of one sheet, clipped to a box.
fn quadric(scale: f64) -> Spelt {
    let coefficients = [1.0, -0.5, 1.0, 0.1, 0.2, -0.1, 0.0, 0.0, 0.0, scale * scale];
    let corners = [scale * dvec3(-1.75, -2.0, -1.875), scale * dvec3(1.875, 2.0, 1.75)];
    with_truth(format!(
        "quadric q {{ material m coefficients {} center {} box {} {} }}",
        coefficients.map(|coefficient| format!("{coefficient:?}")).join(" "),
        spelt(scale * MIDDLE),
        spelt(corners[0]),
        spelt(corners[1]),
    ))
}

fn plane(scale: f64) -> Spelt {
    let (normal, point) = (dvec3(0.3, 1.0, 0.5), scale * MIDDLE);
    with_truth(format!("plane p {{ material m normal {} point {} }}", spelt(normal), spelt(point)))
}

fn fplane(scale: f64) -> Spelt {
    let (normal, xdir, dimensions) = (dvec3(0.3, 1.0, 0.5), dvec3(1.0, 0.2, 0.0), scale * dvec2(3.0, 2.5));
    let point = scale * (MIDDLE - dvec3(1.5, 0.0, -1.0));
    with_truth(fplane_text(normal, point, xdir, dimensions))
}

fn triangle(scale: f64) -> Spelt {
    let corners = [dvec3(-2.0, -1.5, 0.5), dvec3(2.0, -1.0, -0.5), dvec3(0.25, 2.0, 0.0)];
    let corners = corners.map(|corner| scale * (MIDDLE + corner));
    let [a, b, c] = corners.map(spelt);
    with_truth(format!("triangle t {{ material m vertex1 {a} vertex2 {b} vertex3 {c} }}"))
}

/// Returns a random point of a shape, and its normal there.
fn place_on(subject: &Subject, random: &mut Random) -> (DVec3, DVec3) {
    loop {
        let origin = subject.scale * (MIDDLE + 9.0 * random.direction());
        let ray = rays::toward(origin, random.in_ball(subject.scale * MIDDLE, subject.scale * REACH));
        if let Some(hit) = (subject.truth)(&ray, 0.0).hit() {
            let at = ray.at(hit.t.high);
            return (at, subject.model.objects[0].shape.normal(at));
        }
    }
}

/// Checks that all sets of rays find the true hits of a shape. Except for grazing rays, the distances of the two
/// methods are right to `exact` and `strict` units in the last place; all hits are as close to the surface as rounding
/// allows.
#[track_caller]
fn finds(name: &str, spelt: fn(f64) -> Spelt, farthest: i32, [exact, strict]: [f64; 2]) {
    let is_flat = matches!(name, "plane" | "fplane" | "triangle");
    let mut faults = Vec::new();
    let methods = [("exact", exact), ("strict", strict)];
    // The truth takes time to compute, and both methods trace the same rays.
    let known = RefCell::new(HashMap::new());
    for (scale, (accuracy, ulps)) in
        [1.0, 1e-3, 1e6].into_iter().flat_map(|scale| methods.map(|m| (scale, m)))
    {
        let (text, truth) = spelt(scale);
        let truth = |ray: &Ray, near: f64| {
            let ([x, y, z], [u, v, w]) = (ray.origin.to_array(), ray.dir.to_array());
            let key = [x, y, z, u, v, w, near, scale].map(f64::to_bits);
            *known.borrow_mut().entry(key).or_insert_with(|| truth(ray, near))
        };
        let model = scene(accuracy, &text);
        let off_surface = |ray: &Ray, found: f64| {
            let slant = model.objects[0].shape.normal(ray.at(found)).dot(ray.dir).abs();
            let hit = truth(ray, 0.0).hit();
            hit.map_or(f64::NAN, |hit| (hit.t - found.into()).high.abs() * slant)
        };
        let name = format!("{name}, {accuracy}");
        let subject = Subject {
            name: &name,
            model: &model,
            scale,
            most: f64::INFINITY,
            truth: &truth,
            off_surface: &off_surface,
        };
        let mut check = |set: &str, ulps: f64, rays: &mut dyn Iterator<Item = Ray>| {
            let rays: Vec<Ray> = rays.collect();
            let off_surface = 4.0 * rounding(&rays, DVec3::ZERO).max(ulp(10.0 * scale));
            faults.extend(subject.faults(set, &rays, off_surface, ulps));
        };
        let (middle, reach) = (scale * MIDDLE, scale * REACH);
        check("camera", ulps, &mut rays::camera(RAYS, scale));
        check("inside", ulps, &mut rays::inside(RAYS, middle, reach));
        for exponent in 1..=farthest {
            let distance = scale * 10_f64.powi(exponent);
            check(&format!("from 1e{exponent}"), ulps, &mut rays::aimed(RAYS, middle, reach, distance));
        }
        if !is_flat {
            let place = |random: &mut Random| place_on(&subject, random);
            check("grazing", f64::INFINITY, &mut rays::grazing(RAYS, scale, place));
        }
    }
    assert_none(&faults);
}

#[test]
fn spheres_are_found() {
    finds("sphere", sphere, 9, [4.0, 1.0]);
}

#[test]
fn ellipsoids_are_found() {
    finds("ellipsoid", ellipsoid, 9, [4.0, 1.0]);
}

#[test]
fn planes_are_found() {
    finds("plane", plane, 9, [4.0, 1.0]);
}

#[test]
fn rectangles_are_found() {
    finds("fplane", fplane, 9, [4.0, 1.0]);
}

#[test]
fn triangles_are_found() {
    finds("triangle", triangle, 6, [4.0, 1.0]);
}

#[test]
fn triangles_are_found_from_afar() {
    finds("triangle", triangle, 9, [4.0, 1.0]);
}

/// A quadric may be met right next to the ray's origin, where a unit in the last place is far below any rounding error.
#[test]
fn quadrics_are_found() {
    finds("quadric", quadric, 9, [f64::INFINITY; 2]);
}

// Scenes that differ only in position and scale

/// Rounds a ray's origin to 20 binary places, so that moving the ray loses no digits.
fn short(ray: &Ray) -> Ray {
    let cut = |number: f64| (number * 2_f64.powi(20)).round() / 2_f64.powi(20);
    Ray { origin: DVec3::from_array(ray.origin.to_array().map(cut)), dir: ray.dir }
}

/// Returns rays toward the shapes.
fn sample() -> impl Iterator<Item = Ray> {
    rays::camera(RAYS, 1.0).chain(rays::aimed(RAYS, MIDDLE, REACH, 10.0)).map(|ray| short(&ray))
}

fn vase(scale: f64) -> Spelt {
    let (text, surface) = revsurf(VASE.0, VASE.1, scale);
    (text, Box::new(move |ray, near| surface.first_hit(ray, near, Crossings::All)))
}

const SHAPES: [fn(f64) -> Spelt; 7] = [sphere, ellipsoid, quadric, plane, fplane, triangle, vase];

#[test]
fn a_scene_twice_as_large_has_its_hits_twice_as_far() {
    for spelt in SHAPES {
        let (text, _) = spelt(1.0);
        let is_cut = text.starts_with("revsurf");
        let model = scene("exact", &text);
        for scale in [0.25, 2.0, 1024.0] {
            let scaled = scene("exact", &spelt(scale).0);
            for ray in sample() {
                let scaled_ray = Ray { origin: scale * ray.origin, ..ray };
                let (one, other) = (distance(&model, &ray), distance(&scaled, &scaled_ray));
                // The distance from the image plane at which planes end does not scale with the scene.
                let in_front = |ray: &Ray, hit: f64| hit != MISS && ray.at(hit).z > 0.0;
                if in_front(&ray, one) || in_front(&scaled_ray, other) {
                    continue;
                }
                // Nor does the subdivision of a surface of revolution, so the last digits of its distances may differ.
                let slack = if is_cut && one != MISS { scale * slack(&model, &ray, one) } else { 0.0 };
                let is_same = scale * one == other || (scale * one - other).abs() <= slack;
                assert!(is_same, "{text} x {scale}: {ray:?}, {one} {other}");
            }
        }
    }
}

/// Returns how far two distances to the same hit may differ, in world units: a few rounding errors of the coordinates
/// along the ray, divided by the cosine of the angle between the ray and the normal.
fn slack(model: &Model, ray: &Ray, hit: f64) -> f64 {
    let slant = model.objects[0].shape.normal(ray.at(hit)).dot(ray.dir).abs();
    let size = ray.origin.abs().max_element() + hit;
    8.0 * ulp(size) / slant
}

/// Checks that two scenes have the same hits, of rays that are moved as the scene is.
#[track_caller]
fn has_the_same_hits(text: &str, moved_text: &str, moved: impl Fn(&Ray) -> Ray) {
    let (model, moved_model) = (scene("exact", text), scene("exact", moved_text));
    for ray in sample() {
        let (one, other) = (distance(&model, &ray), distance(&moved_model, &moved(&ray)));
        if one == MISS || other == MISS {
            assert_eq!(one, other, "{text} as {moved_text}: {ray:?}");
        } else {
            let slack = slack(&model, &ray, one) + slack(&moved_model, &moved(&ray), other);
            assert!((one - other).abs() <= slack, "{text} as {moved_text}: {ray:?}, {one} {other}");
        }
    }
}

#[test]
fn a_scene_that_is_moved_has_the_same_hits() {
    let by = dvec3(16.0, -8.0, -32.0);
    let at = |place: DVec3| spelt(place + by);
    let moved = |ray: &Ray| Ray { origin: ray.origin + by, ..*ray };
    let ends = |end: &str, place: DVec3| (end.replace("AT", &spelt(place)), end.replace("AT", &at(place)));
    for (text, place) in [
        ("sphere s { material m center AT radius 2 }", MIDDLE),
        ("ellipsoid e { material m center AT radius 1 scale 2 0.3 1.1 }", MIDDLE),
        (
            "quadric q { material m coefficients 1 -0.5 1 0.1 0.2 -0.1 0 0 0 1 center AT box -2 -2 -2 2 2 2 }",
            MIDDLE,
        ),
        ("fplane f { material m normal 0.3 1 0.5 point AT xdir 1 0.2 0 dimensions 3 2 }", MIDDLE),
        ("revsurf r { material m profile \"2 + sin(y)\" direction 0 1 0 base AT height 6.28 }", BASE),
        ("revsurf r { material m profile \"1 + 0.3*sin(20*y)\" direction 0 1 0 base AT height 6.28 }", BASE),
    ] {
        let (text, moved_text) = ends(text, place);
        has_the_same_hits(&text, &moved_text, moved);
    }
}

/// A quarter turn around z is exact: it swaps coordinates and changes signs.
#[test]
fn a_scene_that_is_turned_has_the_same_hits() {
    let turn = DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z);
    let moved = |ray: &Ray| Ray { origin: turn * ray.origin, dir: turn * ray.dir };
    let (middle, base) = (spelt(turn * MIDDLE), spelt(turn * BASE));
    let upright = |text: &str| text.replace("MIDDLE", &spelt(MIDDLE)).replace("BASE", &spelt(BASE));
    for (text, turned) in [
        ("sphere s { material m center MIDDLE radius 2 }", "sphere s { material m center MIDDLE radius 2 }"),
        (
            "ellipsoid e { material m center MIDDLE radius 1 scale 2 0.3 1.1 }",
            "ellipsoid e { material m center MIDDLE radius 1 scale 0.3 2 1.1 }",
        ),
        (
            "fplane f { material m normal 0.3 1 0.5 point MIDDLE xdir 1 0.2 0 dimensions 3 2 }",
            "fplane f { material m normal -1 0.3 0.5 point MIDDLE xdir -0.2 1 0 dimensions 3 2 }",
        ),
        (
            "revsurf r { material m profile \"2 + sin(y)\" direction 0 1 0 base BASE height 6.28 }",
            "revsurf r { material m profile \"2 + sin(y)\" direction -1 0 0 base BASE height 6.28 }",
        ),
    ] {
        let turned = turned.replace("MIDDLE", &middle).replace("BASE", &base);
        has_the_same_hits(&upright(text), &turned, moved);
    }
}

// Rays that leave a surface

/// A ray that leaves a surface of revolution does not meet it where it starts, and meets it where it should.
#[test]
fn rays_that_leave_a_surface_meet_it_again_where_they_should() {
    for (formula, height) in [VASE, NASTY, FLANGE, KINK, TUBE] {
        let (surface, model) = revolution("exact", formula, height, 1.0);
        let mut random = Random::new(9);
        let (mut wrong, mut again) = (Vec::new(), 0);
        let shape = &model.objects[0].shape;
        for ray in rays::camera(RAYS, 1.0) {
            let found = distance(&model, &ray);
            if found == MISS {
                continue;
            }
            let start = ray.at(found);
            let normal = shape.normal(start);
            let dir = random.direction();
            if dir.dot(normal).abs() < 1e-6 {
                continue;
            }
            let leaves = Side::seen_along(-dir, normal);
            let crossings = if leaves == Side::Outside { Crossings::Entries } else { Crossings::Exits };
            let onward = Ray { origin: start, dir };
            let found = shape.distance(&onward, &RayRange { origin_side: Some(leaves), ..RayRange::ALL });
            let truth = surface.first_hit(&onward, 0.0, crossings);
            let is_right = match truth {
                Truth::Undecided => true,
                Truth::Miss => found == MISS,
                Truth::Hit(hit) => {
                    again += 1;
                    (hit.t.high - found).abs() < 1e-6
                }
            };
            if !is_right {
                wrong.push((onward, leaves, truth, found));
            }
        }
        println!("{formula}: {again} rays meet it again, {} wrong", wrong.len());
        assert!(wrong.is_empty(), "{formula}: {} wrong, such as {:?}", wrong.len(), wrong[0]);
    }
}

// What the program proves

/// The enclosure of a ray's first hit holds the truth, for every shape and for profiles of each kind.
#[test]
fn what_is_certain_is_true() {
    const RAYS: usize = 1_000;
    let mut shapes: Vec<Spelt> = SHAPES.into_iter().map(|spelt| spelt(1.0)).collect();
    for (formula, height) in [NASTY, CONE, FLANGE, KINK, TUBE, JUMP] {
        let (text, surface) = revsurf(formula, height, 1.0);
        shapes.push((text, Box::new(move |ray, near| surface.first_hit(ray, near, Crossings::All))));
    }
    for (text, truth) in shapes {
        let model = scene("exact", &text);
        let shape = &model.objects[0].shape;
        let (mut doubtful, mut wrong) = (0, Vec::new());
        let around = rays::aimed(RAYS, MIDDLE, REACH, 10.0).chain(rays::aimed(RAYS, MIDDLE, REACH, 1e6));
        let rays = rays::camera(RAYS, 1.0).chain(rays::inside(RAYS, MIDDLE, REACH)).chain(around);
        for (index, ray) in rays.enumerate() {
            let (sight, truth) = (Sight::along(&ray), truth(&ray, 0.0));
            let at = truth.hit().map(|hit| hit.t.high);
            // Only the truth is rounded here.
            let slack = ulp(at.unwrap_or(0.0));
            let is_true = |certain: Enclosure| match certain {
                Enclosure::Misses => at.is_none(),
                Enclosure::Hits(hits) => {
                    let (low, high) = (hits.low.to_f64(), hits.high.to_f64());
                    at.map_or(truth == Truth::Undecided, |at| low - slack <= at && at <= high + slack)
                }
                Enclosure::Edge(Wide { low, .. }) | Enclosure::Doubtful(low) => {
                    at.is_none_or(|at| at >= low.to_f64() - slack)
                }
            };
            let is_doubtful = |of: &Enclosure| matches!(of, Enclosure::Edge(_) | Enclosure::Doubtful(_));
            let mut certain = shape.certify(&sight, Precision::Double);
            // 237 bits take longer, and have all digits of the truth.
            if index % 40 == 0 || is_doubtful(&certain) {
                certain = shape.certify(&sight, Precision::Octuple);
            }
            doubtful += usize::from(is_doubtful(&certain));
            let has_all_digits = match (certain, truth.hit()) {
                (Enclosure::Hits(hits), Some(hit)) if index % 40 == 0 => {
                    (certify::middle(hits) - hit.t).high.abs() <= 1e-9 * slack
                }
                _ => true,
            };
            if !is_true(certain) || !has_all_digits {
                wrong.push(format!("{ray:?}: {certain:?}, {truth:?}"));
            }
        }
        println!("{text}: {doubtful} of {} doubtful, {} wrong", 4 * RAYS, wrong.len());
        assert!(wrong.is_empty(), "{text}: {} wrong, such as {}", wrong.len(), wrong[0]);
        // The bounds of a profile that jumps decide little near its steps.
        assert!(doubtful == 0 || text.contains("floor") && doubtful * 10 < 4 * RAYS, "{text}: {doubtful}");
    }
}
