//! The JSON Schema of scenes in TOML, generated from the tables. Editors use it for checks and completion.

use std::collections::BTreeMap;
use std::iter;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::counts::Counts;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::value::{Datum, Type};
use tabray_lang::registry::Registry;

pub use crate::json_schema::{AdditionalProperties, Constant, Schema, TypeKeyword};

/// Returns the schema of scenes. Rules that are stated in words appear only in descriptions.
pub fn of(registry: &Registry) -> Schema {
    let names = |entity: &'static Entity| iter::once(entity.name).chain(entity.aliases.iter().copied());
    let cameras: Vec<_> =
        registry.iter().filter(|entity| entity.kind() == Kind::Camera).flat_map(names).collect();
    let kinds = registry.iter().flat_map(|entity| names(entity).map(move |name| (name, kind(entity))));
    let mut properties: BTreeMap<_, _> = kinds.collect();
    properties.extend(computed(properties.keys().copied().collect()));
    Schema {
        language: Some("https://json-schema.org/draft/2020-12/schema"),
        title: Some("a tabray scene"),
        additional_properties: Some(AdditionalProperties::Allowed(false)),
        // The camera may be in an included file.
        all_of: vec![Schema {
            condition: Some(Box::new(requiring("include"))),
            otherwise: Some(Box::new(one_of(&cameras))),
            ..Schema::default()
        }],
        properties: Some(properties),
        ..Schema::of_type("object")
    }
}

/// Returns the schemas of named numbers, of included files and of `repeat`, with entities of these types and numbers.
fn computed(mut kinds: Vec<&'static str>) -> [(&'static str, Schema); 3] {
    let each = |schema| Some(AdditionalProperties::Matching(Box::new(schema)));
    let described = |text: &str, schema| Schema { description: Some(text.to_owned()), ..schema };
    let numbers = Schema { additional_properties: each(number("number")), ..Schema::of_type("object") };
    let files = Schema::of_type("string").or_several();
    kinds.extend(["let", "repeat"]);
    let elsewhere = |name| {
        let reference = Some(format!("#/properties/{name}"));
        (name, Schema { reference, ..Schema::default() })
    };
    let body = kinds.into_iter().map(elsewhere).chain([("count", number("number"))]);
    let round = Schema {
        additional_properties: Some(AdditionalProperties::Allowed(false)),
        properties: Some(body.collect()),
        required: Some(vec!["count"]),
        ..Schema::of_type("object")
    };
    let repeats = Schema { additional_properties: each(round.or_several()), ..Schema::of_type("object") };
    [
        ("let", described("named numbers, which formulas can use", numbers)),
        ("include", described("files that are read as if they stood here", files)),
        ("repeat", described("entities that are repeated; the name counts the rounds from 0", repeats)),
    ]
}

/// Returns the schema of a number of this type, or of a formula for it.
fn number(type_name: &'static str) -> Schema {
    Schema { types: Some(TypeKeyword::Any(vec![type_name, "string"])), ..Schema::default() }
}

impl Schema {
    /// Returns the schema of any value of this type.
    fn of_type(name: &'static str) -> Self {
        Self { types: Some(TypeKeyword::One(name)), ..Self::default() }
    }

    /// Returns the schema of a value that matches this schema, or of an array of such values.
    fn or_several(self) -> Self {
        let types = match &self.types {
            Some(TypeKeyword::One(type_name)) => Some(TypeKeyword::Any(vec![type_name, "array"])),
            Some(TypeKeyword::Any(sorts)) => {
                Some(TypeKeyword::Any(sorts.iter().copied().chain(["array"]).collect()))
            }
            None => None,
        };
        Self { items: Some(Box::new(self.clone())), min_items: Some(1), types, ..self }
    }

    /// Returns the schema of an array of values that match this schema, with `min` to `max` values.
    fn array(self, min: usize, max: Option<usize>) -> Self {
        let items = Some(Box::new(self));
        Self { items, min_items: Some(min), max_items: max, ..Self::of_type("array") }
    }
}

fn requiring(name: &'static str) -> Schema {
    Schema { required: Some(vec![name]), ..Schema::default() }
}

/// Returns the schema of an object with exactly one of these fields.
fn one_of(names: &[&'static str]) -> Schema {
    let Some((first, rest)) = names.split_first() else { return Schema::default() };
    if rest.is_empty() {
        return requiring(first);
    }
    let nothing = Schema { not: Some(Box::default()), ..Schema::default() };
    let without = rest.iter().map(|name| (*name, nothing.clone())).collect();
    Schema {
        condition: Some(Box::new(requiring(first))),
        then: Some(Box::new(Schema { properties: Some(without), ..Schema::default() })),
        otherwise: Some(Box::new(one_of(rest))),
        ..Schema::default()
    }
}

/// Returns the schema of an object with at least one of these fields.
fn any_of(names: &[&'static str]) -> Schema {
    match names {
        [] => Schema::default(),
        [name] => requiring(name),
        [name, rest @ ..] => Schema {
            condition: Some(Box::new(requiring(name))),
            otherwise: Some(Box::new(any_of(rest))),
            ..Schema::default()
        },
    }
}

/// Returns the schema of all entities of one type, by name.
fn kind(entity: &'static Entity) -> Schema {
    let is_single = !matches!(entity.kind(), Kind::Object | Kind::Light);
    let one = body(entity);
    let named = if is_single {
        one
    } else {
        // Objects may share a name, and so may lights.
        one.or_several()
    };
    Schema {
        description: Some(format!("{}: {}", entity.kind(), entity.meaning)),
        min_properties: Some(1),
        max_properties: matches!(entity.kind(), Kind::Camera | Kind::Background).then_some(1),
        additional_properties: Some(AdditionalProperties::Matching(Box::new(named))),
        ..Schema::of_type("object")
    }
}

/// Returns the schema of the attributes of one entity.
fn body(entity: &'static Entity) -> Schema {
    let mut properties = BTreeMap::new();
    let (mut required, mut all_of) = (Vec::new(), Vec::new());
    for attribute in entity.attributes() {
        let names: Vec<_> = iter::once(attribute.name()).chain(attribute.aliases().iter().copied()).collect();
        properties.extend(names.iter().map(|name| (*name, value(attribute))));
        if attribute.default().is_none() && names.len() == 1 {
            required.push(attribute.name());
        } else if attribute.default().is_none() {
            all_of.push(any_of(&names));
        }
    }
    for group in entity.groups() {
        let names = |attribute: &&dyn Attribute| group.names.contains(&attribute.name());
        let of_group = entity.attributes().filter(names);
        let all: Vec<_> = of_group
            .flat_map(|attribute| iter::once(attribute.name()).chain(attribute.aliases().iter().copied()))
            .collect();
        all_of.push(one_of(&all));
    }
    Schema {
        additional_properties: Some(AdditionalProperties::Allowed(false)),
        properties: Some(properties),
        required: Some(required),
        all_of,
        ..Schema::of_type("object")
    }
}

/// Returns the schema of one value of an attribute, regardless of its rule.
fn one(attribute: &'static dyn Attribute) -> Schema {
    let choices = |sorts: [&'static str; 2], choices| Schema {
        choices: Some(choices),
        types: Some(TypeKeyword::Any(sorts.to_vec())),
        ..Schema::default()
    };
    match attribute.value_type() {
        Type::Whole => number("integer"),
        Type::Number | Type::Rotation => number("number"),
        Type::Truth => {
            let words = ["yes", "no"].map(|word| Constant::Text(word.to_owned()));
            choices(
                ["boolean", "string"],
                [true, false].map(Constant::Truth).into_iter().chain(words).collect(),
            )
        }
        // Some of several formulas may be plain numbers.
        Type::Formula(_) if attribute.arity().most() > 1 => number("number"),
        Type::Word | Type::File | Type::Name(_) | Type::Formula(_) => Schema::of_type("string"),
        Type::Choice(known) => {
            let all = known.all();
            let names = all.iter().map(|choice| Constant::Text(choice.name.to_owned()));
            let numbers = all.iter().filter_map(|choice| choice.number).map(Constant::Whole);
            let sorts = ["string", "integer"];
            match known.kind {
                // The value is any name of an entity, or a number of the list.
                Some(_) => Schema {
                    condition: Some(Box::new(Schema::of_type("integer"))),
                    then: Some(Box::new(Schema { choices: Some(numbers.collect()), ..Schema::default() })),
                    types: Some(TypeKeyword::Any(sorts.to_vec())),
                    ..Schema::default()
                },
                None => choices(sorts, names.chain(numbers).collect()),
            }
        }
    }
}

/// Returns the schema of the values of one attribute.
fn value(attribute: &'static dyn Attribute) -> Schema {
    let [minimum, maximum] = attribute.range().map_or([None; 2], |range| range.map(Some));
    let least = if minimum.is_none() && maximum.is_none() { least(attribute) } else { [None; 2] };
    let one =
        Schema { minimum: minimum.or(least[0]), exclusive_minimum: least[1], maximum, ..one(attribute) };
    let (counts, [least, most]) = match attribute.arity() {
        Counts::Of(counts) => (
            counts.to_vec(),
            [counts.iter().min(), counts.iter().max()].map(|count| count.copied().unwrap_or(1)),
        ),
        Counts::List { group, least, most } => (Vec::new(), [group * least, group * most]),
    };
    // A choice is one of its values, which are not arrays.
    let any = match (attribute.arity().allow(1), one.choices.is_some()) {
        (true, true) => one,
        (true, false) => Schema { min_items: Some(least), max_items: Some(most), ..one.or_several() },
        (false, _) => one.array(least, Some(most)),
    };
    // The number of values of an array must not lie between two consecutive allowed numbers.
    let gaps = counts.windows(2).filter(|pair| pair[1] > pair[0] + 1).map(|pair| Schema {
        condition: Some(Box::new(Schema { min_items: Some(pair[0] + 1), ..Schema::of_type("array") })),
        then: Some(Box::new(Schema { min_items: Some(pair[1]), ..Schema::default() })),
        ..Schema::default()
    });
    let any = Schema { all_of: gaps.collect(), ..any };
    let default = attribute.default().as_ref().and_then(Constant::of);
    Schema { description: Some(description(attribute)), default, ..any }
}

/// Returns the bounds of an attribute of one number with a rule in words: the inclusive and the exclusive minimum. One
/// of the two is 0, or there is none.
fn least(attribute: &dyn Attribute) -> [Option<f64>; 2] {
    let allows = |number: i64| {
        attribute.allows(&match attribute.value_type() {
            Type::Whole => Datum::Whole(vec![number]),
            _ => Datum::Numbers(vec![number as f64]),
        })
    };
    let is_number = matches!(attribute.value_type(), Type::Whole | Type::Number);
    match attribute.arity() {
        Counts::Of([1]) if is_number && allows(1) && !allows(-1) => match allows(0) {
            true => [Some(0.0), None],
            false => [None, Some(0.0)],
        },
        _ => [None; 2],
    }
}

fn description(attribute: &dyn Attribute) -> String {
    let mut text = attribute.meaning().to_owned();
    if !attribute.unit().is_empty() {
        text += &format!(", in {}", attribute.unit());
    }
    if !attribute.rule().is_empty() {
        text += &format!("; must be {}", attribute.rule());
    }
    text
}
