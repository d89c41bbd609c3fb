//! A model built in Rust is the model that a text gives (the notes' `modelstat.c`).

use crate::common::{model, registry, render};
use tabray::scene::{self, Parsed, Syntax, dump};

const TEXT: &str = "
camera cam1 { pixeldim 80 60 worlddim 8 6 viewpoint 4 3 6 }
material green  { ambient 0 5 0 }
material yellow { ambient 6 5 0 diffuse 3 3 0 specular 0.25 shininess 20 }
material gray   { ambient 4 4 4 diffuse 2 2 2 }
plane leftwall  { material green  normal 3 0 1  point 0 0 0 }
plane rightwall { material yellow normal -3 0 1 point 8 0 0 }
plane floor     { material gray   normal 0 1 0  point 0 0 0 }
light lamp      { location 4 5.5 -1 emissivity 6 6 6.5 }
";

fn modelstat() -> Vec<Parsed<'static>> {
    let plane = |name, material: &'static str, normal: [f64; 3], point: [f64; 3]| {
        Parsed::new("plane", name).set("material", material).set("normal", normal).set("point", point)
    };
    vec![
        Parsed::new("camera", "cam1")
            .set("pixeldim", [80, 60])
            .set("worlddim", [8.0, 6.0])
            .set("viewpoint", [4.0, 3.0, 6.0]),
        Parsed::new("material", "green").set("ambient", [0.0, 5.0, 0.0]),
        Parsed::new("material", "yellow")
            .set("ambient", [6.0, 5.0, 0.0])
            .set("diffuse", [3.0, 3.0, 0.0])
            .set("specular", 0.25)
            .set("shininess", 20.0),
        Parsed::new("material", "gray").set("ambient", [4.0; 3]).set("diffuse", [2.0; 3]),
        plane("leftwall", "green", [3.0, 0.0, 1.0], [0.0; 3]),
        plane("rightwall", "yellow", [-3.0, 0.0, 1.0], [8.0, 0.0, 0.0]),
        plane("floor", "gray", [0.0, 1.0, 0.0], [0.0; 3]),
        Parsed::new("light", "lamp").set("location", [4.0, 5.5, -1.0]).set("emissivity", [6.0, 6.0, 6.5]),
    ]
}

#[test]
fn a_built_model_gives_the_same_picture_and_dump_as_its_text() {
    let built = scene::build(registry(), modelstat()).unwrap_or_else(|report| panic!("{report}")).model;
    let read = model(TEXT);
    assert_eq!(dump::scene(&built, Syntax::Notes), dump::scene(&read, Syntax::Notes));
    let picture = render(&built);
    assert!(picture == render(&read));
    assert!(picture.pixels().any(|pixel| pixel.0 != [0; 3]), "the picture shows something");
}

#[test]
fn a_built_model_is_checked_as_a_text_is() {
    let mut entities = modelstat();
    entities[1] = Parsed::new("material", "green").set("ambient", [0.0, 5.0]);
    entities.push(
        Parsed::new("sphere", "a\nball").set("material", "gray").set("center", [0.0; 3]).set("radius", -1.0),
    );
    let Err(report) = scene::build(registry(), entities) else { panic!("faults") };
    let messages: Vec<_> = report.faults().iter().map(|fault| fault.message.as_str()).collect();
    assert_eq!(
        messages,
        [
            "`ambient` of material `green` takes 3 numbers, not 2",
            "`a\\nball` cannot be a name",
            "`radius` of sphere `a\\nball` must be positive, not -1.0",
        ]
    );
}

#[test]
fn objects_with_the_same_values_have_the_same_shape() {
    let shaped = |text: &str| {
        let head = "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }
            material m { ambient 1 1 1 } material n { ambient 2 1 1 } ";
        let objects = model(&(head.to_owned() + text)).objects;
        let [one, other] = &objects[..] else { panic!("{} objects", objects.len()) };
        one.is_shaped_as(other)
    };
    let torus = "torus a { material m center 4 3 -3 radius 1 tube 0.5 }";
    let to_torus = |other: &str| shaped(&format!("{torus} torus b {{ center 4 3 -3 {other} }}"));
    assert!(to_torus("material n radius 1 tube 0.5 direction 0 1 0"), "the direction is the default");
    assert!(!to_torus("material m radius 1 tube 0.25"));
    assert!(!shaped(&format!("{torus} sphere b {{ material m center 4 3 -3 radius 1 }}")));
    let formulas = |one: &str, other: &str| {
        let surface = |name: &str, formula: &str| {
            format!("implicit {name} {{ material m formula \"{formula}\" box -1 -1 -3 1 1 2 }}\n")
        };
        shaped(&(surface("a", one) + &surface("b", other)))
    };
    assert!(formulas("x^2 + y^2 - z", "x^2 + y^2 - z"));
    assert!(!formulas("x^2 + y^2 - z", "x^2 + y^3 - z"));
    // The objects are the parts of a solid.
    let block = |name: &str, wide: f64| format!("box {name} {{ material m center 0 0 -3 size {wide} 1 1 }}");
    assert!(!shaped(&format!("{} {} union u {{ objects x y }}", block("x", 1.0), block("y", 2.0))));
}

#[test]
fn equal_objects_look_as_the_first_of_them() {
    let hearts = |which: [&str; 2]| {
        let [one, other] = which;
        render(&model(&format!(
            "camera eye {{ pixeldim 48 36 worlddim 8 6 viewpoint 4 3 6 }} material red {{ ambient 6 1 1 }}
             material blue {{ ambient 1 1 6 }} light lamp {{ location 1 7 3 emissivity 9 9 9 }} {one} {other}"
        )))
    };
    let heart =
        |name: &str, material: &str| format!("heart {name} {{ material {material} center 4 3 -3 size 2 }}");
    let (red, blue) = (heart("a", "red"), heart("b", "blue"));
    assert!(hearts([&red, &blue]) == hearts([&red, ""]));
    assert!(hearts([&blue, &red]) == hearts([&blue, ""]));
}

#[test]
fn an_entity_whose_attributes_all_have_defaults_may_be_empty() {
    let scene = |metal: &str, sky: &str| {
        model(&format!(
            "camera eye {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }} metal m {{ {metal} }} sky day {{ {sky} }}
            sphere ball {{ material m center 4 3 -3 radius 1 }}"
        ))
    };
    let given = registry().find("sky").expect("a sky").attributes();
    let given: Vec<_> =
        given.map(|attribute| (attribute.name(), attribute.default().expect("a default"))).collect();
    let (name, default) = &given[0];
    let sky = Syntax::Notes.pair(name, &Syntax::Notes.values(default));
    assert_eq!(render(&scene("", "")), render(&scene("", &sky)));
}
