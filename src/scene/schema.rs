//! The JSON Schema of scenes in TOML, generated from the tables: editors check and complete with it.

use crate::scene::counts::Counts;
use crate::scene::entity::Entity;
use crate::scene::kind::Kind;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::value::{Datum, Type};
use serde::Serialize;
use std::collections::BTreeMap;
use std::iter;

/// A schema (draft 2020-12), or a part of one. It has only the keywords that scenes need, in the order in which they
/// are written; keywords without a value are left out.
#[derive(Clone, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Schema {
    /// The schema dialect, given only at the top level.
    #[serde(rename = "$schema", skip_serializing_if = "Option::is_none")]
    pub language: Option<&'static str>,
    /// What fields that are not in `properties` may hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub additional_properties: Option<Others>,
    /// Where the schema is that matches in place of this one.
    #[serde(rename = "$ref", skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
    /// Schemas that must all match.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub all_of: Vec<Schema>,
    /// Schemas of which at least one must match.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub any_of: Vec<Schema>,
    /// The value if none is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub default: Option<Constant>,
    /// The description that editors show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// All allowed values.
    #[serde(rename = "enum", skip_serializing_if = "Option::is_none")]
    pub choices: Option<Vec<Constant>>,
    /// The schema of each value of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub items: Option<Box<Schema>>,
    /// The greatest number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
    /// The maximum number of values of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_items: Option<usize>,
    /// The maximum number of fields of an object.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_properties: Option<usize>,
    /// The least number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub minimum: Option<f64>,
    /// The minimum number of values of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_items: Option<usize>,
    /// The minimum number of fields of an object.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_properties: Option<usize>,
    /// Schemas of which exactly one must match.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub one_of: Vec<Schema>,
    /// The schemas of an object's fields.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub properties: Option<BTreeMap<&'static str, Schema>>,
    /// The fields that an object must have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub required: Option<Vec<&'static str>>,
    /// The title that editors show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<&'static str>,
    /// The type of the value: `object`, `array`, `string`, `number`, `integer` or `boolean`.
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    pub sort: Option<&'static str>,
}

/// What fields may hold that a schema does not name.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum Others {
    /// Anything (true), or no such fields are allowed (false).
    Any(bool),
    /// Values that match this schema.
    Each(Box<Schema>),
}

/// The default values of an attribute, or one of its allowed values.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum Constant {
    /// A whole number.
    Whole(i64),
    /// Several whole numbers.
    Wholes(Vec<i64>),
    /// A number.
    Number(f64),
    /// Several numbers.
    Numbers(Vec<f64>),
    /// A word, a name or a formula.
    Text(String),
    /// Yes or no.
    Truth(bool),
}

/// Returns the schema of scenes. Rules that the language states in words appear only in the descriptions.
pub fn of(registry: &Registry) -> Schema {
    let names = |entity: &'static Entity| iter::once(entity.name).chain(entity.aliases.iter().copied());
    let cameras = registry.iter().filter(|entity| entity.kind() == Kind::Camera).flat_map(names);
    let kinds = registry.iter().flat_map(|entity| names(entity).map(move |name| (name, kind(entity))));
    let mut properties: BTreeMap<_, _> = kinds.collect();
    properties.extend(computed(properties.keys().copied().collect()));
    // The camera may be in a file that is included.
    let camera = Schema { one_of: cameras.map(requiring).collect(), ..Schema::default() };
    Schema {
        language: Some("https://json-schema.org/draft/2020-12/schema"),
        title: Some("a tabray scene"),
        additional_properties: Some(Others::Any(false)),
        any_of: vec![camera, requiring("include")],
        properties: Some(properties),
        ..Schema::sort("object")
    }
}

/// Returns the schemas of named numbers, of included files and of what is repeated: entities of these types, and
/// numbers.
fn computed(mut kinds: Vec<&'static str>) -> [(&'static str, Schema); 3] {
    let each = |schema| Some(Others::Each(Box::new(schema)));
    let any_of = |any_of| Schema { any_of, ..Schema::default() };
    let described = |text: &str, schema| Schema { description: Some(text.to_owned()), ..schema };
    let numbers = Schema { additional_properties: each(number("number")), ..Schema::sort("object") };
    let files = any_of(vec![Schema::sort("string"), Schema::sort("string").array(1, None)]);
    kinds.extend(["let", "repeat"]);
    let elsewhere = |name| {
        let reference = Some(format!("#/properties/{name}"));
        (name, Schema { reference, ..Schema::default() })
    };
    let body = kinds.into_iter().map(elsewhere).chain([("count", number("number"))]);
    let round = Schema {
        additional_properties: Some(Others::Any(false)),
        properties: Some(body.collect()),
        required: Some(vec!["count"]),
        ..Schema::sort("object")
    };
    let rounds = any_of(vec![round.clone(), round.array(1, None)]);
    let repeats = Schema { additional_properties: each(rounds), ..Schema::sort("object") };
    [
        ("let", described("named numbers, which formulas can use", numbers)),
        ("include", described("files that are read as if they stood here", files)),
        ("repeat", described("entities that are repeated; the name counts the rounds from 0", repeats)),
    ]
}

/// Returns the schema of a number of this type, or a formula in place of it.
fn number(sort: &'static str) -> Schema {
    Schema { any_of: vec![Schema::sort(sort), Schema::sort("string")], ..Schema::default() }
}

impl Schema {
    fn sort(name: &'static str) -> Self {
        Self { sort: Some(name), ..Self::default() }
    }

    /// Returns the schema of an array of values that match this schema, with `min` to `max` values.
    fn array(self, min: usize, max: Option<usize>) -> Self {
        let items = Some(Box::new(self));
        Self { items, min_items: Some(min), max_items: max, ..Self::sort("array") }
    }
}

fn requiring(name: &'static str) -> Schema {
    Schema { required: Some(vec![name]), ..Schema::default() }
}

/// Returns the schema of all entities of one type, by name.
fn kind(entity: &'static Entity) -> Schema {
    let is_single = !matches!(entity.kind(), Kind::Object | Kind::Light);
    let one = body(entity);
    let named = if is_single {
        one
    } else {
        // Objects may share a name, and so may lights.
        Schema { any_of: vec![one.clone(), one.array(1, None)], ..Schema::default() }
    };
    Schema {
        description: Some(format!("{}: {}", entity.kind(), entity.meaning)),
        min_properties: Some(1),
        max_properties: matches!(entity.kind(), Kind::Camera | Kind::Background).then_some(1),
        additional_properties: Some(Others::Each(Box::new(named))),
        ..Schema::sort("object")
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
            let any_of = names.into_iter().map(requiring).collect();
            all_of.push(Schema { any_of, ..Schema::default() });
        }
    }
    for group in entity.groups() {
        let names = |attribute: &&dyn Attribute| group.names.contains(&attribute.name());
        let of_group = entity.attributes().filter(names);
        let all = of_group
            .flat_map(|attribute| iter::once(attribute.name()).chain(attribute.aliases().iter().copied()));
        all_of.push(Schema { one_of: all.map(requiring).collect(), ..Schema::default() });
    }
    Schema {
        additional_properties: Some(Others::Any(false)),
        min_properties: Some(usize::from(!properties.is_empty())),
        properties: Some(properties),
        required: Some(required),
        all_of,
        ..Schema::sort("object")
    }
}

/// Returns the schema of the values of one attribute.
fn value(attribute: &'static dyn Attribute) -> Schema {
    let one = match attribute.value_type() {
        Type::Whole => Schema::sort("integer"),
        Type::Number => Schema::sort("number"),
        Type::Truth => Schema {
            any_of: vec![
                Schema::sort("boolean"),
                Schema {
                    choices: Some(["yes", "no"].map(|word| Constant::Text(word.to_owned())).into()),
                    ..Schema::default()
                },
            ],
            ..Schema::default()
        },
        // Of several formulas, some are mere numbers.
        Type::Formula(_) if attribute.arity().most() > 1 => number("number"),
        Type::Word | Type::File | Type::Name(_) | Type::Formula(_) => Schema::sort("string"),
        Type::Choice(choices) => {
            let all = choices.all();
            let names = all.iter().map(|choice| Constant::Text(choice.name.to_owned()));
            let numbers = all.iter().filter_map(|choice| choice.number).map(Constant::Whole);
            let known = Schema { choices: Some(names.chain(numbers).collect()), ..Schema::default() };
            match choices.kind {
                Some(_) => Schema { any_of: vec![known, Schema::sort("string")], ..Schema::default() },
                None => known,
            }
        }
    };
    let [minimum, maximum] = attribute.range().map_or([None; 2], |range| range.map(Some));
    let one = Schema { minimum, maximum, ..one };
    let one = match attribute.value_type() {
        Type::Whole | Type::Number => {
            Schema { any_of: vec![one, Schema::sort("string")], ..Schema::default() }
        }
        _ => one,
    };
    let several: Vec<_> = match attribute.arity() {
        Counts::Of(counts) => counts.iter().map(|count| one.clone().array(*count, Some(*count))).collect(),
        Counts::List { group, least, most } => vec![one.clone().array(group * least, Some(group * most))],
    };
    let is_alone = attribute.arity().allow(1).then(|| one.clone());
    let mut forms: Vec<_> = is_alone.into_iter().chain(several).collect();
    let any = if forms.len() == 1 { forms.remove(0) } else { Schema { any_of: forms, ..Schema::default() } };
    let default = attribute.default().as_ref().and_then(Constant::of);
    Schema { description: Some(description(attribute)), default, ..any }
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

impl Constant {
    /// Returns the values of an attribute, or `None` where it has none.
    pub(crate) fn of(datum: &Datum) -> Option<Self> {
        Some(match datum {
            Datum::Whole(numbers) => match numbers[..] {
                [number] => Self::Whole(number),
                _ => Self::Wholes(numbers.clone()),
            },
            Datum::Numbers(numbers) => match numbers[..] {
                [number] => Self::Number(number),
                _ => Self::Numbers(numbers.clone()),
            },
            Datum::Word(word) => Self::Text(word.clone()),
            Datum::Formula(formula) => Self::Text(formula.to_string()),
            Datum::Formulas(_) => return None,
            Datum::Material { name, .. }
            | Datum::Texture { name, .. }
            | Datum::Shader { name, .. }
            | Datum::Object { name, .. } => Self::Text(name.to_string()),
            Datum::Choice(choice) => {
                choice.number.map_or_else(|| Self::Text(choice.name.to_owned()), Self::Whole)
            }
            Datum::Truth(truth) => Self::Truth(*truth),
            Datum::Absent => return None,
        })
    }
}
