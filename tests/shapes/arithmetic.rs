//! The hits of random shapes, compared with true ones computed from the numbers of the scene's text, for rays that are
//! hard for them. Also checks that the bounds of packets contain the true hits, including those of a camera's exact
//! rays.

use crate::common;
use crate::oracle::hard::{self, SETS};
use crate::oracle::rays::Random;
use crate::oracle::tally::Tally;
use crate::oracle::{Surface, Truth, fplane_text, spelt};
use glam::{DVec3, dvec2, dvec3};
use tabray::geometry::{Bracket, MISS, Ray, RayRange};
use tabray::scene::Model;
use tabray::world::{AnyShape, Hittable};

/// The number of shapes of each kind, and the number of rays for each set and shape.
const SHAPES: usize = 200;
const RAYS: usize = 40;

const CAMERA: &str = "camera eye { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 7 }";

fn scene(object: &str) -> Model {
    common::model(&format!("{CAMERA} material m {{ ambient 1 1 1 }} {object}"))
}

/// Returns the shape of an entity's text.
fn shape(object: &str) -> AnyShape {
    scene(object).objects.remove(0).shape
}

/// Returns the distance of the first hit.
fn distance(shape: &dyn Hittable, origin: DVec3, dir: DVec3) -> f64 {
    shape.distance(&Ray { origin, dir }, &RayRange::ALL)
}

/// Tells whether a bracket contains the truth. Any bracket is right if the truth is undecided.
fn holds(Bracket { near, far }: Bracket, truth: Truth) -> bool {
    match truth {
        Truth::Undecided => true,
        Truth::Miss => far == MISS,
        Truth::Hit(hit) => hit.t >= near.into() && (far == MISS || hit.t <= far.into()),
    }
}

/// Asserts that every ray of every set finds the true hit to a few ulps, by each way in which the program computes it.
#[track_caller]
fn finds(kind: &str, ulps: f64) {
    let mut random = Random::new(14);
    let mut faults = Vec::new();
    for set in SETS {
        let mut tally = Tally::default();
        for _ in 0..SHAPES {
            let subject = hard::subject(kind, &mut random);
            let shape = shape(&subject.text);
            for _ in 0..RAYS {
                let ray = subject.ray(set, &mut random);
                let before = tally.wrong();
                let truth = subject.truth(&ray, 0.0);
                subject.count(&mut tally, &*shape, &ray, truth);
                let found = shape.distance(&ray, &RayRange::ALL);
                let bracket = shape.t_bounds(&ray, &RayRange::ALL);
                let is_certain = bracket.far < MISS;
                let quick = if is_certain { shape.refine(&ray, None) } else { f64::NAN };
                if tally.wrong() > before {
                    faults.push(format!("wrong: {}\n  {ray:?}: {truth:?}, not {found:?}", subject.text));
                }
                if !quick.is_nan() && quick.to_bits() != found.to_bits() {
                    faults.push(format!("not the same: {}\n  {ray:?}: {quick:?}, {found:?}", subject.text));
                }
                if !holds(bracket, truth) {
                    faults.push(format!("not in {bracket:?}: {}\n  {ray:?}: {truth:?}", subject.text));
                }
            }
        }
        let tally = tally.finish();
        println!("{kind}, {set}: {tally}");
        if tally.ulps > ulps || tally.undecided * 50 > tally.rays {
            faults.push(format!("{kind}, {set}: {tally}"));
        }
    }
    assert!(
        faults.is_empty(),
        "{} faults, such as\n{}",
        faults.len(),
        faults[..faults.len().min(8)].join("\n")
    );
}

#[test]
fn spheres_are_found() {
    finds("sphere", 4.0);
}

#[test]
fn ellipsoids_are_found() {
    finds("ellipsoid", 4.0);
}

#[test]
fn quadrics_are_found() {
    finds("quadric", 4.0);
}

#[test]
fn triangles_are_found() {
    finds("triangle", 8.0);
}

#[test]
fn planes_are_found() {
    finds("plane", 8.0);
}

#[test]
fn rectangles_are_found() {
    finds("fplane", 8.0);
}

/// The bounds contain the hit of the exact ray through a pixel, although the program's ray has a rounded direction, for
/// shapes whose boundary that ray passes at a distance of a few ulps.
#[test]
fn brackets_hold_the_hits_of_the_real_rays_of_a_camera() {
    let camera = scene("plane p { material m normal 0 1 0 point 0 0 0 }").camera.value;
    let mut random = Random::new(15);
    let (mut wrong, mut certain) = (Vec::new(), 0);
    for index in 0..4_000 {
        let pixel = [random.below(640), random.below(480)];
        let ray = camera.ray(f64::from(pixel[0]), f64::from(pixel[1]));
        let (along, across) = ray.dir.any_orthonormal_pair();
        let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
        let (side, other) = (cos * along + sin * across, cos * across - sin * along);
        let apart = 10_f64.powf(random.between(-17.0, -4.0)) * if random.below(2) == 0 { 1.0 } else { -1.0 };
        let at = ray.at(random.between(8.0, 60.0)) + apart * side;
        let radius = random.between(0.1, 3.0);
        let center = at + radius * side;
        let text = match index % 5 {
            0 => {
                format!("sphere s {{ material m center {} radius {radius:?} }}", spelt(center))
            }
            1 => {
                let scale = DVec3::from([0; 3].map(|_| 10_f64.powf(random.between(-3.0, 3.0))));
                // Where the silhouette is inclined, its nearest point is not on the ray: this is the shape whose
                // silhouette contains the point.
                let half = radius * (side / scale).normalize() * scale;
                let center = at + half;
                let (place, stretch) = (spelt(center), spelt(scale));
                format!("ellipsoid e {{ material m center {place} radius {radius:?} scale {stretch} }}")
            }
            2 => {
                let corners = [DVec3::splat(-radius), DVec3::splat(radius)];
                format!(
                    "quadric q {{ material m coefficients 1 1 1 0 0 0 0 0 0 {:?} center {} box {} {} }}",
                    radius * radius,
                    spelt(center),
                    spelt(corners[0]),
                    spelt(corners[1])
                )
            }
            3 => {
                let leaning = other + random.between(-3.0, 3.0) * ray.dir;
                let corners = [at - radius * leaning, at + radius * leaning, at + radius * (side + ray.dir)];
                let [a, b, c] = corners.map(spelt);
                format!("triangle t {{ material m vertex1 {a} vertex2 {b} vertex3 {c} }}")
            }
            _ => {
                let normal = ray.dir + random.between(-3.0, 3.0) * side;
                let xdir = normal.cross(other);
                let point = at - radius * other;
                fplane_text(normal, point, xdir, dvec2(2.0 * radius, 3.0 * radius))
            }
        };
        let truth = Surface::read(&format!("{CAMERA} {text}")).first_hit_of_pixel(pixel);
        let bracket = shape(&text).t_bounds(&ray, &RayRange::ALL);
        certain += u32::from(bracket.near == MISS || bracket.far < MISS);
        if !holds(bracket, truth) {
            wrong.push(format!("{text}\n  {ray:?}: {bracket:?}, {truth:?}"));
        }
    }
    println!("{certain} of 4000 are certain");
    assert!(wrong.is_empty(), "{} wrong, such as\n{}", wrong.len(), wrong[0]);
    assert!(certain > 1_000, "{certain} of 4000 are certain");
}

/// A ray is almost parallel to a floor that it hits 12 units away. Its height differs from the floor's in the last
/// digits.
#[test]
fn a_ray_almost_along_a_plane_hits_it_where_it_is() {
    let floor = shape("plane f { material m normal 0 1 0 point 0 3.9999999999999991 0 }");
    let origin = dvec3(4.0, 4.000000000000001, 6.0);
    let dir = (dvec3(4.0, 4.0, 0.0) - origin).normalize();
    let found = distance(&*floor, origin, dir);
    assert!((found - 12.0).abs() < 1e-14, "{found}");
    assert_eq!(distance(&*floor, origin, DVec3::NEG_Z), MISS, "along it");
}

/// A plane in the image plane is visible; a plane nearer to the viewer by one ulp is not.
#[test]
fn a_plane_is_there_up_to_the_screen() {
    let mut random = Random::new(16);
    for (z, is_there) in [(0.01, true), (0.01_f64.next_up(), false)] {
        let pane = shape(&format!("plane p {{ material m normal 0 0 3 point 0 0 {z:?} }}"));
        for _ in 0..1_000 {
            let origin = dvec3(random.between(-9.0, 9.0), random.between(-9.0, 9.0), 7.3);
            let dir = (dvec3(random.between(-9.0, 9.0), 0.0, 0.0) - origin).normalize();
            assert_eq!(distance(&*pane, origin, dir) < MISS, is_there, "at {z}, from {origin} along {dir}");
        }
    }
}

/// The sides of a rectangle belong to it, to the last bit.
#[test]
fn the_sides_of_a_rectangle_belong_to_it() {
    let pane = shape("fplane f { material m normal 0 0 1 point 0.1 0.2 -9 xdir 1 0 0 dimensions 0.5 0.25 }");
    for (x, is_inside) in [(0.1, true), (0.1_f64.next_down(), false), (0.6, true), (0.6_f64.next_up(), false)]
    {
        assert_eq!(distance(&*pane, dvec3(x, 0.3, 7.0), DVec3::NEG_Z) < MISS, is_inside, "at x = {x:?}");
    }
}

/// A sphere clipped by its own bounding box shows its front.
#[test]
fn a_ball_in_the_box_around_it_is_whole() {
    let ball = |radius: f64| {
        let square = radius * radius;
        shape(&format!(
            "quadric q {{ material m coefficients 1 1 1 0 0 0 0 0 0 {square:?} center 4 3 -4.13
             box -{radius:?} -{radius:?} -{radius:?} {radius:?} {radius:?} {radius:?} }}"
        ))
    };
    for step in 1..=60 {
        let radius = 0.05 * f64::from(step);
        // The exact radius is the root of a rounded square: where it exceeds the box, both poles are cut off.
        let is_wider = tabray::exact::double_double::two_product(radius, radius).1 < 0.0;
        let found = distance(&*ball(radius), dvec3(4.0, 3.0, 6.0), DVec3::NEG_Z);
        let is_right = if is_wider { found == MISS } else { (found - (10.13 - radius)).abs() < 1e-14 };
        assert!(is_right, "of radius {radius}: {found}");
    }
}

/// Two planes that nearly coincide have the normal of both, not noise.
#[test]
fn a_double_plane_has_a_normal() {
    for apart in ["0", "1e-15", "1e-30"] {
        let planes = shape(&format!(
            "quadric q {{ material m coefficients 1 4 9 4 6 12 0 0 0 {apart} center 4 3 -4 }}"
        ));
        let normal = dvec3(1.0, 2.0, 3.0).normalize();
        let mut random = Random::new(17);
        for _ in 0..1_000 {
            let target = dvec3(4.0, 3.0, -4.0) + 2.0 * normal.any_orthonormal_vector() + random.direction();
            let origin = dvec3(4.0, 3.0, 6.0);
            let ray = Ray { origin, dir: (target - origin).normalize() };
            let found = planes.distance(&ray, &RayRange::ALL);
            let truth = (dvec3(4.0, 3.0, -4.0) - origin).dot(normal) / ray.dir.dot(normal);
            assert!((found - truth).abs() < 1e-6, "{apart}: {found}, not {truth}");
            let cosine = planes.normal(ray.at(found)).dot(normal).abs();
            assert!(cosine > 1.0 - 1e-9, "{apart}: {cosine}");
        }
    }
}
