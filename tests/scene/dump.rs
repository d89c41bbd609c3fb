//! A dump as a scene, in either syntax, loads again to the identical model.

use crate::common;
use crate::common::{load, model, model_in, registry, root, scenes};
use proptest::prelude::*;
use std::path::Path;
use tabray::exact::formula::variables::{CURVE, HEIGHT, PATCH};
use tabray::scene::{
    self, Attribute, Counts, Datum, Entity, Fault, Kind, Model, Severity, Syntax, Type, dump,
};

/// Returns every value of a model, to its last bit.
fn values(model: &Model) -> Vec<String> {
    let items = [&model.camera.args]
        .into_iter()
        .chain(model.materials.iter().map(|item| &item.args))
        .chain(model.textures.iter().map(|item| &item.args))
        .chain(model.objects.iter().map(|object| &object.args))
        .chain(model.lights.iter().map(|item| &item.args))
        .chain(model.background.iter().map(|item| &item.args));
    items
        .flat_map(|record| {
            let value = |(attribute, datum): (&dyn Attribute, &Datum)| match datum {
                Datum::Numbers(numbers) => {
                    let bits: Vec<_> = numbers.iter().map(|number| number.to_bits()).collect();
                    format!("{} {} {bits:x?}", record.name(), attribute.name())
                }
                other => format!("{} {} {other:?}", record.name(), attribute.name()),
            };
            record.args().values().map(value).collect::<Vec<_>>()
        })
        .collect()
}

fn assert_loads_again(first: &Model) {
    for syntax in [Syntax::Notes, Syntax::Toml] {
        let text = dump::scene(first, syntax);
        let again = model_in(&first.camera.args.args().setting.folder, &text);
        assert_eq!(values(first), values(&again), "{text}");
        assert_eq!(text, dump::scene(&again, syntax));
        assert_eq!(dump::notes(first), dump::notes(&again), "{text}");
    }
}

#[test]
fn every_scene_survives_its_dump() {
    for path in scenes() {
        assert_loads_again(&load(&path));
    }
}

#[test]
fn a_formula_on_several_lines_is_dumped_on_one() {
    let camera = "camera eye { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 } material red { ambient 1 0 0 }";
    let egg = "implicit egg { material red formula \"x^2 \\\n   + y^2 \\\r\n - 1\" box -2 -2 -2 2 2 2 }";
    let toml = dump::scene(&model(&format!("{camera} {egg}")), Syntax::Toml);
    assert!(toml.contains("\"x^2 + y^2 - 1\""), "{toml}");
    let on_lines = toml.replace("\"x^2 + y^2 - 1\"", "\"\"\"\nx^2\n + y^2 - 1\"\"\"");
    assert_loads_again(&model(&on_lines));
    assert_eq!(dump::scene(&model(&on_lines), Syntax::Toml), toml);
}

#[test]
fn a_dumped_scene_gives_the_same_picture() {
    for path in scenes().iter().filter(|path| path.to_string_lossy().contains("material")) {
        let picture = |mut model: Model| {
            // Mirrors that touch cost 20,000 rays per pixel, so a few pixels of them have to do.
            if path.ends_with("touching-mirrors.ray") {
                model.camera.value.pixels = [16, 12];
            }
            common::render(&model)
        };
        let first = load(path);
        let dumped = [Syntax::Notes, Syntax::Toml].map(|syntax| model(&dump::scene(&first, syntax)));
        let original = picture(first);
        assert!(dumped.map(picture).iter().all(|picture| *picture == original), "{}", path.display());
    }
}

proptest! {
    // Values are generated until they satisfy their rules.
    #![proptest_config(ProptestConfig { failure_persistence: None, max_local_rejects: 1 << 22, ..ProptestConfig::default() })]

    #[test]
    fn any_scene_survives_its_dump(text in any_scene()) {
        match scene::read(registry(), "any", Path::new(""), text.as_bytes(), None) {
            Ok(loaded) => assert_loads_again(&loaded.model),
            // Only faults that no single attribute shows are allowed.
            Err(report) => {
                let mut errors = report.faults().iter().filter(|fault| fault.severity == Severity::Error);
                prop_assert!(errors.all(of_a_constructor), "{report}");
            }
        }
    }
}

/// Tells whether a fault is one that only a constructor finds, or the warning that may accompany it.
fn of_a_constructor(fault: &Fault) -> bool {
    let found = [
        "parallel",
        "collinear",
        "empty box",
        "is nowhere 0 or more in",
        "are unbounded in the range of",
        "is capped, but has no",
        "has a ramp that ends where it begins",
        "has arrowheads that are",
        "more than 100 ticks",
        "more than 1024 strokes",
        "stands still",
        "in nearly every direction",
        "has its `point` at its `location`",
        "have the name",
        "is defined",
        "squared",
        "has a profile",
        "squares overflow",
        "has no face with an area",
        "without an area",
        "has no area",
        "has a formula",
        "is too small at its position",
        "has its `target` at its `position`",
        "has its `target` at its `location`",
        "is a light that the notes' rules of light do not know",
        "looks along its `up`",
        "has texels as large as pixels",
        "cannot be capped",
        "cannot be clipped",
        "is clipped by an object",
    ];
    found.iter().any(|words| fault.message.contains(words))
}

/// Generates scenes with any names and any values that the tables allow.
fn any_scene() -> impl Strategy<Value = String> {
    let some = |kind, least| {
        let entities: Vec<_> = registry().iter().filter(|entity| entity.kind() == kind).collect();
        prop::collection::vec(prop::sample::select(entities).prop_flat_map(any_entity), least..4)
    };
    let (camera, materials) = (some(Kind::Camera, 1), some(Kind::Material, 1));
    let (shaders, objects) = (some(Kind::Shader, 0), some(Kind::Object, 0));
    (camera, materials, shaders, objects, some(Kind::Light, 0), some(Kind::Background, 0)).prop_map(
        |(cameras, materials, shaders, objects, lights, backgrounds)| {
            // `m0`, `t0` and `s0` always exist, so that other entities can refer to them.
            let materials =
                materials.iter().enumerate().map(|(i, text)| text.replace("NAME", &format!("m{i}")));
            let texture = format!("texture t0 {{ filename {} }}\n", root().join(TEXTURE).display());
            let sphere = |index| format!("sphere o{index} {{ material m0 center {index} 2 3 radius 4 }}\n");
            let object: String = (0..5).map(sphere).collect();
            let shaders = format!("formula s0 {{ ambient \"x\" 0.5 \"nz\" }}\n{}", shaders.concat());
            let others = [object, objects.concat(), lights.concat()].concat();
            let background = backgrounds.first().cloned().unwrap_or_default();
            [cameras[0].clone(), materials.collect(), texture, shaders, others, background].concat()
        },
    )
}

const TEXTURE: &str = "scenes/textures/bricks.png";

fn any_entity(entity: &'static Entity) -> impl Strategy<Value = String> {
    let name = match entity.kind() {
        Kind::Material => Just("NAME".to_owned()).boxed(),
        _ => "[^\\p{Cc}]{1,20}".prop_map(|name| Syntax::Notes.key(&name)).boxed(),
    };
    let attributes: Vec<_> = entity.attributes().map(any_values).collect();
    let chosen: Vec<_> = entity.groups().map(|group| prop::sample::select(group.names)).collect();
    (name, attributes, chosen).prop_map(move |(name, values, chosen)| {
        let is_left_out = |attribute: &dyn Attribute| {
            let mut groups = entity.groups().zip(&chosen);
            groups
                .any(|(group, chosen)| group.names.contains(&attribute.name()) && *chosen != attribute.name())
        };
        let given = entity.attributes().zip(&values).filter(|(attribute, _)| !is_left_out(*attribute));
        let lines: String = given.map(|(_, values)| values.as_str()).collect();
        format!("{} {name} {{\n{lines}}}\n", entity.name)
    })
}

/// Formulas of a surface of revolution's profile, of a curve, of a surface in u and v, and of space: of any operation, and some
/// that plugins refuse.
const FORMULAS: [&[&str]; 4] = [
    &["2 + sin(y)", "1", "0.5 * -y", "sqrt(abs(4 - y^2))", "1/y", "ln(y)^y - tan(exp(pi))"],
    &["cos(t)", "t^3 - 1", "1/t", "2"],
    &["(2 + cos(v))*cos(u)", "sin(v)", "u - v", "ln(u)", "1"],
    &["x^2 + y^2 + z^2 - 4", "max(abs(x), min(y, -z)) - .5", "x + 2*y - z", "1e-3", "sqrt(x*z)", "floor(y)"],
];

fn any_values(attribute: &'static dyn Attribute) -> BoxedStrategy<String> {
    let number = prop_oneof![
        0.0..1.0,
        (-100..100i32).prop_map(|tenths| f64::from(tenths) / 10.0),
        any::<f64>().prop_filter("finite", |number| number.is_finite()),
    ];
    let count = prop::sample::select(attribute.arity().examples());
    let datum = match attribute.value_type() {
        Type::Whole => count
            .prop_flat_map(|count| prop::collection::vec(prop_oneof![0..2i64, 1..5000i64], count))
            .prop_map(Datum::Whole)
            .boxed(),
        Type::Number | Type::Rotation => (count, any::<bool>())
            .prop_flat_map(move |(count, rises)| {
                let numbers = prop::collection::vec(number.clone(), count);
                numbers.prop_map(move |numbers| match attribute.arity() {
                    Counts::List { group, .. } if rises => rising(&numbers, group),
                    _ => numbers,
                })
            })
            .prop_map(Datum::Numbers)
            .boxed(),
        Type::Name(Kind::Texture) => return Just(format!("{} t0\n", attribute.name())).boxed(),
        Type::Name(Kind::Shader) => return Just(format!("{} s0\n", attribute.name())).boxed(),
        Type::Name(Kind::Object) => {
            let names = |count| (0..count).map(|index| format!(" o{index}")).collect::<String>();
            return count.prop_map(move |count| format!("{}{}\n", attribute.name(), names(count))).boxed();
        }
        Type::File => return Just(format!("{} scenes/models/bowl.stl\n", attribute.name())).boxed(),
        Type::Word | Type::Name(_) => return Just(format!("{} m0\n", attribute.name())).boxed(),
        Type::Formula(variables) => {
            let formulas = FORMULAS[match variables {
                HEIGHT => 0,
                CURVE => 1,
                PATCH => 2,
                _ => 3,
            }];
            let line = |text| format!("{} \"{text}\"\n", attribute.name());
            return prop::sample::select(formulas).prop_map(line).boxed();
        }
        Type::Truth => any::<bool>().prop_map(Datum::Truth).boxed(),
        Type::Choice(choices) => prop::sample::select(choices.all()).prop_map(Datum::Choice).boxed(),
    };
    datum
        .prop_filter("the rule", |datum| attribute.allows(datum) && attribute.beyond_squares(datum).is_none())
        .prop_map(|datum| format!("{} {}\n", attribute.name(), Syntax::Notes.values(&datum).join(" ")))
        .boxed()
}

/// Sorts the groups of a list by the magnitudes of their first numbers, and makes the first of these 0: rules of lists
/// ask for that, and hardly any drawn list keeps them by itself.
fn rising(numbers: &[f64], group: usize) -> Vec<f64> {
    let mut groups: Vec<_> = numbers.chunks(group).map(<[f64]>::to_vec).collect();
    for one in &mut groups {
        one[0] = one[0].abs();
    }
    groups.sort_by(|low, high| low[0].total_cmp(&high[0]));
    if let Some(first) = groups.first_mut() {
        first[0] = 0.0;
    }
    groups.concat()
}
