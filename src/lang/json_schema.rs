//! A JSON Schema: what its keywords hold.

use serde::Serialize;
use std::collections::BTreeMap;
use tabray_core::scene::value::Datum;

/// A schema (draft 2020-12), or a part of one. It has only the keywords that scenes need, in the order in which they
/// are written; keywords without a value are left out.
#[derive(Clone, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Schema {
    /// The schema dialect, given only at the top level.
    #[serde(rename = "$schema", skip_serializing_if = "Option::is_none")]
    pub language: Option<&'static str>,
    /// The schema of fields that are not in `properties`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub additional_properties: Option<AdditionalProperties>,
    /// The path of a schema that stands for this one.
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
    /// The schema that must match where `condition` does not.
    #[serde(rename = "else", skip_serializing_if = "Option::is_none")]
    pub otherwise: Option<Box<Schema>>,
    /// All allowed values.
    #[serde(rename = "enum", skip_serializing_if = "Option::is_none")]
    pub choices: Option<Vec<Constant>>,
    /// The number that all numbers must be above.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exclusive_minimum: Option<f64>,
    /// The schema that decides whether `then` or `otherwise` must match. If these name the error, editors show it once,
    /// in its place. Of alternatives (`anyOf`, `oneOf`), editors only show, for the whole entity, that none matches.
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
    /// A schema that must not match.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not: Option<Box<Schema>>,
    /// The schemas of an object's fields.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub properties: Option<BTreeMap<&'static str, Schema>>,
    /// The fields that an object must have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub required: Option<Vec<&'static str>>,
    /// The schema that must match where `condition` does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub then: Option<Box<Schema>>,
    /// The title that editors show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<&'static str>,
    /// The types that the value may have: `object`, `array`, `string`, `number`, `integer` or `boolean`. The other
    /// keywords hold for values of the types that they are about.
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    pub types: Option<TypeKeyword>,
}

/// The value of the keyword `type`: the types that a value may have.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum TypeKeyword {
    /// One type.
    One(&'static str),
    /// One of several.
    Any(Vec<&'static str>),
}

/// The value of the keyword `additionalProperties`: what fields that a schema does not name may hold.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum AdditionalProperties {
    /// Whether there may be such fields, with any values.
    Allowed(bool),
    /// Values that match this schema.
    Matching(Box<Schema>),
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
