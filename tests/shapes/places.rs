//! Copies of objects in other places: they look as the same object written out there.

use crate::common::{model, render};
use std::path::Path;
use tabray::geometry::{MISS, RayRange};
use tabray::render::{Plan, trace};
use tabray::scene::{self, Registry};
use tabray::tools::verify::{self, Verdict};

const BEFORE: &str = "camera eye { pixeldim 160 120 worlddim 8 6 viewpoint 4 3 8 }
    material red { ambient 1 0.3 0.2 diffuse 5 2 1 specular 0.3 shininess 12 }
    material grey { ambient 0.4 0.4 0.5 diffuse 2 2 2.5 }
    texture bricks { filename scenes/textures/bricks.png }
    light lamp { location 1 9 5 emissivity 5 5 5 }
    plane floor { material grey normal 0 1 0 point 0 0 0 }\n";

/// Asserts that two scenes look the same but for the rounding of single pixels' bytes.
fn look_the_same(one: &str, other: &str) {
    look_the_same_in(BEFORE, one, other);
}

/// Asserts it of what follows a camera and what else is in the scene.
fn look_the_same_in(before: &str, one: &str, other: &str) {
    let [one_bytes, other_bytes] = [one, other].map(|scene| render(&model(&format!("{before}{scene}"))));
    let differences = || one_bytes.iter().zip(other_bytes.iter()).map(|(one, other)| one.abs_diff(*other));
    assert!(differences().all(|difference| difference <= 1), "{one}");
    let different = differences().filter(|difference| *difference > 0).count();
    assert!(different * 1000 <= one_bytes.len(), "{one}: {different}");
}

#[test]
fn few_hits_of_copies_of_implicit_surfaces_take_a_proof() {
    for pattern in [
        "cylinder o { material red base 0 -1 0 height 2 radius 1.2 }",
        "cylinder o { material red base 0 -1 0 height 2 radius 1.2 open yes }",
        "capsule o { material red base 0 -1 0 height 2 radius 1 }",
        "torus o { material red center 0 0 0 radius 1.3 tube 0.4 }",
        "heart o { material red center 0 0 0 size 1.2 }",
    ] {
        let place = "place p { object o scale 1 1.5 0.8 rotation 40 25 10 translation 4 3 -3 }";
        let camera =
            "camera eye { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 } material red { ambient 1 0 0 }";
        let model = model(&format!("{camera} {pattern} {place}"));
        let (plan, shape) = (Plan::new(&model), &model.objects[0].shape);
        let (mut hits, mut doubtful) = (0, 0);
        for (x, y) in (0..30).flat_map(|y| (0..40).map(move |x| (x, y))) {
            assert_eq!(verify::pixel(&plan, x, y).verdict, Verdict::Proven, "{pattern} {x} {y}");
            let sight = model.camera.value.sight(x as f64, y as f64);
            let bracket = shape.t_bounds(&sight.ray(), &RayRange::ALL);
            let hit = trace::first_hit(&plan, &sight).map_or(MISS, |hit| hit.distance);
            assert!(bracket.near <= hit && hit <= bracket.far, "{pattern} {x} {y}: {hit} and {bracket:?}");
            hits += usize::from(hit < MISS);
            doubtful += usize::from(bracket.is_doubtful());
            assert!(
                bracket.is_doubtful() || hit == MISS || bracket.far - bracket.near < 1e-9,
                "{pattern} {x} {y}: {bracket:?}"
            );
        }
        // Of the tube, all rays through an opening are in doubt.
        let most = if pattern.contains("open") { hits / 2 } else { hits / 20 };
        assert!(hits > 40 && doubtful <= most, "{pattern}: {doubtful} of {hits}");
    }
}

#[test]
fn copies_of_planes_end_where_planes_end_in_the_world() {
    let rectangle = |name: &str, corner: &str| {
        format!("fplane {name} {{ material red normal 0 1 0 point {corner} xdir 1 0 0 dimensions 4 8 }}\n")
    };
    let triangle = |name: &str, z: [f64; 2]| {
        let [near, far] = z;
        format!(
            "triangle {name} {{ material red vertex1 1 2 {near} vertex2 6 1 {near} vertex3 3 1 {far} }}\n"
        )
    };
    let copy = |of: &str, z: f64| format!("place {of}p {{ object {of} translation 0 0 {z} }}\n");
    for (copied, written) in [
        // In front of the pattern's own z = 0.01, but not of the world's; and the other way round.
        (rectangle("o", "2 1 4") + &copy("o", -4.0), rectangle("o", "2 1 0")),
        (rectangle("o", "2 1 0") + &copy("o", 4.0), rectangle("o", "2 1 4")),
        (rectangle("o", "2 1 9") + &copy("o", -4.0) + &copy("op", -1.0), rectangle("o", "2 1 4")),
        (triangle("o", [6.0, 0.0]) + &copy("o", -4.0), triangle("o", [2.0, -4.0])),
        (
            "plane o { material red normal 0 1 0.1 point 0 0 0 } place p { object o translation 0 -0.5 -6 }".into(),
            "plane p { material red normal 0 1 0.1 point 0 -0.5 -6 }".into(),
        ),
        (
            "plane o { material red normal 0 0 1 point 0 0 -0.01 } place p { object o translation 0 0 0.021 }".into(),
            String::new(),
        ),
    ] {
        for method in ["exact", "strict", "classic"] {
            let camera = format!("8 accuracy {method} }}");
            let scenes = [&copied, &written].map(|scene| format!("{BEFORE}{scene}").replacen("8 }", &camera, 1));
            let [copied, written] = scenes.map(|scene| model(&scene));
            assert_eq!(render(&copied), render(&written), "{method}: {:?}", copied.objects[1].args.name());
            let plan = Plan::new(&copied);
            for (x, y) in (0..12).flat_map(|y| (0..16).map(move |x| (10 * x, 10 * y))) {
                let is_open = method == "classic" && verify::pixel(&plan, x, y).verdict == Verdict::Tie;
                assert!(is_open || verify::pixel(&plan, x, y).verdict == Verdict::Proven, "{method} {x} {y}");
            }
        }
    }
}

#[test]
fn a_copy_on_a_floor_has_no_speckles_in_mirrors() {
    let floor = "plane floor { material red normal 0 1 0 point 0 0 0 }";
    for (translation, degrees, is_on_top) in [
        ([4.7, -5.2], 0.0, true),
        ([2.3, -4.1], 10.0, false),
        ([3.9, -3.4], 45.0, true),
        ([5.1, -5.9], 30.0, true),
    ] {
        let scene = |height: f64| {
            let [x, z] = translation;
            let rug = format!(
                "fplane own {{ material green normal 0 1 0 point -1.5 0 1 xdir 1 0 0 dimensions 3 2 }}
                 place rug {{ object own rotation 0 {degrees} 0 translation {x} {height} {z} }}"
            );
            let [one, other] = if is_on_top { [&*rug, floor] } else { [floor, &*rug] };
            format!(
                "camera eye {{ pixeldim 120 90 worlddim 8 6 viewpoint 4 3 6 }}
                 material red {{ ambient 9 0 0 }} material green {{ ambient 0 9 0 }} material m {{ specular 0.9 }}
                 fplane mirror {{ material m normal 0.2 0.1 1 point -1 0 -8 xdir 1 0 0 dimensions 10 7 }}
                 sphere ball {{ material m center 4 2 -5 radius 1.4 }} {one} {other}"
            )
        };
        // What comes first in the scene is seen, as if it lay on top.
        let apart = if is_on_top { 1e-6 } else { -1e-6 };
        let [coincident, apart] = [0.0, apart].map(|height| render(&model(&scene(height))));
        let is_other = |(one, other): (&u8, &u8)| one.abs_diff(*other) > 40;
        let different = coincident.iter().zip(apart.iter()).filter(|pair| is_other(*pair)).count();
        assert_eq!(different, 0, "{degrees} {translation:?}");
    }
}

#[test]
fn a_placed_object_looks_as_the_same_object_written_out() {
    for (pattern, placed, written) in [
        (
            "sphere o { material red center 0 0 0 radius 1 }",
            "place p { object o material red translation 3 1.5 -2 }",
            "sphere p { material red center 3 1.5 -2 radius 1 }",
        ),
        (
            "sphere o { material red center 1 0 0 radius 1 }",
            "place p { object o material red scale 0.5 0.5 0.5 rotation 0 0 90 translation 3 1.5 -2 }",
            "sphere p { material red center 3 2 -2 radius 0.5 }",
        ),
        (
            "sphere o { material red center 0 0 0 radius 1 }",
            "place p { object o material red scale 2 0.5 1 translation 4 1.5 -3 }",
            "ellipsoid p { material red center 4 1.5 -3 radius 1 scale 2 0.5 1 }",
        ),
        (
            "triangle o { material red vertex1 0 0 0 vertex2 2 0 0 vertex3 0 2 0 }",
            "place p { object o material red rotation 0 0 45 translation 4 1 -2 }",
            "triangle p { material red vertex1 4 1 -2 vertex2 5.414213562373095 2.414213562373095 -2
                vertex3 2.585786437626905 2.414213562373095 -2 }",
        ),
        (
            "triangle o { material red vertex1 0 -1 0 vertex2 -1 0 -2 vertex3 1.5 1 -1 }",
            "place p { object o material red rotation 1 1 1 120 translation 4.013 2.027 -3 }",
            "triangle p { material red vertex1 4.013 2.027 -4 vertex2 2.013 1.027 -3 vertex3 3.013 3.527 -2 }",
        ),
        (
            "mesh o { material red file scenes/models/knot.obj }",
            "place p { object o material red rotation 0 -3 4 77 translation 4 3 -2 }",
            "mesh p { material red file scenes/models/knot.obj rotation 0 -3 4 77 translation 4 3 -2 }",
        ),
        (
            "torus o { material red center 0 0 0 radius 1 tube 0.3 }",
            "place p { object o material red rotation 90 0 0 translation 4 2 -2 }",
            "torus p { material red center 4 2 -2 direction 0 0 1 radius 1 tube 0.3 }",
        ),
        (
            "texplane o { material grey normal 0 0 1 point 0 0 -1 xdir 1 0 0 dimensions 3 2 texname bricks mode 0 }",
            "place p { object o material grey translation 2 1 -2 }",
            "texplane p { material grey normal 0 0 1 point 2 1 -3 xdir 1 0 0 dimensions 3 2 texname bricks mode 0 }",
        ),
    ] {
        look_the_same(&format!("{pattern}\n{placed}"), written);
    }
}

#[test]
fn a_placed_place_is_placed_twice() {
    look_the_same(
        "sphere o { material red center 1 0 0 radius 0.5 }
         place turned { object o material red rotation 0 0 90 }
         place p { object turned material red scale 2 1 1 translation 3 1.5 -2 }",
        "ellipsoid p { material red center 3 2.5 -2 radius 0.5 scale 2 1 1 }",
    );
}

#[test]
fn a_copy_of_a_smooth_mesh_is_smooth() {
    let mesh = |place: &str| {
        format!("mesh o {{ material red file scenes/models/knot.obj smooth 1 rotation 50 0 20 {place} }}")
    };
    let copy = "place p { object o material red translation 4 2 -2 }";
    look_the_same(&format!("{}\n{copy}", mesh("")), &mesh("translation 4 2 -2"));
}

#[test]
fn a_copy_of_a_mesh_of_1e_150_or_1e150_looks_as_the_mesh_does() {
    // Boxes of such faces are of little use to a ray, so each takes many tests.
    let before = BEFORE.replace("160 120", "64 48");
    for (mesh, copy) in [("1e150", "1e-150"), ("1e-150", "1e150")] {
        for smooth in [0, 1] {
            let object = format!("material red file scenes/models/knot.obj smooth {smooth}");
            let place = "rotation 50 0 20 translation 4 2 -2";
            look_the_same_in(
                &before,
                &format!(
                    "mesh o {{ {object} scale {mesh} {mesh} {mesh} }}
                     place p {{ object o material red scale {copy} {copy} {copy} {place} }}"
                ),
                &format!("mesh p {{ {object} {place} }}"),
            );
        }
    }
}

#[test]
fn copies_of_copies_have_a_limit() {
    let copies = |count: usize| {
        let pattern = "sphere p0 { material red center 0 0 0 radius 1 }\n".to_owned();
        let copy = |index| format!("place p{} {{ object p{index} material red }}\n", index + 1);
        format!("{BEFORE}{pattern}{}", (0..count).map(copy).collect::<String>())
    };
    model(&copies(12));
    let registry = Registry::get().expect("no two plugins claim one name");
    let faults = scene::read(registry, "a.ray", Path::new(""), copies(40_000).as_bytes(), None);
    let faults = faults.err().expect("too deep").to_string();
    assert!(faults.contains("place `p13` is a copy of a copy, more than 12 deep"), "{faults}");
}

#[test]
fn an_object_that_is_placed_is_not_seen_elsewhere() {
    let scene = model(&format!(
        "{BEFORE}sphere o {{ material red center 4 3 -2 radius 1 }}
         place p {{ object o material red translation 0 0 2000 }}"
    ));
    assert!(render(&scene) == render(&model(BEFORE)));
}

#[test]
fn first_hits_of_placed_objects_are_proven() {
    let objects = [
        "sphere o { material red center 0 0 0 radius 1 }",
        "torus o { material red center 0 0 0 radius 0.8 tube 0.2 }",
        "triangle o { material red vertex1 0 0 0 vertex2 1 0 0 vertex3 0 1 0 }",
        "revsurf o { material red surfer 3 base 0 -1 0 direction 0 1 0 height 2 }",
    ];
    for object in objects {
        let mut scene = format!("{BEFORE}{object}\n");
        for (index, angle) in (0..12).zip((0..).step_by(37)) {
            scene += &format!(
                "place p{index} {{ object o material red scale 0.9 0.{} 0.6 rotation {angle} {} 45 translation {} {} -{index} }}\n",
                4 + index % 6,
                2 * angle,
                index % 5 * 2,
                1 + index % 3 * 2
            );
        }
        let model = model(&scene);
        let plan = Plan::new(&model);
        let mut proven = 0;
        for (x, y) in (0..120).step_by(3).flat_map(|y| (0..160).step_by(3).map(move |x| (x, y))) {
            let verdict = verify::pixel(&plan, x, y).verdict;
            assert!(verdict != Verdict::Contradicted, "{object}: {x} {y}");
            proven += usize::from(verdict == Verdict::Proven);
        }
        assert!(proven > 2140, "{object}: {proven}");
    }
}
