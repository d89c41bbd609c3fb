//! A dump in the scene language is a scene, and loads again to the identical model.

mod common;

use common::{load, model, registry, scenes};
use proptest::prelude::*;
use tabray::dump;
use tabray::entity::{Entity, Kind};
use tabray::model::Model;
use tabray::pparm::Attribute;
use tabray::scene;
use tabray::value::{Datum, Type};

/// Every value of a model, to its last bit.
fn values(model: &Model) -> Vec<String> {
    let items = [&model.camera.args]
        .into_iter()
        .chain(model.materials.iter().map(|item| &item.args))
        .chain(model.objects.iter().map(|object| &object.args))
        .chain(model.lights.iter().map(|item| &item.args));
    items
        .flat_map(|args| {
            args.values().map(|(attribute, datum)| match datum {
                Datum::Numbers(numbers) => {
                    let bits: Vec<_> = numbers.iter().map(|number| number.to_bits()).collect();
                    format!("{} {} {bits:x?}", args.name, attribute.name())
                }
                other => format!("{} {} {other:?}", args.name, attribute.name()),
            })
        })
        .collect()
}

fn assert_loads_again(first: &Model) {
    let text = dump::ray(first);
    let again = model(&text);
    assert_eq!(values(first), values(&again), "{text}");
    assert_eq!(text, dump::ray(&again));
    assert_eq!(dump::notes(first), dump::notes(&again), "{text}");
}

#[test]
fn every_scene_survives_its_dump() {
    for path in scenes() {
        assert_loads_again(&load(&path));
    }
}

#[test]
fn a_dumped_scene_gives_the_same_picture() {
    for path in scenes().iter().filter(|path| path.to_string_lossy().contains("material")) {
        let first = load(path);
        let again = model(&dump::ray(&first));
        assert!(common::render(&first) == common::render(&again), "{}", path.display());
    }
}

proptest! {
    #[test]
    fn any_scene_survives_its_dump(text in any_scene()) {
        match scene::read(registry(), "any", text.as_bytes()) {
            Ok(loaded) => assert_loads_again(&loaded.model),
            // Only what no single attribute shows may be wrong.
            Err(report) => prop_assert!(report.faults().iter().any(|fault| fault.message.contains("parallel")), "{report}"),
        }
    }
}

/// A scene with any names and any values that the tables allow.
fn any_scene() -> impl Strategy<Value = String> {
    let of = |kind| registry().iter().filter(move |entity| entity.kind() == kind).collect::<Vec<_>>();
    let some = |kind| prop::collection::vec(prop::sample::select(of(kind)).prop_flat_map(any_entity), 1..4);
    (some(Kind::Camera), some(Kind::Material), some(Kind::Object), some(Kind::Light)).prop_map(
        |(mut cameras, materials, objects, lights)| {
            cameras.truncate(1);
            let mut text = cameras.concat();
            for (index, material) in materials.iter().enumerate() {
                text += &material.replace("NAME", &format!("m{index}"));
            }
            // `m0` is always there to be referred to.
            (objects.concat() + &lights.concat()).lines().for_each(|line| {
                text += line;
                text.push('\n');
            });
            text
        },
    )
}

fn any_entity(entity: &'static Entity) -> impl Strategy<Value = String> {
    let name = if entity.kind() == Kind::Material {
        Just("NAME".to_owned()).boxed()
    } else {
        "[^\\s{}#\\x00][^\\s{}\\x00]{0,20}".boxed()
    };
    let attributes: Vec<_> = entity.attributes().map(any_values).collect();
    (name, attributes)
        .prop_map(move |(name, attributes)| format!("{} {name} {{\n{}}}\n", entity.name, attributes.concat()))
}

fn any_values(attribute: &'static dyn Attribute) -> BoxedStrategy<String> {
    let number = prop_oneof![
        0.0..1.0,
        (-100..100i32).prop_map(|tenths| f64::from(tenths) / 10.0),
        any::<f64>().prop_filter("finite", |number| number.is_finite()),
    ];
    let count = prop::sample::select(attribute.arity());
    let datum = match attribute.value_type() {
        Type::Whole => count
            .prop_flat_map(|count| prop::collection::vec(1..5000i64, count))
            .prop_map(Datum::Whole)
            .boxed(),
        Type::Number => count
            .prop_flat_map(move |count| prop::collection::vec(number.clone(), count))
            .prop_map(Datum::Numbers)
            .boxed(),
        Type::Word | Type::Name(_) => return Just(format!("{} m0\n", attribute.name())).boxed(),
    };
    datum
        .prop_filter("the rule", |datum| attribute.allows(datum))
        .prop_map(|datum| format!("{} {datum}\n", attribute.name()))
        .boxed()
}
