//! The JSON Schema of scenes in TOML, written from the tables: what editors check and complete with.

use crate::scene::entity::Entity;
use crate::scene::kind::Kind;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::value::{Datum, Type};
use serde_json::{Map, Value, json};

/// The schema (draft 2020-12). Rules that the language states in words are in the descriptions alone.
pub fn of(registry: &Registry) -> Value {
    let names = |entity: &'static Entity| [entity.name].into_iter().chain(entity.aliases.iter().copied());
    let kinds =
        registry.iter().flat_map(|entity| names(entity).map(move |name| (name.to_owned(), kind(entity))));
    let cameras = registry.iter().filter(|entity| entity.kind() == Kind::Camera).flat_map(names);
    let one_camera: Vec<_> = cameras.map(|name| json!({ "required": [name] })).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "a tabray scene",
        "type": "object",
        "additionalProperties": false,
        "oneOf": one_camera,
        "properties": kinds.collect::<Map<_, _>>(),
    })
}

/// All entities of one type, by name.
fn kind(entity: &'static Entity) -> Value {
    let is_single = matches!(entity.kind(), Kind::Camera | Kind::Material | Kind::Texture);
    let one = body(entity);
    let named = if is_single {
        one
    } else {
        // Objects and lights may share a name.
        json!({ "anyOf": [one, { "type": "array", "minItems": 1, "items": one }] })
    };
    let mut schema = json!({
        "description": format!("{}: {}", entity.kind(), entity.meaning),
        "type": "object",
        "minProperties": 1,
        "additionalProperties": named,
    });
    if entity.kind() == Kind::Camera {
        schema["maxProperties"] = json!(1);
    }
    schema
}

/// The attributes of one entity.
fn body(entity: &'static Entity) -> Value {
    let mut properties = Map::new();
    let (mut required, mut all_of) = (Vec::new(), Vec::new());
    for attribute in entity.attributes() {
        let names: Vec<_> =
            [attribute.name()].into_iter().chain(attribute.aliases().iter().copied()).collect();
        for name in &names {
            properties.insert((*name).to_owned(), value(attribute));
        }
        if attribute.default().is_none() && names.len() == 1 {
            required.push(attribute.name());
        } else if attribute.default().is_none() {
            let each: Vec<_> = names.iter().map(|name| json!({ "required": [name] })).collect();
            all_of.push(json!({ "anyOf": each }));
        }
    }
    let mut schema = json!({
        "type": "object",
        "additionalProperties": false,
        "minProperties": usize::from(!properties.is_empty()),
        "properties": properties,
        "required": required,
    });
    if !all_of.is_empty() {
        schema["allOf"] = json!(all_of);
    }
    schema
}

/// The values of one attribute.
fn value(attribute: &'static dyn Attribute) -> Value {
    let one = match attribute.value_type() {
        Type::Whole => json!({ "type": "integer" }),
        Type::Number => json!({ "type": "number" }),
        Type::Word | Type::Name(_) | Type::Formula => json!({ "type": "string" }),
        Type::Choice(choices) => {
            let all = choices.all();
            let numbers = all.iter().filter_map(|choice| choice.number).map(|number| json!(number));
            let names: Vec<_> = all.iter().map(|choice| json!(choice.name)).chain(numbers).collect();
            json!({ "enum": names })
        }
    };
    let several =
        |count: usize| json!({ "type": "array", "items": one, "minItems": count, "maxItems": count });
    let mut forms: Vec<_> = attribute.arity().iter().map(|count| several(*count)).collect();
    if attribute.arity().contains(&1) {
        forms.insert(0, one.clone());
    }
    let mut schema = if forms.len() == 1 { forms.remove(0) } else { json!({ "anyOf": forms }) };
    schema["description"] = json!(description(attribute));
    if let Some(default) = attribute.default().filter(|default| *default != Datum::Absent) {
        schema["default"] = constant(&default);
    }
    schema
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

/// The values of an attribute as JSON.
pub(crate) fn constant(datum: &Datum) -> Value {
    match datum {
        Datum::Whole(numbers) if numbers.len() == 1 => json!(numbers[0]),
        Datum::Whole(numbers) => json!(numbers),
        Datum::Numbers(numbers) if numbers.len() == 1 => json!(numbers[0]),
        Datum::Numbers(numbers) => json!(numbers),
        Datum::Word(word) => json!(word),
        Datum::Formula(formula) => json!(formula.to_string()),
        Datum::Absent => Value::Null,
        Datum::Material { name, .. } | Datum::Texture { name, .. } => json!(**name),
        Datum::Choice(choice) => choice.number.map_or(json!(choice.name), |number| json!(number)),
    }
}
