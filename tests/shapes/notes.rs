//! The notes' worked numbers, each to the decimals that the notes print.

use crate::common::{model, render};
use glam::{DVec3, dvec3};
use tabray::geometry::{MISS, Ray, RayRange};
use tabray::render::{Plan, trace};
use tabray::scene::dump;
use tabray::world::{AnyShape, Hittable};

/// Asserts that a vector, printed to this many decimals, is the expected text.
#[track_caller]
fn prints(actual: DVec3, decimals: usize, expected: &str) {
    let printed = actual.to_array().map(|number| format!("{number:.decimals$}")).join(" ");
    assert_eq!(printed, expected);
}

// The sections from "Points and vectors" to "Useful operations on vectors", and "A sample test driver for vector.h",
// compute with vectors alone. So does glam, and no change here can affect it. The notes print 6 + 6 + 4 = 16 for the
// dot product of (2, 3, 4) and (3, 2, 1), which is right.

// "Translating from pixel to world coordinates", "An alternative world view", "Computing the direction of a ray"

/// Returns the camera of a scene, with this many pixels.
fn camera(pixels: &str) -> tabray::world::Sensor {
    model(&format!("camera c {{ pixeldim {pixels} worlddim 8 6 viewpoint 4 3 6 }}")).camera.value
}

/// Returns where the ray through a pixel crosses the image plane.
fn on_screen(pixels: &str, column: f64, row: f64) -> DVec3 {
    let ray = camera(pixels).ray(column, row);
    ray.at(-ray.origin.z / ray.dir.z)
}

#[test]
fn a_pixel_maps_to_its_fraction_of_the_screen() {
    // The notes first divide by 640 and 480, and finally by one less; images larger by one pixel give the round
    // numbers.
    prints(on_screen("641 481", 100.0, 40.0), 9, "1.250000000 0.500000000 0.000000000");
    prints(on_screen("801 601", 400.0, 300.0), 9, "4.000000000 3.000000000 0.000000000");
}

#[test]
fn the_outermost_pixels_map_to_the_edges_of_the_screen() {
    prints(on_screen("640 480", 0.0, 0.0), 9, "0.000000000 0.000000000 0.000000000");
    prints(on_screen("640 480", 639.0, 479.0), 9, "8.000000000 6.000000000 0.000000000");
}

#[test]
fn a_ray_goes_from_the_viewpoint_through_its_pixel() {
    let ray = camera("641 481").ray(100.0, 40.0);
    assert_eq!(ray.origin, dvec3(4.0, 3.0, 6.0));
    // The notes print -0.35 for -2.5 / 7.06, which is -0.354; 7.06 is the length of (-2.75, -2.5, -6).
    prints(ray.dir, 2, "-0.39 -0.35 -0.85");
    assert!(ray.dir.z < 0.0);
}

// The sections from "The cross product of two vectors" to "Constructing rotation matrices" are glam's, too; its
// matrices consist of columns, and those of the notes of rows. The notes print (1, 0, -1), which is right, for the
// cross product of (1, 1, 1) and (0, -1, 0).

// "Determining if a ray hits a plane", "Determining if a ray hits a sphere"

/// Returns the shape of a scene's first object.
fn shape(object: &str) -> AnyShape {
    let text = format!(
        "camera c {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }} material m {{ ambient 1 1 1 }} {object}"
    );
    model(&text).objects.swap_remove(0).shape
}

fn distance(shape: &dyn Hittable, origin: DVec3, toward: DVec3) -> f64 {
    shape.distance(&Ray { origin, dir: toward.normalize() }, &RayRange::ALL)
}

#[test]
fn a_plane_is_hit_once_and_not_from_along_it_or_behind_the_eye() {
    let floor = shape("plane floor { material m normal 0 2 0 point 5 -1 5 }");
    let eye = dvec3(4.0, 3.0, 0.0);
    assert_eq!(distance(&*floor, eye, dvec3(0.0, -1.0, 0.0)), 4.0);
    assert_eq!(distance(&*floor, eye, dvec3(3.0, 0.0, -4.0)), MISS, "parallel");
    assert_eq!(distance(&*floor, eye, dvec3(0.0, 1.0, 0.0)), MISS, "behind the eye");
    assert_eq!(
        distance(&*floor, dvec3(4.0, 3.0, 6.0), dvec3(0.0, -1.0, 0.0)),
        MISS,
        "in front of the image plane"
    );
    assert_eq!(floor.normal(DVec3::ZERO), DVec3::Y);
}

#[test]
fn a_sphere_is_hit_by_the_sign_of_its_discriminant() {
    let ball = shape("sphere ball { material m center 4 3 -4 radius 2 }");
    let eye = dvec3(4.0, 3.0, 6.0);
    assert_eq!(distance(&*ball, eye, dvec3(0.0, 0.0, -1.0)), 8.0, "positive: the nearer root");
    assert_eq!(
        distance(&*ball, eye + 2.0 * DVec3::X, dvec3(0.0, 0.0, -1.0)),
        MISS,
        "zero: touching is a miss"
    );
    assert_eq!(distance(&*ball, eye + 3.0 * DVec3::X, dvec3(0.0, 0.0, -1.0)), MISS, "negative");
    assert_eq!(ball.normal(dvec3(4.0, 3.0, -2.0)), DVec3::Z, "from the centre outward");
}

// "An example illumination computation"

#[test]
fn a_lit_surface_sends_back_what_the_notes_compute() {
    // (1, 2, 10) times (8, 8, 2) is (8, 16, 20), and that times 0.5 / 10 is (0.4, 0.8, 1): a light 10 units from the
    // hit, at 60 degrees from the normal, seen from a distance of 1, so that nothing is lost on the way to the eye.
    let scene = model(
        "camera c { pixeldim 1 1 worlddim 8 6 viewpoint 4 3 1 }
         material m { diffuse 1 2 10 }
         plane wall { material m normal 0 0 1 point 0 0 0 }
         light l { location 12.660254037844387 3 5 emissivity 8 8 2 }",
    );
    prints(trace::pixel(&Plan::new(&scene), 0, 0), 12, "0.400000000000 0.800000000000 1.000000000000");
}

// "Producing a formatted dump of the object list", "Type specific dumpers"

#[test]
fn a_plane_is_dumped_as_the_notes_show_it() {
    let scene = model(
        "camera cam1 { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 6 }
         material yellow { ambient 5 4 0 diffuse 4 4 0 specular 1 1 1 }
         plane rightwall { material yellow normal -5 0 1 point 7 0 0 }",
    );
    let dump = dump::notes(&scene);
    // The notes show the normal as -1.0 0.0 0.2; as a unit vector it is -0.98 0 0.196.
    let expected = "plane        rightwall \nmaterial     yellow \n\
        normal        -1.0   0.0   0.2 \npoint          7.0   0.0   0.0 \n";
    assert!(dump.contains(expected), "{dump}");
}

// "An intuitive motivation" and "Determining an equation for the surface" of surfaces of revolution

#[test]
fn the_cone_has_its_vertex_and_its_base_where_the_notes_put_them() {
    let cone = shape("revsurf cone { material m surfer 1 base 4 0 -4 direction 0 1 0 height 6 }");
    // At half its height the cone's radius is 2; the notes' method is exact to half of 1e-4.
    let hit = distance(&*cone, dvec3(4.0, 3.0, 7.0), dvec3(0.0, 0.0, -1.0));
    assert!((hit - 9.0).abs() < 5e-5, "{hit}");
    assert_eq!(distance(&*cone, dvec3(4.0, 6.1, 7.0), dvec3(0.0, 0.0, -1.0)), MISS, "above the vertex");
    // The gradient is (2x, -2 g g', 2z) at (0, 3, 2), with g = 2 and g' = -4/6.
    let normal = cone.normal(dvec3(4.0, 3.0, -2.0));
    assert!(normal.abs_diff_eq(dvec3(0.0, 2.0 * 2.0 * 4.0 / 6.0, 4.0).normalize(), 1e-15), "{normal}");
}

#[test]
fn the_normal_of_the_vase_is_the_gradient_of_its_equation() {
    let vase = shape("revsurf vase { material m surfer 0 base 0 0 -5 direction 0 1 0 height 6.28 }");
    let (y, angle) = (1.25_f64, 0.7_f64);
    let radius = 2.0 + y.sin();
    let at = dvec3(radius * angle.cos(), y, radius * angle.sin());
    let gradient = dvec3(2.0 * at.x, -2.0 * radius * y.cos(), 2.0 * at.z);
    assert!(vase.normal(at + dvec3(0.0, 0.0, -5.0)).abs_diff_eq(gradient.normalize(), 1e-15));
}

// The notes' `ellipsoid_t` is a sphere with a scale.

#[test]
fn a_sphere_with_a_scale_is_an_ellipsoid() {
    let scene = |accuracy: &str, ball: &str| {
        model(&format!(
            "camera c {{ accuracy {accuracy} pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }}
             material m {{ ambient 1 1 1 diffuse 3 3 3 }} light l {{ location 1 7 2 emissivity 5 5 5 }}
             {ball} {{ material m center 4 3 -3 radius 1.5 scale 1.5 1 0.5 }}"
        ))
    };
    for accuracy in ["classic", "draft", "exact", "strict"] {
        let [sphere, ellipsoid] = ["sphere ball", "ellipsoid ball"].map(|ball| scene(accuracy, ball));
        assert_eq!(render(&sphere), render(&ellipsoid), "{accuracy}");
        assert!(dump::notes(&sphere).contains("scale          1.5   1.0   0.5"), "{}", dump::notes(&sphere));
    }
}
