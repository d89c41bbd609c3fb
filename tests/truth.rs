//! The program's hits against the true ones, with every digit that the program has.

mod common;
mod oracle;

use common::model;
use glam::{DVec2, DVec3, dvec2, dvec3};
use oracle::rays::{self, BASE, Random, VIEWPOINT, toward};
use oracle::revolution::Revolution;
use oracle::shapes::{self, Plane, Quadric};
use oracle::tally::{Tally, Tolerance, ulp};
use oracle::{Crossings, Truth};
use tabray::geometry::{Hittable, MISS, Ray, Span};
use tabray::model::Model;

/// The rays of each set.
const RAYS: usize = 10_000;

/// A method that is right: a crossing is not taken for another one, however near they are to each other.
fn exactly(scale: f64) -> Tolerance {
    Tolerance { sure: 1e-9 * scale, most: 1e-5 * scale }
}

/// The notes' methods stop at 1e-4.
const ROUGHLY: Tolerance = Tolerance { sure: 1e-3, most: 0.05 };

/// A scene with one object.
fn scene(accuracy: &str, object: &str) -> Model {
    model(&format!(
        "camera eye {{ pixeldim 640 480 worlddim 8 6 viewpoint 4 3 7 accuracy {accuracy} }}
         material m {{ ambient 1 1 1 }}
         {object}"
    ))
}

/// The distance of its first hit.
fn distance(model: &Model, ray: &Ray) -> f64 {
    model.objects[0].shape.distance(ray, &Span::RAY)
}

/// A vector as scenes spell it.
fn spelt(vector: DVec3) -> String {
    format!("{:?} {:?} {:?}", vector.x, vector.y, vector.z)
}

/// What a shape's hits are compared with.
struct Subject<'s> {
    /// Its name in messages.
    name: &'s str,
    model: &'s Model,
    /// The size of its scene against that of the notes.
    scale: f64,
    /// The first hit of a ray that is farther than a distance.
    truth: &'s dyn Fn(&Ray, f64) -> Truth,
    /// How far off the surface the point at a distance along a ray is.
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

    /// No hit is missed, invented or another one than the first.
    #[track_caller]
    fn is_right(&self, set: &str, rays: impl Iterator<Item = Ray> + Clone) -> Tally {
        let tally = self.tally(rays.clone(), exactly(self.scale));
        println!("{} {set}: {tally}", self.name);
        if let Some((index, truth, found)) = tally.first_wrong {
            let ray = rays.clone().nth(index);
            panic!("{} {set}: {tally}\n{ray:?}: {truth:?}, not {found:?}", self.name);
        }
        assert!(tally.undecided * 1000 <= tally.rays, "{} {set}: {tally}", self.name);
        tally
    }
}

// Surfaces of revolution

/// A formula for a scene that is larger or smaller.
fn scaled(formula: &str, scale: f64) -> String {
    if scale == 1.0 {
        formula.to_owned()
    } else {
        format!("{scale:?}*({})", formula.replace('y', &format!("(y/{scale:?})")))
    }
}

/// A formula's surface in a scene of some size: the truth and the program's.
fn revolution(accuracy: &str, formula: &str, height: f64, scale: f64) -> (Revolution, Model) {
    let (formula, base, height) = (scaled(formula, scale), scale * BASE, scale * height);
    let base_text = spelt(base);
    let model = scene(
        accuracy,
        &format!(
            "revsurf r {{ material m profile \"{formula}\" direction 0 1 0 base {base_text} height {height:?} }}"
        ),
    );
    (Revolution::new(&formula, base, height), model)
}

/// All sets of rays find the true hits of a formula's surface.
#[track_caller]
fn finds_the_revolution(name: &str, formula: &str, height: f64) {
    let mut faults = Vec::new();
    for scale in [1.0, 1e-3, 1e6] {
        let (surface, model) = revolution("exact", formula, height, scale);
        let subject = Subject {
            name,
            model: &model,
            scale,
            truth: &|ray, near| surface.first_hit(ray, near, Crossings::All),
            off_surface: &|ray, distance| surface.off_surface(ray, distance),
        };
        let middle = scale * (BASE + dvec3(0.0, height / 2.0, 0.0));
        let reach = surface.radius().hypot(scale * height / 2.0);
        let mut check = |set: &str, rays: &mut dyn Iterator<Item = Ray>| {
            let rays: Vec<Ray> = rays.collect();
            let tally = subject.is_right(&format!("{set} x {scale:e}"), rays.iter().copied());
            let far = rays.iter().map(|ray| ulp((ray.origin - middle).length())).fold(0.0, f64::max);
            if tally.off_surface > 1e-14 * scale + far {
                faults.push(format!("{name} {set} x {scale:e}: {tally}"));
            }
        };
        check("camera", &mut rays::camera(RAYS, scale));
        check("grazing", &mut rays::grazing(RAYS, scale, |random| rays::place_on(&surface, random)));
        check("inside", &mut rays::inside(RAYS, middle, reach));
        check("far 1e4", &mut rays::aimed(RAYS, middle, reach, scale * 1e4));
        check("far 1e7", &mut rays::aimed(RAYS, middle, reach, scale * 1e7));
    }
    assert!(faults.is_empty(), "off the surface: {}", faults.join("\n"));
}

const VASE: (&str, f64) = ("2 + sin(y)", 6.28);
const NASTY: (&str, f64) = ("1 + 0.3*sin(20*y)", 6.28);
const CONE: (&str, f64) = ("-4/6*(y - 6)", 6.0);
const FLANGE: (&str, f64) = ("0.3 + 2*exp(-(20*(y-3))^2)", 6.28);
const KINK: (&str, f64) = ("0.6 + 0.5*abs(y-3)", 6.28);
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

/// The truth itself: no sign changes before the hit, and it is where the sign changes.
#[test]
fn the_truth_of_a_revolution_is_where_the_function_first_changes_its_sign() {
    for (formula, height) in [VASE, NASTY, CONE, FLANGE, KINK, JUMP] {
        let surface = Revolution::new(formula, BASE, height);
        let line = tabray::formula::Formula::parse(formula).expect("a formula");
        for ray in rays::camera(500, 1.0).chain(rays::inside(500, BASE + dvec3(0.0, 3.0, 0.0), 4.0)) {
            let outside = |t: f64| {
                let at = ray.at(t) - BASE;
                let radius = line.at(at.y);
                let there = (0.0..=height).contains(&at.y) && radius >= 0.0;
                there.then_some(at.x * at.x + at.z * at.z > radius * radius)
            };
            let end = match surface.first_hit(&ray, 0.0, Crossings::All) {
                Truth::Hit(hit) => {
                    let t = hit.t.to_f64();
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

/// A cone is a quadric, too.
#[test]
fn two_truths_of_a_cone_agree() {
    let surface = Revolution::new(CONE.0, BASE, CONE.1);
    let quadric = Quadric {
        coefficients: [9.0, -4.0, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        center: BASE + dvec3(0.0, 6.0, 0.0),
        corners: [dvec3(-9.0, -6.0, -9.0), dvec3(9.0, 0.0, 9.0)],
    };
    let grazing = rays::grazing(RAYS, 1.0, |random| rays::place_on(&surface, random));
    for ray in rays::camera(RAYS, 1.0).chain(grazing) {
        let (one, other) = (surface.first_hit(&ray, 0.0, Crossings::All), quadric.first_hit(&ray, 0.0));
        match (one, other) {
            (Truth::Hit(one), Truth::Hit(other)) => {
                let apart = (one.t - other.t).to_f64().abs();
                assert!(apart * one.slope.abs() < 1e-25, "{ray:?}: {one:?} {other:?}");
            }
            (Truth::Undecided, _) | (_, Truth::Undecided) => {}
            (one, other) => assert_eq!(one, other, "{ray:?}"),
        }
    }
}

/// The notes' method finds what is in the middle of the picture, to the 1e-4 where it stops.
#[test]
fn the_notes_method_finds_the_vase_but_for_its_silhouette() {
    let (surface, model) = revolution("classic", VASE.0, VASE.1, 1.0);
    let subject = Subject {
        name: "vase, classic",
        model: &model,
        scale: 1.0,
        truth: &|ray, near| surface.first_hit(ray, near, Crossings::All),
        off_surface: &|ray, distance| surface.off_surface(ray, distance),
    };
    let tally = subject.tally(rays::camera(RAYS, 1.0), ROUGHLY);
    println!("vase, classic: {tally}");
    assert!(tally.hits > RAYS / 4, "{tally}");
    assert!(tally.wrong() * 20 < tally.hits, "{tally}");
    assert!(tally.worst() < 1e-3, "{tally}");
}
