//! The tracer's first hit is the proven one, in every scene.

use crate::common::{load, model, render, root, scenes};
use assert_cmd::cargo::cargo_bin_cmd;
use dashu_int::IBig;
use glam::DVec3;
use std::cmp::Ordering;
use tabray::geometry::{Aabb, Ray, RayRange};
use tabray::render::{Plan, trace};
use tabray::tools::assumptions;
use tabray::tools::colours::{self, Prover};
use tabray::tools::verify::{self, Verdict};
use tabray::world::{Facts, Hittable};
use tempfile::TempDir;

/// Scenes in which many pixels look at an edge on purpose, or at two coinciding surfaces.
const AT_EDGES: [&str; 11] = [
    "camera/edges-of-the-screen.ray", // two rectangles in one plane
    "plane/equal-distance.ray",       // two planes in one place
    "fplane/seam.ray",                // a column of pixels looks at the seam
    "hard/rug.ray",                   // a rug on a floor
    "hard/seam.ray",
    "hard/lantern-inside.ray",       // a row of pixels looks at the edges of a mesh
    "hard/light-on-the-surface.ray", // a row of pixels looks at the corner of floor and wall
    "hard/tangent.ray",              // a column of pixels looks at the rim
    "hard/jump.ray",                 // the rims of a stair
    "toml/one-line-each.toml",       // rows of pixels look at a rectangle's sides
    "triangle/seam.ray",
];

/// Counts the proven, undecided, contradicted and not certified pixels among every `step`-th pixel in both directions.
fn all_counts(model: &tabray::scene::Model, step: usize) -> [usize; 4] {
    let [width, height] = model.camera.value.pixels;
    let plan = Plan::new(model);
    let mut counts = [0; 4];
    for y in (0..height).step_by(step) {
        for x in (0..width).step_by(step) {
            counts[match verify::pixel(&plan, x, y).verdict {
                Verdict::Proven => 0,
                Verdict::Tie => 1,
                Verdict::Contradicted => 2,
                Verdict::Uncertified => 3,
            }] += 1;
        }
    }
    counts
}

/// Counts the proven, undecided and contradicted pixels of a scene in which all shapes have an equation.
fn counts(model: &tabray::scene::Model, step: usize) -> [usize; 3] {
    let [proven, ties, contradicted, not_certified] = all_counts(model, step);
    assert_eq!(not_certified, 0);
    [proven, ties, contradicted]
}

#[test]
fn no_scene_is_contradicted_and_nearly_every_pixel_is_proven() {
    for path in scenes() {
        let name = path.strip_prefix(root().join("scenes")).expect("a scene").to_string_lossy().into_owned();
        let model = load(&path);
        let step = if model.camera.value.pixels[0] > 320 { 31 } else { 7 };
        // What an image cuts out is known to no equation.
        if model.objects.iter().any(|object| !object.shape.is_certified()) {
            assert_eq!(all_counts(&model, step)[2], 0, "{name}");
            continue;
        }
        let [proven, undecided, contradicted] = counts(&model, step);
        assert_eq!(contradicted, 0, "{name}");
        let part = undecided as f64 / (proven + undecided) as f64;
        let may_be_more = AT_EDGES.contains(&name.as_str());
        assert!(part <= 0.001 || may_be_more, "{name}: {undecided} of {proven}");
    }
}

#[test]
fn accuracies_but_the_classic_one_are_never_contradicted() {
    let scene = |accuracy: &str| {
        model(&format!(
            "camera eye {{ pixeldim 64 48 worlddim 8 6 viewpoint 4 3 7 accuracy {accuracy} }}
             material m {{ ambient 1 1 1 }}
             plane floor {{ material m normal 0 1 0 point 0 0 0 }}
             revsurf ripples {{ material m profile \"1 + 0.3 * sin(20 * y)\" direction 0.1 1 0 base 4 0.1 -4 height 6 }}
             sphere ball {{ material m center 2 3 -4 radius 1 }}"
        ))
    };
    for accuracy in ["draft", "exact", "strict"] {
        assert_eq!(counts(&scene(accuracy), 1)[2], 0, "{accuracy}");
    }
    assert!(counts(&scene("classic"), 1)[2] > 10);
}

/// A sphere of radius 1 around a point, as a plugin without an equation has it.
struct Bare {
    middle: DVec3,
    has_bounds: bool,
}

impl Hittable for Bare {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let away = ray.origin - self.middle;
        let half = away.dot(ray.dir);
        let root = (half * half - away.length_squared() + 1.0).sqrt();
        range.keep(if -half - root > range.near { -half - root } else { root - half })
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        at - self.middle
    }

    fn facts(&self) -> Facts {
        let facts = Facts::within(Aabb { low: self.middle - 1.0, high: self.middle + 1.0 });
        if self.has_bounds { facts } else { Facts { bounds: None, ..facts } }
    }
}

/// A ball that stands in for one without an equation, half of it behind a wall.
fn with_bare_ball(has_bounds: bool) -> tabray::scene::Model {
    let mut model = model(
        "camera eye { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 7 }
         material m { ambient 1 1 1 diffuse 1 1 1 }
         light lamp { location 4 9 5 emissivity 9 9 9 }
         sphere ball { material m center 4 3 -4 radius 1 }
         fplane wall { material m normal 0 0 1 point 0.1 0 -2 xdir 1 0 0 dimensions 3.9 6 }
         plane back { material m normal 0 0 1 point 0 0 -9 }",
    );
    model.objects[0].shape = Bare { middle: DVec3::new(4.0, 3.0, -4.0), has_bounds }.into();
    model
}

#[test]
fn rays_that_pass_the_bounds_of_a_shape_without_an_equation_are_proven() {
    let [proven, ties, contradicted, not_certified] = all_counts(&with_bare_ball(true), 1);
    assert_eq!((ties, contradicted), (0, 0));
    // The box is 2 wide in an image 8 wide, somewhat smaller by its distance, and half hidden.
    assert!((20..100).contains(&not_certified) && proven + not_certified == 64 * 48, "{not_certified}");
    let [_, _, contradicted, not_certified] = all_counts(&with_bare_ball(false), 1);
    // Without bounds, it may be anywhere, but the tracer may not find what lies behind the wall.
    assert!(contradicted == 0 && not_certified == 64 * 48, "{not_certified}");
}

#[test]
fn colours_that_a_shape_without_an_equation_may_change_are_not_certified() {
    let model = with_bare_ball(true);
    let plan = Plan::new(&model);
    let prover = Prover::new(&plan);
    let verdict = |x, y| prover.traced(x, y).verdict();
    assert_eq!(verdict(2, 2), colours::Verdict::Proven, "the wall, whose shadow rays pass the box by");
    assert_eq!(verdict(34, 24), colours::Verdict::Uncertified, "the ball");
    assert_eq!(verdict(60, 40), colours::Verdict::Proven, "the back");
    assert_eq!(verdict(36, 12), colours::Verdict::Uncertified, "the back where the ball may shade it");
}

#[test]
fn what_was_rounded_before_a_proof_is_named() {
    let assumed = |camera: &str, objects: &str| {
        let text = format!("{camera} material m {{ ambient 1 1 1 }} {objects}");
        let model = model(&text);
        let assumed = assumptions::of(&Plan::new(&model), false);
        assumed.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let look = "{ pixeldim 8 6 position 4 3 7 target 4 3 0";
    let pinhole = "camera eye { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 7 }";
    for exact in [pinhole, &format!("look_at eye {look} }}")] {
        let objects = "sphere s { material m center 0.1 0.2 0.3 radius 1 }
            box b { material m center 0 1 -4 size 2 2 2 }
            torus t { material m center 0 0 0 direction 1 2 3 radius 2 tube 0.5 }
            lathe l { material m points 0 1 2 3 4 1 base 4 0 -4 }
            place p { object t rotation 10 20 30 translation 0.1 0.2 0.3 }";
        assert_eq!(assumed(exact, objects), [""; 0], "{exact}");
    }
    for (camera, of) in [
        (format!("fisheye eye {look} }}"), "rays as computed, rounded to f64 (`fisheye`)"),
        (format!("thin_lens eye {look} aperture 0.1 }}"), "rays as computed, rounded to f64 (`thin_lens`)"),
        (
            format!("orthographic eye {look} width 8 }}"),
            "starts of rays as computed, rounded to f64 (`orthographic`)",
        ),
    ] {
        assert_eq!(assumed(&camera, ""), [of]);
    }
    let boxes =
        "box a { material m center 0.1 1 -4 size 0.7 2 2 } box b { material m center 0 0 0 size 2 2 2 }
        mesh c { material m file \"scenes/models/knot.obj\" rotation 0 30 0 } intersection i { objects b c }";
    assert_eq!(assumed(pinhole, boxes), ["vertices as placed, rounded to f64 (`box`, `mesh`)"]);
}

/// Returns a number times 2^1074, which is whole.
fn scaled(of: f64) -> IBig {
    let (bits, sign) = (of.to_bits(), if of < 0.0 { -1 } else { 1 });
    let (exponent, fraction) = ((bits >> 52 & 0x7ff) as usize, bits & ((1 << 52) - 1));
    let whole = if exponent == 0 { fraction } else { fraction | 1 << 52 };
    (IBig::from(whole) << (exponent.max(1) - 1)) * sign
}

/// A lathe whose rim lies in the image plane, around pixels that are closer to each other than the rounding of the
/// spline's coefficients. It widens from the rim on, so that rays outside of the rim hit it, and others pass through.
#[test]
fn hits_at_the_rim_of_a_lathe_are_those_of_the_curve_through_its_points() {
    let (pixels, width) = (9, 2_f64.powi(-52));
    for case in 0..12 {
        let (rim, height) = (0.3 + 0.0371 * f64::from(case), 1.7 + 0.013 * f64::from(case));
        let base = -(rim - 0.5 * width);
        let model = model(&format!(
            "camera eye {{ pixeldim {pixels} 2 worlddim {width:?} 1e-30 viewpoint 0 0 5 }} material m {{ ambient 9 9 9 }}
             lathe l {{ material m base {base:?} 0 {:?} direction 0 0 1
             points 0 {:?} {:?} {:?} {:?} {:?} {height:?} {rim:?} }}",
            -height,
            rim + 2.0,
            0.31 * height,
            rim + 1.1,
            0.77 * height,
            rim + 0.9,
        ));
        let plan = Plan::new(&model);
        for x in 0..pixels {
            // The pixel's place is a multiple of a power of two: that and what follows are exact.
            let place = scaled(width * x as f64 / (pixels - 1) as f64) - scaled(base);
            let is_outside = match place.cmp(&scaled(rim)) {
                Ordering::Greater => true,
                Ordering::Less => false,
                // The edge is in the picture, and 237 bits do not tell it from a miss.
                Ordering::Equal => continue,
            };
            let hit = trace::first_hit(&plan, &plan.camera.sight(x as f64, 0.0));
            assert_eq!(hit.is_some(), is_outside, "pixel {x} of lathe {case}");
            assert_eq!(verify::pixel(&plan, x, 0).verdict, Verdict::Proven, "pixel {x} of lathe {case}");
        }
    }
}

#[test]
fn the_program_counts_and_shows_what_is_proven() {
    let folder = TempDir::new().expect("a folder");
    let run = |args: &[&str]| {
        let mut command = cargo_bin_cmd!("tabray");
        let scene = root().join("scenes/hard/ripples.ray");
        let output = command.current_dir(folder.path()).arg("verify").arg(scene).args(args).output();
        let output = output.expect("the program runs");
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (status, said) = run(&["-o", "a.png"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("pixels proven (") && said.ends_with(" 0 contradicted\n"), "{said}");
    let colours = |name: &str| image::open(folder.path().join(name)).expect("a picture").into_rgb8();
    let white = colours("a.png").pixels().filter(|pixel| pixel.0 == [255; 3]).count();
    assert!(said.contains(&format!(", {white} tie")), "{said}");
    let (status, said) = run(&["--method", "classic", "-o", "b.png"]);
    assert_eq!(status, Some(1), "{said}");
    let red = colours("b.png").pixels().filter(|pixel| pixel.0 == [255, 0, 0]).count();
    assert!(red > 0 && said.ends_with(&format!(" {red} contradicted\n")), "{said}");
}

#[test]
fn a_contradiction_is_a_failure_that_counts_it() {
    let folder = TempDir::new().expect("a folder");
    let mut verify = cargo_bin_cmd!("tabray");
    verify.current_dir(folder.path()).args(["verify", "--method", "classic"]);
    let output = verify.arg(root().join("scenes/hard/ripples.ray")).output().expect("it runs");
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{out}{err}");
    let (_, contradicted) = out.rsplit_once(", ").expect("three counts");
    let count: usize =
        contradicted.strip_suffix(" contradicted\n").and_then(|n| n.parse().ok()).expect("a number");
    assert!(count > 1, "{out}");
    assert_eq!(err, format!("error: the tracer finds another object at {count} pixels\n"));
}

/// A former bug of the proof: with rounded normals and edges of a sliver, the result was wrong for 156 of 606 such
/// pixels.
#[test]
fn a_sliver_before_another_triangle_is_proven_from_its_corners() {
    let model = model(
        "camera eye { pixeldim 1 1 worlddim 8 6 viewpoint 4 3 6 }
         material red { ambient 10 0 0 }
         material green { ambient 0 10 0 }
         triangle sliver { material red vertex1 74.02008166032914 181.20698666173578 -180.57992796863354
             vertex2 2.5709057906925388 -0.6368328987687811 -1.037175155326901
             vertex3 2.571131692559333 -0.6369216588530878 -1.037123002404182 }
         triangle other { material green vertex1 0 0 -4.628004657281974 vertex2 10 0 -4.628004657281974
             vertex3 4 9 -4.628004657281974 }",
    );
    assert_eq!(verify::pixel(&Plan::new(&model), 0, 0).verdict, Verdict::Proven);
    let sight = model.camera.value.sight(0.0, 0.0);
    let met = tabray::render::trace::first_hit(&Plan::new(&model), &sight).expect("a triangle").index;
    assert_eq!(met, 0, "rational arithmetic says that the sliver is nearer, by 6e-10");
}

/// Squares that nearly overflow or underflow leave no pixel undecided, for shapes of any kind.
#[test]
fn scenes_of_any_scale_are_proven() {
    for scale in ["e-150", "", "e150"] {
        let n = |number: &str| format!("{number}{scale}");
        let (one, two, three, four, half) = (n("1"), n("2"), n("3"), n("4"), n("0.5"));
        let model = model(&format!(
            "camera eye {{ pixeldim 24 18 worlddim {} {} viewpoint {four} {three} {} }}
             material m {{ ambient 1 0 0 }}
             sphere s {{ material m center {four} {three} -{four} radius {two} }}
             torus t {{ material m center {four} {three} -{four} direction 1 2 3 radius {three} tube {half} }}
             triangle q {{ material m vertex1 0 0 -{three} vertex2 {} 0 -{three} vertex3 {four} {} -{} }}
             revsurf v {{ material m profile \"{one} + 0*y\" direction 0.1 1 0 base {two} {one} -{three} height {three} }}
             quadric w {{ material m coefficients 1 1 -1 0 0 0 0 0 0 0 center {} {three} -{four}
                 box -{one} -{one} -{one} {one} {one} {one} }}",
            n("8"),
            n("6"),
            n("6"),
            n("8"),
            n("6"),
            n("5"),
            n("6"),
        ));
        let [_, ties, contradicted] = counts(&model, 1);
        assert_eq!((ties, contradicted), (0, 0), "{scale}");
    }
}

/// In f64, 6 times 8/15 is the viewer's 3.2, and a ray straight ahead never meets the wall at x = 0. In the numbers of the
/// scene it does, some 1e17 units away, and hides the background.
#[test]
fn a_ray_that_rounding_makes_parallel_to_a_plane_meets_it() {
    for (viewpoint, is_met) in [("3.2 4 7", true), ("3.1999999999999997 4 7", false)] {
        let text = format!(
            "camera eye {{ pixeldim 16 12 worlddim 8 6 viewpoint {viewpoint} }} material m {{ ambient 1 1 1 }}
             plane wall {{ material m normal 1 0 0 point 0 0 -6 }}"
        );
        let model = model(&text);
        let sight = model.camera.value.sight(6.0, 3.0);
        assert_eq!(trace::first_hit(&Plan::new(&model), &sight).is_some(), is_met, "{viewpoint}");
        let [_, ties, contradicted] = counts(&model, 1);
        assert_eq!((ties, contradicted), (0, 0), "{viewpoint}");
    }
}

#[test]
fn a_plane_keeps_its_shadows_and_mirrors_however_far_away_its_point_is() {
    let picture = |point: &str| {
        render(&model(&format!(
            "camera eye {{ pixeldim 64 48 worlddim 8 6 viewpoint 4 3 6 }}
             material white {{ ambient 1 1 1 diffuse 4 4 4 specular 0.3 }}
             plane floor {{ material white normal 0 1 0 point {point} }}
             sphere ball {{ material white center 4 2 -4 radius 1.4 }}
             light lamp {{ location 1 7 2 emissivity 20 20 20 }}"
        )))
    };
    let near = picture("0 0 0");
    for point in ["1e16 0 0", "1e150 0 -1e150"] {
        assert_eq!(picture(point), near, "{point}");
    }
}

/// Two coinciding surfaces are distinguished from two surfaces that are any distance apart.
#[test]
fn a_tie_is_a_tie_and_nothing_near_it() {
    let verdicts = |apart: &str| {
        let model = model(&format!(
            "camera eye {{ pixeldim 16 12 worlddim 8 5 viewpoint 4 3 6 }}
             material m {{ ambient 1 0 0 }}
             fplane rug {{ material m normal 0 2 1 point 2 {apart} -3 xdir 1 0 0 dimensions 4 4 }}
             plane floor {{ material m normal 0 2 1 point 0 0 -3 }}"
        ));
        counts(&model, 1)
    };
    assert!(verdicts("0")[1] > 5, "the rug lies on the floor");
    assert_eq!(verdicts("1e-30")[1..], [0, 0], "it floats");
    assert_eq!(verdicts("-1e-30")[1..], [0, 0], "it lies below");
}
