//! A JSON Schema with its keywords.

use serde::Serialize;
use std::collections::BTreeMap;
pub use tabray_lang::list_json::Constant;

/// A schema (draft 2020-12), or a part of one. It has only the keywords that scenes need, in the order of the output.
/// Keywords without a value are omitted.
#[derive(Clone, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Schema {
    /// The schema dialect, only given at the top level.
    #[serde(rename = "$schema", skip_serializing_if = "Option::is_none")]
    pub language: Option<&'static str>,
    /// The schema of fields outside of `properties`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub additional_properties: Option<AdditionalProperties>,
    /// The path of a schema to use in place of this one.
    #[serde(rename = "$ref", skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
    /// Schemas that must all match.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub all_of: Vec<Schema>,
    /// The default value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub default: Option<Constant>,
    /// The description that editors show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The schema that must match if `condition` does not.
    #[serde(rename = "else", skip_serializing_if = "Option::is_none")]
    pub otherwise: Option<Box<Schema>>,
    /// All allowed values.
    #[serde(rename = "enum", skip_serializing_if = "Option::is_none")]
    pub choices: Option<Vec<Constant>>,
    /// The exclusive lower bound of numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exclusive_minimum: Option<f64>,
    /// The schema that decides whether `then` or `otherwise` must match. Editors show an error in these once, in its
    /// place. With alternatives (`anyOf`, `oneOf`), they would only show, for the whole entity, that none matches.
    #[serde(rename = "if", skip_serializing_if = "Option::is_none")]
    pub condition: Option<Box<Schema>>,
    /// The schema of each value of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub items: Option<Box<Schema>>,
    /// The maximum number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
    /// The maximum number of values of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_items: Option<usize>,
    /// The maximum number of fields of an object.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_properties: Option<usize>,
    /// The minimum number.
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
    /// The required fields of an object.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub required: Option<Vec<&'static str>>,
    /// The schema that must match if `condition` does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub then: Option<Box<Schema>>,
    /// The title that editors show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<&'static str>,
    /// The allowed types of the value: `object`, `array`, `string`, `number`, `integer` or `boolean`. The other
    /// keywords each apply to values of their types.
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    pub types: Option<TypeKeyword>,
}

/// The value of the keyword `type`: the allowed types of a value.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum TypeKeyword {
    /// One type.
    One(&'static str),
    /// One of several.
    Any(Vec<&'static str>),
}

/// The value of the keyword `additionalProperties`: the allowed contents of fields that a schema does not name.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum AdditionalProperties {
    /// Whether such fields are allowed, with any values.
    Allowed(bool),
    /// Values that match this schema.
    Matching(Box<Schema>),
}
