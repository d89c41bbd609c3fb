//! Tests of files of other programs.

use super::*;
use expression::{Dialect, Names, Value};
use glam::DVec3;
use std::path::Path;
use tabray_lang::import::scene;
use tabray_lang::reader;
use tabray_lang::registry::Registry;

struct Nothing;

impl Names for Nothing {
    fn value(&self, name: &str) -> Option<Value> {
        (name == "a").then(|| Value::named("a", 0.5))
    }

    fn function(&mut self, _formula: &str) -> String {
        "turned".to_owned()
    }

    fn help(&self, _name: &str) -> String {
        String::new()
    }
}

fn written(formula: &str, dialect: Dialect) -> String {
    match expression::read(formula, 0..formula.len(), dialect, &mut Nothing) {
        Ok(value) => value.text,
        Err(fault) => format!("{} at {:?}", fault.message, fault.place),
    }
}

#[test]
fn formulas_mean_what_each_program_takes_them_for() {
    let both = [
        ("x^2+y^2-1", "x^2 + y^2 - 1"),
        ("x-(y-z)", "x - (y - z)"),
        ("(x-y)-z", "x - y - z"),
        ("x/(y*z)/2", "x/(y*z)/2"),
        ("(x+y)^2*(3*z)", "(x + y)^2*(3*z)"),
        (".5*x + 2.*y", "0.5*x + 2*y"),
        ("sqrt(5)*a", "sqrt(5)*a"),
        ("2x(y+1)", "2*x*(y + 1)"),
        ("1.5e-3*x", "1.5e-3*x"),
    ];
    for (formula, expected) in both {
        for dialect in [Dialect::Surfer, Dialect::Surf] {
            assert_eq!(written(formula, dialect), expected, "{formula}");
        }
    }
    for (formula, surfer, surf) in [
        ("-x^2", "-x^2", "(-x)^2"),
        ("2^3^2", "2^(3^2)", "(2^3)^2"),
        ("x*-y", "x*(-y)", "x*(-y)"),
        ("x^-1", "x^(-1)", "x^(-1)"),
    ] {
        assert_eq!(
            [written(formula, Dialect::Surfer), written(formula, Dialect::Surf)],
            [surfer, surf],
            "{formula}"
        );
    }
    // The surface is rotated, and so the inverse rotation applies to its points.
    assert_eq!(
        written("rotate(x, 2*a, zAxis) + 0", Dialect::Surf).replace(char::is_numeric, ""),
        "turned(.*x + .*y, -.*x + .*y, z) + "
    );
}

#[test]
fn a_fault_in_a_formula_has_its_place() {
    for (formula, fault) in [
        ("x^2+", "a number or a name is missing here at Some(4..4)"),
        ("(x", "a closing parenthesis is missing here at Some(2..2)"),
        ("x)", "this parenthesis closes nothing at Some(1..2)"),
        ("x+b", "`b` has no value at Some(2..3)"),
        ("x&y", "the formula cannot continue like this at Some(1..2)"),
        ("besselj(x)", "the function `besselj` is not read at Some(0..7)"),
        ("1e999*x", "this is not a number at Some(0..5)"),
    ] {
        assert_eq!(written(formula, Dialect::Surfer), fault, "{formula}");
    }
    let deep = "(".repeat(1000);
    assert!(written(&deep, Dialect::Surf).starts_with("the formula nests more than 200 deep here"));
}

/// Returns the scene of a file, which must be valid, the omitted words, and the warnings.
fn imported(name: &str, text: &str) -> (String, Vec<(String, usize)>, String) {
    let Imported { text, warnings, left } = scene(name, text.as_bytes())
        .unwrap_or_else(|report| panic!("{report}"))
        .expect("a file of another program");
    let registry = Registry::get().expect("the entity types of tabray");
    if let Err(report) = reader::read(registry, "a.ray", Path::new(""), text.as_bytes(), None) {
        panic!("{report}\n{text}");
    }
    (text, left, warnings.short())
}

const JSURF: &str = "\
#jSurfer surface description
surface_equation=x^2+y^2-a*z \\
 - b
surface_parameter_a=1.5
surface_parameter_b=0.25
surface_parameter_c=7
scale_factor=0.5
rotation_matrix=0.0 -1.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 1.0
camera_height=2.0
camera_transform=1.0 0.0 0.0 -0.0 0.0 1.0 0.0 -0.0 0.0 0.0 1.0 -1.0 0.0 0.0 0.0 1.0
front_material_color=1.0 0.5 0.0
front_material_ambient_intensity=0.4
front_material_diffuse_intensity=0.8
front_material_specular_intensity=0.5
front_material_shininess=30.0
back_material_color=0.0 0.5 1.0
light_status_0=ON
light_position_0=-100.0 100.0 100.0
light_intensity_0=0.5
light_status_1=OFF
light_position_1=1.0 1.0 1.0
background_color: 1.0 1.0 1.0
surface_title=A bowl
";

#[test]
fn a_file_of_surfer_is_a_scene() {
    let (text, left, warnings) = imported("bowl.jsurf", JSURF);
    assert!(text.contains("let a 1.5\nlet b 0.25\n") && !text.contains("let c"), "{text}");
    assert!(text.contains("x^2 + y^2 - a*z - b"), "{text}");
    assert!(text.contains("width    6.32455532034\n"), "{text}");
    // The direction up in the picture is the surface's -x.
    assert!(text.contains("up       -3.16227766017 0 0\n"), "{text}");
    assert!(text.contains("ambient 0.4 0.2 0") && text.contains("sides both { back back }"), "{text}");
    assert_eq!(text.matches("\nlight ").count(), 1, "{text}");
    assert_eq!(left, [("surface_title".to_owned(), 23)]);
    assert!(text.contains("    highlight 0.5\n    shininess 30\n"), "{text}");
    assert_eq!(warnings, "");
}

const SURF: &str = "\
// A ball beside the middle
width = 300; height = 200; antialiasing = 4; root_finder = d_chain_bisection;
double a = 3; double b = a/3;
poly square = (x - a)^2;
/* turned as rot_x turns */
surface = square + (y - b)^2 + (z - 2)^2 - 1;
rot_x = 0.5; rot_y = 0.7; rot_z = -0.4;
scale_y = 0.5; scale_x = 0.5; scale_z = 0.5;
surface_red = 255; surface_green = 0; surface_blue = 51;
illumination = ambient_light + diffuse_light; ambient = 40; diffuse = 80; transparence = 20;
clip = sphere; radius = 8;
draw_surface;
filename = \"a;b.ppm\"; save_color_image;
";

#[test]
fn a_script_of_surf_is_a_scene() {
    let (text, left, warnings) = imported("ball.pic", SURF);
    assert!(text.contains("let a 3\nlet b \"a/3\"\n"), "{text}");
    assert!(text.contains("(x - a)^2 + (y - b)^2 + (z - 2)^2 - 1"), "{text}");
    assert!(text.contains("pixeldim 300 200") && text.contains("width    15"), "{text}");
    assert!(text.contains("sphere cut { material front  center 0 0 0  radius 4 }"), "{text}");
    assert!(text.contains("    clip     cut\n"), "{text}");
    assert!(text.contains("ambient 0.4 0 0.08"), "{text}");
    let left: Vec<_> = left.iter().map(|(word, line)| format!("{word} {line}")).collect();
    assert_eq!(left, ["antialiasing 2", "root_finder 2", "filename 13", "save_color_image 13"]);
    assert!(warnings.contains("the transparency of a surface is left out"), "{warnings}");
}

#[test]
fn a_surface_lies_in_the_picture_where_surf_draws_it() {
    let mut notes = Notes { report: Report::new("a", "", Syntax::Notes), left: Vec::new() };
    // The positions of the middle of the ball around 3 1 2 are measured in pictures of surf 1.0.6.
    for (script, [x, y]) in [
        ("", [3.0, 1.0]),
        ("rot_x = 0.5;", [3.0, -0.081]),
        ("rot_y = 0.5;", [1.674, 1.0]),
        ("rot_z = 0.5;", [2.153, 2.316]),
        ("rot_x = 0.5; rot_y = 0.7; rot_z = -0.4;", [0.622, -1.112]),
        ("rot_x = 0.5; scale_y = 0.5;", [3.0, -0.163]),
        ("rot_z = 0.5; origin_x = 3;", [4.786, 3.754]),
        ("surface = rotate(surface, 0.5, xAxis);", [3.0, -0.081]),
        ("surface = rotate(surface, 0.5, yAxis);", [1.674, 1.0]),
    ] {
        let script = format!("surface = (x-3)^2+(y-1)^2+(z-2)^2-1; {script} draw_surface;");
        let picture = surf::read(&script, &mut notes).expect("a picture");
        let (map, offset) = picture.surfaces[0].map;
        let seen = map.inverse() * (DVec3::new(3.0, 1.0, 2.0) - offset);
        assert!((seen.x - x).abs() < 2e-3 && (seen.y - y).abs() < 2e-3, "{script}: {seen}");
    }
}

#[test]
fn a_stretched_surface_and_several_are_scenes() {
    let (text, ..) =
        imported("a.surf", "surface = x^2+y^2+z^2-9; scale_x = 0.5; clip = cube; radius = 5; draw_surface;");
    assert!(
        text.contains("formula_1(0.5*x, y, z)")
            && text.contains("box cut { material front  center 0 0 0  size 10 10 10 }"),
        "{text}"
    );
    let (text, ..) = imported(
        "a.surf",
        "surface = x; surface2 = rotate(y + z^2, 1, xAxis) - 1; clip = cylinder; clip_front = 3; clip_back = -2; draw_surface;",
    );
    assert!(text.contains("implicit surface2") && text.contains("let turned(x, y, z)"), "{text}");
    assert!(
        text.contains("base      0 0 -2\n    direction 0 0 1\n    height    5\n    radius    10\n"),
        "{text}"
    );
    // The ball is cut in front; the cube is turned with the picture.
    let (text, ..) = imported("a.surf", "surface = x*y*z - 1; radius = 5; clip_front = 3; draw_surface;");
    assert!(text.contains("box slab { material front  center 0 0 -2.25  size 15 15 10.5 }"), "{text}");
    assert!(text.contains("intersection cut { objects ball slab }") && !text.contains("if("), "{text}");
    let (text, ..) =
        imported("a.surf", "surface = x*y*z - 1; clip = cube; radius = 5; rot_z = 0.5; draw_surface;");
    assert!(text.contains("place cut { object straight  rotation 0 0 "), "{text}");
}

#[test]
fn files_are_told_by_their_names_and_texts() {
    let is_one =
        |name: &str, text: &str| scene(name, text.as_bytes()).map_or_else(|_| true, |found| found.is_some());
    assert!(
        is_one("a.jsurf", "") && is_one("a.PIC", "") && is_one("<stdin>", SURF) && is_one("a.txt", JSURF)
    );
    assert!(
        !is_one("a.ray", SURF)
            && !is_one("a.toml", JSURF)
            && !is_one("<stdin>", "camera eye { pixeldim 1 1 }")
    );
}

#[test]
fn what_is_wrong_with_a_file_is_marked_in_it() {
    for (name, text, fault) in [
        ("a.jsurf", "scale_factor=1\n", "a.jsurf:1:1: error: this file has no `surface_equation`\n"),
        ("a.jsurf", "surface_equation=x+a\n", "a.jsurf:1:20: error: `a` has no value\n"),
        (
            "a.jsurf",
            "surface_equation=x\nrotation_matrix=1 2 3\n",
            "a.jsurf:2:17: error: `rotation_matrix` must be 16 numbers\n",
        ),
        ("a.surf", "surface = x^2 +* y;\n", "a.surf:1:16: error: this cannot be part of a formula\n"),
        ("a.surf", "int i = 1;\nloop:\ni = i + 1;\n", "a.surf:2:1: error: a script with jumps is not read\n"),
        ("a.surf", "surface = x", "a.surf:1:1: error: this statement has no end\n"),
        ("a.surf", "double a = 1;", "a.surf:1:1: error: this script has no surface\n"),
        ("a.surf", "surface = x; width = 0;", "a.surf:1:14: error: `width` cannot be 0\n"),
    ] {
        match scene(name, text.as_bytes()) {
            Err(report) => assert!(report.short().starts_with(fault), "{}", report.short()),
            Ok(_) => panic!("{text} has a fault"),
        }
    }
}

#[test]
fn a_script_that_multiplies_ends() {
    let mut script = "poly p = x + y + z;".to_owned();
    script += &"p = p*p;".repeat(60);
    script += "surface = p; draw_surface;";
    let report = scene("a.surf", script.as_bytes()).map(|_| ()).expect_err("the formula is too long");
    assert!(report.short().contains("has more than 1048576 letters"), "{}", report.short());
}

#[test]
fn a_script_of_many_sums_of_others_ends() {
    let mut script = "poly p0 = x;".to_owned();
    for index in 1..6000 {
        script += &format!("poly p{index} = p{} + y + y + y + y + y + y + y + y;", index - 1);
    }
    script += "surface = p1; draw_surface;";
    let report = scene("a.surf", script.as_bytes()).map(|_| ()).expect_err("they are too long");
    assert!(report.short().contains("have more than 67108864 letters together"), "{}", report.short());
}

#[test]
fn each_value_of_a_variable_has_its_own_name() {
    let script = "double a = 2; a = 3; double a_2 = 4; a = 5; surface = a*x + a_2; draw_surface;";
    let (text, ..) = imported("a.surf", script);
    for line in ["let a_2_2 4", "let a_3 5", "a_3*x + a_2_2"] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

#[test]
fn a_long_formula_is_first_shown_with_fewer_samples() {
    for (terms, samples) in [(1, "samples  4 "), (40, "samples  1 ")] {
        let formula = vec!["x^2*y"; terms].join("+");
        let surface = format!("#Surfer\nsurface_equation={formula}-1\n");
        let (text, ..) = imported("long.jsurf", &surface);
        assert!(text.contains(samples) && text.contains("`--size 1000 --samples 16` shows more"), "{text}");
    }
}
