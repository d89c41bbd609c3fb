//! Solids: what rays hit of shapes that are combined, also where their surfaces coincide, and how they look.

use crate::common::{model, registry, render};
use glam::DVec3;
use std::fmt::Write;
use std::path::Path;
use tabray::geometry::RayRange;
use tabray::render::{Plan, trace};
use tabray::scene;
use tabray::tools::verify::{self, Verdict};

/// A viewer who looks along -z from z = 6 through the middle of the only pixel.
const VIEWER: &str =
    "camera eye { pixeldim 1 1 worlddim 8 6 viewpoint 4 3 6 } material m { ambient 1 1 1 }\n";

/// Returns the distance and the part that a ray from (4, 3, 6) along -z hits first, and what is proven of that.
fn seen(solid: &str) -> (Option<(f64, String)>, Verdict) {
    let model = model(&format!("{VIEWER}{}", solid.replace("{ ", "{ material m ")));
    let plan = Plan::new(&model);
    let sight = model.camera.value.sight(0.0, 0.0);
    let hit = trace::first_hit(&plan, &sight).map(|hit| {
        let part = hit.object.shape.part(&sight.ray(), hit.distance).expect("a part");
        (hit.distance, part.split('`').nth(1).expect("a name").to_owned())
    });
    (hit, verify::pixel(&plan, 0, 0).verdict)
}

#[track_caller]
fn is_hit(solid: &str, hit: Option<(f64, &str)>) {
    let (found, verdict) = seen(solid);
    assert_eq!(found.as_ref().map(|(distance, part)| (*distance, &**part)), hit, "{solid}");
    assert!(verdict != Verdict::Contradicted, "{solid}");
}

#[test]
fn the_first_hit_is_where_the_solid_begins() {
    let (cube, hole) =
        ("box cube { center 4.1 3.2 -2 size 2 2 2 }", "sphere hole { center 4 3 -1 radius 0.5 }");
    for (operation, distance, part) in
        [("union", 6.5, "hole"), ("intersection", 7.0, "cube"), ("difference", 7.5, "hole")]
    {
        let solid = format!("{cube} {hole} {operation} s {{ objects cube hole }}");
        is_hit(&solid, Some((distance, part)));
        assert_eq!(seen(&solid).1, Verdict::Proven, "{operation}");
    }
}

#[test]
fn a_hole_flush_with_a_side_is_open() {
    is_hit(
        "box cube { center 4 3 -2 size 2 2 2 } box hole { center 4 3 -1.5 size 1 1 1 }
         difference s { objects cube hole }",
        Some((8.0, "hole")),
    );
    is_hit(
        "box cube { center 4 3 -2 size 2 2 2 } cylinder hole { base 4 3 -3 direction 0 0 1 height 2 radius 0.5 }
         difference s { objects cube hole }",
        None,
    );
    is_hit(
        "box a { center 4 3 -2 size 2 2 2 } box b { center 4 3 -2 size 2 2 2 } difference s { objects a b }",
        None,
    );
}

/// Boxes with sides in one plane, and cylinders with the same ends, as they are and turned. The ray does not pass through an
/// edge of two triangles.
const FLUSH: [(&str, Option<(f64, &str)>); 7] = [
    (
        "box cube { center 4.1 3.2 -2 size 2 2 2 } box hole { center 4.1 3.2 -1.5 size 1 1 1 }
         difference s { objects cube hole }",
        Some((8.0, "hole")),
    ),
    (
        "box near { center 4.1 3.2 2 size 2 2 2 } box far { center 4.1 3.2 0 size 1 1 2 } union s { objects near far }",
        Some((3.0, "near")),
    ),
    (
        "box near { center 4.1 3.2 2 size 2 2 2 } box far { center 4.1 3.2 0 size 1 1 2 } difference s { objects near far }",
        Some((3.0, "near")),
    ),
    (
        "cylinder tube { base 4 3 -3 direction 0 0 2 height 2 radius 1 }
         cylinder bore { base 4 3 -1 direction 0 0 -1 height 2 radius 0.5 } difference s { objects tube bore }",
        None,
    ),
    (
        "cylinder disc { base 4 3 -3 direction 0 7 24 height 1 radius 1 }
         cylinder core { base 4 3 -3 direction 0 7 24 height 1 radius 0.5 } union s { objects core disc }",
        Some((9.0 - 25.0 / 24.0, "core")),
    ),
    (
        "cylinder post { base 4.1 3.2 0 direction 0 0 -1 height 2 radius 1 } box foot { center 4.1 3.2 1 size 8 8 2 }
         union s { objects post foot }",
        Some((4.0, "foot")),
    ),
    (
        "box cube { center 0 0 0 size 2 2 2 } box hole { center 0 0 0.5 size 1 1 1 }
         difference cut { objects cube hole }
         place s { object cut rotation 0 0 10 translation 4.1 3.2 -2 }",
        Some((8.0, "hole")),
    ),
];

#[test]
fn sides_in_one_plane_take_no_proof() {
    for (solid, hit) in FLUSH {
        let found = seen(solid).0;
        let is_it = |(distance, part): &(f64, String)| {
            hit.is_some_and(|(at, name)| (distance - at).abs() < 1e-12 && part == name)
        };
        assert!(found.as_ref().map_or(hit.is_none(), is_it), "{solid}: {found:?}");
        let model = model(&format!("{VIEWER}{}", solid.replace("{ ", "{ material m ")));
        let ray = model.camera.value.sight(0.0, 0.0).ray();
        for object in &model.objects {
            let bracket = object.shape.t_bounds(&ray, &RayRange::ALL);
            assert!(!bracket.is_doubtful(), "{solid}: {bracket:?}");
        }
    }
}

#[test]
fn a_ray_through_an_edge_that_is_cut_away_goes_on() {
    let model = model(
        "camera eye { pixeldim 2 2 worlddim 3 3 viewpoint 2 2.5 6 } material m { ambient 1 1 1 }
         box block { material m center 4.5 4 -1.5 size 3 3 3 }
         box recess { material m center 4.5 3.1 -1 size 3 2 2 }
         difference cut { objects block recess }",
    );
    let plan = Plan::new(&model);
    // Through (3, 3, 0), which is on an edge of both boxes, to the far side of what is cut away.
    let hit = trace::first_hit(&plan, &model.camera.value.sight(1.0, 1.0)).expect("it is hit");
    assert!(
        (hit.point - DVec3::new(3.0 + 1.0 / 3.0, 3.0 + 1.0 / 6.0, -2.0)).length() < 1e-12,
        "{}",
        hit.point
    );
    assert!(verify::pixel(&plan, 1, 1).verdict != Verdict::Contradicted);
}

#[test]
fn a_part_may_be_as_long_as_numbers_go() {
    let rod =
        "ellipsoid rod { center 4 3 -3 radius 1 scale 1e307 2 2 } sphere ball { center 4 3 -9 radius 1 }";
    is_hit(&format!("{rod} union s {{ objects rod ball }}"), Some((7.0, "rod")));
    is_hit(&format!("{rod} difference s {{ objects ball rod }}"), Some((14.0, "ball")));
}

#[test]
fn shapes_that_share_a_side_are_one_where_they_are_joined() {
    let boxes = "box near { center 4 3 2 size 2 2 10 } box far { center 4 3 -4 size 2 2 2 }";
    is_hit(&format!("{boxes} union s {{ objects near far }}"), Some((11.0, "far")));
    // From inside of the near one, which is all that is left.
    is_hit(&format!("{boxes} difference s {{ objects near far }}"), Some((9.0, "near")));
    is_hit(&format!("{boxes} intersection s {{ objects near far }}"), None);
}

#[test]
fn edges_far_from_the_origin_are_seen_as_they_are_proven() {
    for (camera, parts) in [
        (
            "look_at eye { pixeldim 15 11 position -274877906945.5 274877906946.5 5.5
             target -274877906944.87396 274877906944.3796 0.41095676146983073 angle 0.001 up 0.1 1 0.05 }",
            "box cube { material m center -274877906944 274877906944 0 size 2 1.25 1 }
             cylinder post { material m base -274877906944.5 274877906944 0 height 1.25 radius 0.6875 }",
        ),
        (
            "look_at eye { pixeldim 13 9 position -1073741823.5 -4 3.5
             target -1073741823.35751 -0.6180236109118605 0.6066903026304885 angle 0.01 up 0.1 1 0.05 }",
            "prism cube { material m points 0.9620990257688207 0.013337537323191642 0.15039130056863928
             0.569488624852849 -0.9191781339199149 0.3929640479885439 -0.4891509354731841 0.11306928766691687
             -0.5125431029429288 0.03793912934967618 -0.002596526606314956 -0.47063994820736843
             0.4125424781207544 -0.6772561047337311 base -1073741824 0 0 height 1.6428333041442553 }
             capsule post { material m base -1073741824 0 0 height 0.2683207577139294 radius 0.9005934949970809
             direction -0.7999044120444354 0.6000722917428035 0.008134880108868203 }",
        ),
    ] {
        let material = "material m { ambient 1 1 1 }";
        let model = model(&format!("{camera} {material} {parts} difference s {{ objects cube post }}"));
        let (plan, [width, height]) = (Plan::new(&model), model.camera.value.pixels);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            assert_eq!(verify::pixel(&plan, x, y).verdict, Verdict::Proven, "{x} {y}: {parts}");
        }
    }
}

#[test]
fn surfaces_that_coincide_are_those_of_the_first_part() {
    let balls = "sphere one { center 4 3 -2 radius 1 } sphere other { center 4 3 -2 radius 1 }";
    for operation in ["union", "intersection"] {
        is_hit(&format!("{balls} {operation} s {{ objects one other }}"), Some((7.0, "one")));
        is_hit(&format!("{balls} {operation} s {{ objects other one }}"), Some((7.0, "other")));
    }
    is_hit(&format!("{balls} difference s {{ objects one other }}"), None);
}

#[test]
fn what_a_ray_only_touches_does_not_matter() {
    let cube = "box cube { center 4 3 -2 size 2 2 2 }";
    let ball = "sphere ball { center 4 4 -2 radius 1 }";
    is_hit(&format!("{cube} {ball} difference s {{ objects cube ball }}"), Some((7.0, "cube")));
    is_hit(&format!("{cube} {ball} union s {{ objects cube ball }}"), Some((7.0, "cube")));
    // A ball that touches the side from within, and one that touches it from outside.
    let within = "sphere ball { center 4 3 -2 radius 1 }";
    is_hit(&format!("{cube} {within} intersection s {{ objects cube ball }}"), Some((7.0, "cube")));
    let outside = "sphere ball { center 4 3 0 radius 1 }";
    is_hit(&format!("{cube} {outside} difference s {{ objects cube ball }}"), Some((7.0, "cube")));
}

#[test]
fn a_ray_that_starts_in_a_solid_leaves_it_where_it_ends() {
    let walls = "box walls { center 4 3 0 size 20 20 20 }";
    is_hit(
        &format!("{walls} sphere ball {{ center 4 3 -4 radius 1 }} difference s {{ objects walls ball }}"),
        Some((9.0, "ball")),
    );
    is_hit(
        &format!("{walls} sphere ball {{ center 4 3 6 radius 1 }} difference s {{ objects walls ball }}"),
        Some((1.0, "ball")),
    );
    is_hit(
        &format!("{walls} sphere ball {{ center 4 3 6 radius 1 }} intersection s {{ objects walls ball }}"),
        Some((1.0, "ball")),
    );
    is_hit(
        &format!("{walls} box more {{ center 4 3 -10 size 4 4 4 }} union s {{ objects walls more }}"),
        Some((18.0, "more")),
    );
}

#[test]
fn a_part_is_met_again_behind_what_is_cut_away() {
    let ring = "torus ring { center 4 3 -4 radius 2 tube 0.5 direction 0 1 0 }";
    let front = "box front { center 4 3 -1 size 4 4 4 }";
    is_hit(&format!("{ring} {front} difference s {{ objects ring front }}"), Some((11.5, "ring")));
    let half = "box half { center 4 3 -6 size 8 8 4 }";
    is_hit(&format!("{ring} {half} intersection s {{ objects ring half }}"), Some((11.5, "ring")));
}

#[test]
fn solids_are_combined_and_placed_within_each_other() {
    let die = "box cube { center 0 0 0 size 2 2 2 } sphere pip { center 0 0 1 radius 0.5 }
               difference die { objects cube pip }";
    let placed = "place p { object die translation 4 3 -2 }";
    is_hit(&format!("{die} {placed}").replace("{ objects", "{ objects"), Some((7.5, "pip")));
    let post = "cylinder post { base 4 3 -4 direction 0 0 1 height 2.75 radius 0.1 }";
    is_hit(&format!("{die} {placed} {post} union s {{ objects p post }}"), Some((7.25, "post")));
    is_hit(&format!("{die} {placed} {post} difference s {{ objects p post }}"), None);
}

const BEFORE: &str = "camera eye { pixeldim 160 120 worlddim 8 6 viewpoint 4 3 8 }
    material red { ambient 1 0.3 0.2 diffuse 5 2 1 specular 0.3 shininess 12 }
    material grey { ambient 0.4 0.4 0.5 diffuse 2 2 2.5 specular 0.2 0.2 0.2 }
    material glass { ambient 0.1 0.1 0.2 diffuse 1 1 2 transparency 0.6 }
    light lamp { location 1 9 5 emissivity 5 5 5 }
    plane floor { material grey normal 0 1 0 point 0 0 0 }\n";

/// Asserts that two scenes look the same but for the rounding of single pixels' bytes, and for single pixels at edges.
#[track_caller]
fn look_the_same(one: &str, other: &str) {
    let [one_bytes, other_bytes] = [one, other].map(|scene| render(&model(&format!("{BEFORE}{scene}"))));
    let differences = one_bytes.iter().zip(other_bytes.iter()).map(|(one, other)| one.abs_diff(*other));
    let different = differences.filter(|difference| *difference > 1).count();
    assert!(different * 2000 <= one_bytes.len(), "{one}: {different}");
}

#[test]
fn a_solid_casts_shadows_and_is_mirrored_as_the_same_shape_written_out() {
    look_the_same(
        "box all { material red center 4 1 -2 size 2 2 2 } box upper { material red center 4 2 -2 size 3 2 3 }
         difference s { objects all upper }",
        "box s { material red center 4 0.5 -2 size 2 1 2 }",
    );
    look_the_same(
        "sphere ball { material red center 4 1 -2 radius 1.5 } box part { material red center 4 2 -2 size 4 2 4 }
         intersection s { objects ball part }",
        "sphere ball { material red center 4 1 -2 radius 1.5 } box part { material red center 4 0 -2 size 4 2 4 }
         difference s { objects ball part }",
    );
    look_the_same(
        "sphere ball { material grey center 4 2 -2 radius 1.5 } torus ring { material red center 4 2 -2 radius 3 tube 0.2 }
         union s { objects ball ring }",
        "sphere ball { material grey center 4 2 -2 radius 1.5 } torus ring { material red center 4 2 -2 radius 3 tube 0.2 }",
    );
}

#[test]
fn glass_of_several_parts_has_no_walls_inside() {
    look_the_same(
        "box left { material glass center 3 1 -2 size 2 2 2 } box right { material glass center 4.5 1 -2 size 2 2 2 }
         union s { objects left right }",
        "box s { material glass center 3.75 1 -2 size 3.5 2 2 }",
    );
    look_the_same(
        "box all { material glass center 4 1 -2 size 2 2 2 } box upper { material glass center 4 2 -2 size 3 2 3 }
         difference s { objects all upper }",
        "box s { material glass center 4 0.5 -2 size 2 1 2 }",
    );
}

#[test]
fn a_placed_solid_is_one_of_placed_parts() {
    look_the_same(
        "sphere ball { material red center 0 0 0 radius 1 } box corner { material grey center 0.5 0.5 0.5 size 1 1 1 }
         difference s { objects ball corner } place p { object s scale 1.5 1 1 rotation 0 30 20 translation 4 1.5 -2 }",
        "sphere ball0 { material red center 0 0 0 radius 1 } box corner0 { material grey center 0.5 0.5 0.5 size 1 1 1 }
         place ball { object ball0 scale 1.5 1 1 rotation 0 30 20 translation 4 1.5 -2 }
         place corner { object corner0 scale 1.5 1 1 rotation 0 30 20 translation 4 1.5 -2 }
         difference s { objects ball corner }",
    );
}

#[test]
fn parts_have_their_own_materials_unless_the_solid_has_one() {
    let parts = "sphere ball { material red center 4 1 -2 radius 1 } box corner { material glass center 4.5 1.5 -1.5 size 1 1 1 }";
    let materials = |solid: &str| -> Vec<f64> {
        let model = model(&format!("{BEFORE}{parts} {solid}"));
        model.objects.iter().skip(1).map(|object| object.material.transparency).collect()
    };
    assert_eq!(materials("difference s { objects ball corner }"), [0.0, 0.6]);
    assert_eq!(materials("difference s { material grey objects ball corner }"), [0.0, 0.0]);
    assert_eq!(materials("difference s { objects ball corner } place p { object s }"), [0.0, 0.6]);
    assert_eq!(
        materials("difference s { objects ball corner } place p { object s material glass }"),
        [0.6, 0.6]
    );
    assert_eq!(materials("place p { object ball } place q { object corner }"), [0.0, 0.6]);
}

#[test]
fn solids_of_classic_scenes_are_made_of_exact_parts() {
    let text = format!(
        "{VIEWER}sphere a {{ material m center 4 3 -2 radius 1 }} sphere b {{ material m center 4 3 -1 radius 0.5 }}
         difference s {{ objects a b }}"
    )
    .replace("pixeldim", "accuracy classic pixeldim");
    let model = model(&text);
    let sight = model.camera.value.sight(0.0, 0.0);
    let hit = trace::first_hit(&Plan::new(&model), &sight).expect("a hit");
    assert_eq!(hit.distance, 7.5);
}

/// Returns the messages about a scene that must be refused.
fn refused(text: &str) -> String {
    match scene::read(registry(), "scene", Path::new(""), text.as_bytes(), None) {
        Ok(_) => panic!("it is read: {text}"),
        Err(report) => report.to_string(),
    }
}

/// Each solid of a chain has all parts of those before it, and each part has conditions on the others.
#[test]
fn a_chain_of_solids_is_read_and_one_without_end_is_refused() {
    let chain = |links: usize| {
        let mut text = format!(
            "{VIEWER}sphere d0 {{ material m center 4 3 -2 radius 2 }} box cut {{ material m center 4 3 0 size 1 1 1 }}\n"
        );
        for link in 1..=links {
            writeln!(text, "difference d{link} {{ objects d{} cut }}", link - 1).expect("a string");
        }
        text
    };
    assert_eq!(model(&chain(256)).patterns.len(), 257);
    let said = refused(&chain(2000));
    assert!(said.contains("difference `d257` nests solids more than 256 deep"), "{said}");
}

#[test]
fn of_too_many_objects_it_is_their_number_that_is_told() {
    let (mut text, mut names) = (VIEWER.to_owned(), String::new());
    for index in 0..300 {
        writeln!(text, "sphere s{index} {{ material m center {index} 3 -2 radius 2 }}").expect("a string");
        write!(names, " s{index}").expect("a string");
    }
    let said = refused(&format!("{text} union u {{ objects{names} material m }}"));
    assert!(said.contains("`objects` of union `u` takes 2 to 256 object names, not 300 values"), "{said}");
    assert_eq!(said.matches("error: ").count(), 1, "{said}");
}
