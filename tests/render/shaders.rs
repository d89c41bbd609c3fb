//! Shaders: entities that objects name, what they see of a point, and normals that they bend.

use crate::common::{model, render};
use image::RgbImage;
use tabray::scene::{self, Syntax, dump};

const EYE: &str = "camera eye { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 7 }
    material white { ambient 5 5 5 diffuse 3 3 3 }
    material black { ambient 0 0 0 diffuse 9 9 9 }
    material mirror { specular 1 }\n";

fn picture(text: &str) -> RgbImage {
    render(&model(&format!("{EYE}{text}")))
}

/// Returns the number of pixels that differ.
fn differing(one: &RgbImage, other: &RgbImage) -> usize {
    one.pixels().zip(other.pixels()).filter(|(one, other)| one != other).count()
}

#[test]
fn a_shader_by_number_by_its_type_and_by_its_entity_are_one() {
    let floor = |object: &str, shader: &str| {
        format!("{object} floor {{ material white normal 0 1 0 point 3 0 -2 shader {shader} }}")
    };
    for (number, name, entity) in [
        ("0", "tiles", "tiles own { width 0.5 on floor }"),
        ("1", "rainbow", "rainbow own { frequency 2 phase 0 brightness 6 }"),
        ("2", "rainbow_tiles", "rainbow_tiles own { width 0.5 }"),
    ] {
        let notes = picture(&floor("pplane", number));
        for object in ["pplane", "plane"] {
            assert_eq!(picture(&floor(object, name)), notes, "{object} {name}");
            assert_eq!(picture(&format!("{entity} {}", floor(object, "own"))), notes, "{object} {entity}");
        }
    }
    let ball = |object, shader: &str| {
        picture(&format!("{object} b {{ material white center 4 3 -3 radius 2 shader {shader} }}"))
    };
    assert_eq!(ball("psphere", "0"), ball("sphere", "angular"));
}

#[test]
fn a_surface_has_another_material_on_its_back() {
    let ball = |place: &str, look: &str| {
        picture(&format!(
            "material red {{ ambient 4 1 1 diffuse 2 1 0 specular 0.25 }} sides two {{ back red }}
            light lamp {{ location 3 4 3 emissivity 9 9 9 }} sphere b {{ {place} {look} }}"
        ))
    };
    for (place, own) in
        [("center 4 3 -3 radius 2", "material white"), ("center 4 3 0 radius 12", "material red")]
    {
        assert_eq!(ball(place, "material white shader two"), ball(place, own), "{place}");
    }
}

#[test]
fn a_shader_of_the_scene_comes_before_a_type_of_its_name() {
    let text =
        "tiles rainbow { width 1 } plane p { material white normal 0 0 1 point 0 0 -4 shader rainbow }";
    let tiles = "tiles t { width 1 } plane p { material white normal 0 0 1 point 0 0 -4 shader t }";
    assert_eq!(picture(text), picture(tiles));
}

#[test]
fn a_general_rainbow_agrees_with_the_notes_where_they_are_the_same() {
    // A frequency of 2, turned on by a whole turn.
    let general = "rainbow r { phase 6.283185307179586 }
        plane p { material white normal 0 0 1 point 4 3 -4 shader r }";
    let notes = "pplane p { material white normal 0 0 1 point 4 3 -4 shader 1 }";
    assert!(differing(&picture(general), &picture(notes)) < 30);
}

#[test]
fn a_shader_goes_with_a_copy() {
    let there = picture("sphere b { material white center 4 3 -3 radius 2 shader rainbow }");
    let pattern = |shader| format!("sphere o {{ material white center 0 0 0 radius 2 {shader} }}");
    let copy = |shader| format!("place c {{ object o material white translation 4 3 -3 {shader} }}");
    let moved = picture(&(pattern("shader rainbow") + &copy("")));
    let own = picture(&(pattern("") + &copy("shader rainbow")));
    assert_eq!(own, moved);
    assert!(differing(&moved, &there) < 10, "{}", differing(&moved, &there));
}

#[test]
fn formulas_of_numbers_look_like_a_material_of_these() {
    let plain = "material m { ambient 1 0.5 0.25 diffuse 2 2 2 }
        sphere b { material m center 4 3 -3 radius 2 } light l { location 2 7 3 emissivity 9 9 9 }";
    let formula = "let quarter 0.25 formula f { ambient 1 0.5 \"quarter\" diffuse 2 }
        sphere b { material black center 4 3 -3 radius 2 shader f } light l { location 2 7 3 emissivity 9 9 9 }";
    assert_eq!(picture(plain), picture(formula));
}

#[test]
fn a_formula_sees_u_v_the_normal_and_no_value_as_black() {
    // Each formula is 5 on the left half of what is seen, or everywhere, and 0 elsewhere.
    let half = |object: &str, formula: &str| {
        let scene = format!("formula f {{ ambient \"5*({formula})\" 0 0 }} {object} shader f }}");
        let picture = picture(&scene);
        let red = |columns: std::ops::Range<u32>| {
            columns
                .clone()
                .flat_map(|x| (0..48).map(move |y| (x, y)))
                .filter(|(x, y)| picture[(*x, *y)][0] > 0)
                .count()
        };
        [red(0..32) > 0, red(32..64) > 0]
    };
    let ball = "sphere b { material black center 4 3 -3 radius 2";
    assert_eq!(half(ball, "floor(1.5 - u)"), [true, false]);
    assert_eq!(half(ball, "max(0, -nx)"), [true, false]);
    assert_eq!(half(ball, "1 + ln(4 - x)*0"), [true, false]);
    assert_eq!(half(ball, "sqrt(4 - x)"), [true, false]);
    assert_eq!(half(ball, "v"), [true, true]);
    let wall = "fplane w { material black normal 0 0 1 point 0 0 -2 xdir 1 0 0 dimensions 8 6";
    assert_eq!(half(wall, "floor(1.5 - u)"), [true, false]);
    let face = "triangle t { material black vertex1 1 1 -2 vertex2 7 1 -2 vertex3 1 5 -2";
    assert_eq!(half(face, "floor(1.4 - u)"), [true, false]);
}

#[test]
fn bumps_without_height_leave_a_surface_as_it_is() {
    let lit = "light l { location 2 7 3 emissivity 9 9 9 }
        bumps flat { height \"0\" } torus t { material white center 4 3 -3 radius 2 tube 0.7 direction 0 1 1";
    assert!(differing(&picture(&format!("{lit} }}")), &picture(&format!("{lit} shader flat }}"))) < 5);
}

#[test]
fn bumps_bend_light_on_a_surface_and_on_its_copy() {
    let lit = "light l { location 2 7 3 emissivity 9 9 9 } bumps deep { height \"0.1*sin(9*x)*sin(9*y)\" }";
    let plain = picture(&format!("{lit} sphere b {{ material black center 4 3 -3 radius 2 }}"));
    let bumpy = picture(&format!("{lit} sphere b {{ material black center 4 3 -3 radius 2 shader deep }}"));
    assert!(differing(&plain, &bumpy) > 200);
    let copy = picture(&format!(
        "{lit} sphere o {{ material black center 4 3 -3 radius 2 shader deep }} place b {{ object o material black }}"
    ));
    assert!(differing(&copy, &bumpy) < 10);
}

#[test]
fn light_from_behind_does_not_reach_bent_normals() {
    let floor = |shader| {
        picture(&format!(
            "bumps deep {{ height \"sin(9*x)*sin(9*z)\" }} light l {{ location 4 -1 -4 emissivity 99 99 99 }}
             plane floor {{ material black normal 0 1 0 point 0 0 0 {shader} }}"
        ))
    };
    assert_eq!(floor("shader deep"), floor(""));
}

#[test]
fn what_bent_normals_mirror_is_before_the_surface() {
    let below = "bumps deep { height \"sin(9*x)*sin(9*z)\" }
        plane floor { material mirror normal 0 1 0 point 0 0 0 shader deep }
        plane cellar { material white normal 0 1 0 point 0 -5 0 }";
    assert!(picture(below).pixels().all(|pixel| pixel.0 == [0; 3]));
    let above = format!("{below} plane sky {{ material white normal 0 -1 0 point 0 9 0 }}");
    assert!(picture(&above).pixels().any(|pixel| pixel.0 != [0; 3]));
}

#[test]
fn formulas_are_the_same_in_either_syntax() {
    let text = format!(
        "{EYE} formula f {{ ambient \"5*x\" 0.5 \"nz\" diffuse \"v\" }} tiles t {{ width 2 on sidewall }}
         sphere a {{ material white center 4 3 -3 radius 1 shader f }}
         plane b {{ material white normal 0 0 1 point 0 0 -6 shader t }}"
    );
    let from = model(&text);
    let toml = dump::scene(&from, Syntax::Toml);
    assert!(toml.contains("ambient = [\"5*x\", \"0.5\", \"nz\"]"), "{toml}");
    let toml = toml.replace("\"0.5\"", "0.5");
    let registry = crate::common::registry();
    let again = scene::read(registry, "scene.toml", std::path::Path::new(""), toml.as_bytes(), None);
    let again = again.unwrap_or_else(|report| panic!("{report}")).model;
    assert_eq!(dump::scene(&again, Syntax::Notes), dump::scene(&from, Syntax::Notes));
    assert_eq!(render(&again), render(&from));
}

#[test]
fn one_formula_ends_at_the_next_attribute() {
    let shader = |text| {
        picture(&format!(
            "formula f {{ {text} }} sphere b {{ material black center 4 3 -3 radius 2 shader f }}"
        ))
    };
    assert_eq!(shader("ambient \"x\" diffuse 2"), shader("ambient \"x\" \"x\" \"x\" diffuse 2 2 2"));
    assert_eq!(shader("ambient 2 diffuse \"y\" specular 0"), shader("specular 0 diffuse \"y\" ambient 2"));
}

#[test]
fn a_shader_is_named_in_each_round() {
    let rounds = "repeat i 3 { tiles t { width \"0.25*(i + 1)\" }
        pplane p { material white normal 0 1 0 point 0 \"-i\" 0 shader t } }";
    let model = model(&format!("{EYE}{rounds}"));
    let text = dump::scene(&model, Syntax::Notes);
    assert!(text.contains("shader   t_2"), "{text}");
}

/// Returns the largest difference of two pictures' bytes.
fn off(one: &RgbImage, other: &RgbImage) -> u8 {
    one.iter().zip(other.iter()).map(|(one, other)| one.abs_diff(*other)).max().unwrap_or(0)
}

#[test]
fn a_formula_sees_how_a_sphere_bends() {
    // Of a sphere with a radius of 2, times 5.
    for (formula, expected) in
        [("5*4*gauss_curvature", "5"), ("5*2*mean_curvature", "5"), ("5*gradient/4", "5"), ("let", "2")]
    {
        let (before, formula) = if formula == "let" { ("let gradient 2", "gradient") } else { ("", formula) };
        let ball = |look: &str| {
            picture(&format!(
                "{before} formula f {{ ambient \"{look}\" 0 0 }} implicit b {{ material white formula \"x^2 + y^2 + z^2 - 4\"
                center 4 3 -3 box -3 -3 -3 3 3 3 shader f }}"
            ))
        };
        let found = ball(formula);
        assert!(found.iter().any(|byte| *byte > 0));
        assert!(off(&found, &ball(expected)) <= 1, "{formula}");
    }
}

#[test]
fn a_ramp_is_what_a_formula_says() {
    let ball = |shader: &str| {
        picture(&format!("{shader} sphere b {{ material white center 4 3 -3 radius 2 shader s }}"))
    };
    let ramp = ball("ramp s { by x from 3 to 5 colours 0 0 0  1 0.5 0  0 0 0 }");
    let formula = ball("formula s { ambient \"5*max(0, 1 - abs(x - 4))\" \"2.5*max(0, 1 - abs(x - 4))\" 0 }");
    assert!(off(&ramp, &formula) <= 1);
}

#[test]
fn lines_are_as_wide_as_they_say() {
    // A wall that is seen at a right angle: 16 pixels for 2 units.
    let wall = |shader: &str| {
        picture(&format!("{shader} plane w {{ material white normal 0 0 1 point 0 0 0 shader s }}"))
    };
    let dark = |picture: &RgbImage| picture.pixels().filter(|pixel| pixel.0 == [0; 3]).count();
    assert_eq!(dark(&wall("lines s { formula \"2*(x - 3.97)\" width 1 altmaterial black }")), 8 * 48);
    let levels = wall("lines s { formula \"2*(x - 3.97)\" spacing 4 width 0.5 altmaterial black }");
    assert_eq!(dark(&levels), 4 * 4 * 48);
}
