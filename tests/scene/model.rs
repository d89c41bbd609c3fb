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
            "`radius` of sphere `a\u{fffd}ball` must be positive, not -1.0",
        ]
    );
}
