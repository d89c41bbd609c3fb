//! The JSON Schema of scenes in TOML, generated from the tables: editors check and complete with it.

use crate::scene::attribute::Attribute;
use crate::scene::counts::Counts;
use crate::scene::entity::Entity;
use crate::scene::kind::Kind;
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
    /// The value if none is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub default: Option<Constant>,
    /// The description that editors show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// What must match where `condition` does not.
    #[serde(rename = "else", skip_serializing_if = "Option::is_none")]
    pub otherwise: Option<Box<Schema>>,
    /// All allowed values.
    #[serde(rename = "enum", skip_serializing_if = "Option::is_none")]
    pub choices: Option<Vec<Constant>>,
    /// The number that all numbers must be above.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exclusive_minimum: Option<f64>,
    /// What decides whether `then` or `otherwise` must match. Where these name the fault, editors show it once, in its
    /// place; of alternatives (`anyOf`, `oneOf`), they show that none matches, for all of an entity.
    #[serde(rename = "if", skip_serializing_if = "Option::is_none")]
    pub condition: Option<Box<Schema>>,
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
    /// What must not match.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not: Option<Box<Schema>>,
    /// The schemas of an object's fields.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub properties: Option<BTreeMap<&'static str, Schema>>,
    /// The fields that an object must have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub required: Option<Vec<&'static str>>,
    /// What must match where `condition` does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub then: Option<Box<Schema>>,
    /// The title that editors show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<&'static str>,
    /// The types that the value may have: `object`, `array`, `string`, `number`, `integer` or `boolean`. The other
    /// keywords hold for values of the types that they are about.
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    pub sort: Option<Sort>,
}

/// The types of a value.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum Sort {
    /// One type.
    One(&'static str),
    /// One of several.
    Any(Vec<&'static str>),
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
    let cameras: Vec<_> =
        registry.iter().filter(|entity| entity.kind() == Kind::Camera).flat_map(names).collect();
    let kinds = registry.iter().flat_map(|entity| names(entity).map(move |name| (name, kind(entity))));
    let mut properties: BTreeMap<_, _> = kinds.collect();
    properties.extend(computed(properties.keys().copied().collect()));
    Schema {
        language: Some("https://json-schema.org/draft/2020-12/schema"),
        title: Some("a tabray scene"),
        additional_properties: Some(Others::Any(false)),
        // The camera may be in a file that is included.
        all_of: vec![Schema {
            condition: Some(Box::new(requiring("include"))),
            otherwise: Some(Box::new(one_of(&cameras))),
            ..Schema::default()
        }],
        properties: Some(properties),
        ..Schema::sort("object")
    }
}

/// Returns the schemas of named numbers, of included files and of what is repeated: entities of these types, and
/// numbers.
fn computed(mut kinds: Vec<&'static str>) -> [(&'static str, Schema); 3] {
    let each = |schema| Some(Others::Each(Box::new(schema)));
    let described = |text: &str, schema| Schema { description: Some(text.to_owned()), ..schema };
    let numbers = Schema { additional_properties: each(number("number")), ..Schema::sort("object") };
    let files = Schema::sort("string").or_several();
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
    let repeats = Schema { additional_properties: each(round.or_several()), ..Schema::sort("object") };
    [
        ("let", described("named numbers, which formulas can use", numbers)),
        ("include", described("files that are read as if they stood here", files)),
        ("repeat", described("entities that are repeated; the name counts the rounds from 0", repeats)),
    ]
}

/// Returns the schema of a number of this type, or a formula in place of it.
fn number(sort: &'static str) -> Schema {
    Schema { sort: Some(Sort::Any(vec![sort, "string"])), ..Schema::default() }
}

impl Schema {
    fn sort(name: &'static str) -> Self {
        Self { sort: Some(Sort::One(name)), ..Self::default() }
    }

    /// Returns the schema of a value that matches this schema, or of an array of such values.
    fn or_several(self) -> Self {
        let sort = match &self.sort {
            Some(Sort::One(sort)) => Some(Sort::Any(vec![sort, "array"])),
            Some(Sort::Any(sorts)) => Some(Sort::Any(sorts.iter().copied().chain(["array"]).collect())),
            None => None,
        };
        Self { items: Some(Box::new(self.clone())), min_items: Some(1), sort, ..self }
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
    let choices = |sorts: [&'static str; 2], choices| Schema {
        choices: Some(choices),
        sort: Some(Sort::Any(sorts.to_vec())),
        ..Schema::default()
    };
    let one = match attribute.value_type() {
        Type::Whole => number("integer"),
        Type::Number | Type::Rotation => number("number"),
        Type::Truth => {
            let words = ["yes", "no"].map(|word| Constant::Text(word.to_owned()));
            choices(
                ["boolean", "string"],
                [true, false].map(Constant::Truth).into_iter().chain(words).collect(),
            )
        }
        // Of several formulas, some are mere numbers.
        Type::Formula(_) if attribute.arity().most() > 1 => number("number"),
        Type::Word | Type::File | Type::Name(_) | Type::Formula(_) => Schema::sort("string"),
        Type::Choice(known) => {
            let all = known.all();
            let names = all.iter().map(|choice| Constant::Text(choice.name.to_owned()));
            let numbers = all.iter().filter_map(|choice| choice.number).map(Constant::Whole);
            let sorts = ["string", "integer"];
            match known.kind {
                // Any name of an entity, or a number of the list.
                Some(_) => Schema {
                    condition: Some(Box::new(Schema::sort("integer"))),
                    then: Some(Box::new(Schema { choices: Some(numbers.collect()), ..Schema::default() })),
                    sort: Some(Sort::Any(sorts.to_vec())),
                    ..Schema::default()
                },
                None => choices(sorts, names.chain(numbers).collect()),
            }
        }
    };
    let [minimum, maximum] = attribute.range().map_or([None; 2], |range| range.map(Some));
    let least = if minimum.is_none() && maximum.is_none() { least(attribute) } else { [None; 2] };
    let one = Schema { minimum: minimum.or(least[0]), exclusive_minimum: least[1], maximum, ..one };
    let (counts, [least, most]) = match attribute.arity() {
        Counts::Of(counts) => (
            counts.to_vec(),
            [counts.iter().min(), counts.iter().max()].map(|count| count.copied().unwrap_or(1)),
        ),
        Counts::List { group, least, most } => (Vec::new(), [group * least, group * most]),
    };
    // A choice is one of its values, which are no arrays.
    let any = match (attribute.arity().allow(1), one.choices.is_some()) {
        (true, true) => one,
        (true, false) => Schema { min_items: Some(least), max_items: Some(most), ..one.or_several() },
        (false, _) => one.array(least, Some(most)),
    };
    // An array may not have more values than one allowed number and fewer than the next.
    let gaps = counts.windows(2).filter(|pair| pair[1] > pair[0] + 1).map(|pair| Schema {
        condition: Some(Box::new(Schema { min_items: Some(pair[0] + 1), ..Schema::sort("array") })),
        then: Some(Box::new(Schema { min_items: Some(pair[1]), ..Schema::default() })),
        ..Schema::default()
    });
    let any = Schema { all_of: gaps.collect(), ..any };
    let default = attribute.default().as_ref().and_then(Constant::of);
    Schema { description: Some(description(attribute)), default, ..any }
}

/// Returns the least number of an attribute of one number whose rule has words and no range, and the number that it must
/// be above: 0 for one of them, or no number.
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
            // No list of objects is a default.
            Datum::Objects(_) | Datum::Absent => return None,
        })
    }
}
