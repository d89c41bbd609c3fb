//! The tables of the scene language as JSON, for other programs. `docs/data/fields.csv` describes the fields.
//!
//! Fields are declared in the order of the output.

use crate::reference::by_name;
use crate::registry::Registry;
use serde::Serialize;
use std::borrow::Cow;
use tabray_core::scene::attribute;
use tabray_core::scene::choice::ChoiceName;
use tabray_core::scene::counts::Counts;
use tabray_core::scene::entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::profile::Profile;
use tabray_core::scene::value::{Datum, Type};

/// The version of the format. It increases if a field is removed or changes its meaning, but not if one is added.
const VERSION: u32 = 1;

/// The whole scene language.
#[derive(Serialize)]
pub struct Tables {
    /// The entity types, sorted by name.
    pub entities: Vec<Entity>,
    /// The profiles, sorted by name.
    pub profiles: Vec<Named>,
    /// The types of shader, sorted by name.
    pub shaders: Vec<Shader>,
    /// The version of the format. It increases if a field is removed or changes its meaning, but not if one is added.
    pub version: u32,
}

/// An entity type.
#[derive(Serialize)]
pub struct Entity {
    /// Alternative names in scenes.
    pub aliases: &'static [&'static str],
    /// The type's attributes, in the order of the dump.
    pub attributes: Vec<Attribute>,
    /// `camera`, `material`, `texture`, `shader`, `object`, `light` or `background`.
    pub kind: Kind,
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The name in scenes.
    pub name: &'static str,
    /// The groups of attributes. A scene gives exactly one attribute of each group.
    pub one_of: Vec<Group>,
}

/// An attribute.
#[derive(Serialize)]
pub struct Attribute {
    /// Alternative names in scenes.
    pub aliases: &'static [&'static str],
    /// All allowed values of a choice, or null for other types.
    pub choices: Option<Vec<Named>>,
    /// The allowed numbers of values: `[1, 3]` for one or three, or an empty array for a list.
    pub counts: &'static [usize],
    /// The default: one value, several in an array, or null.
    pub default: Option<Constant>,
    /// The allowed numbers of values of a list, or null for other attributes.
    pub list: Option<ListOf>,
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The rule for the values, to follow "it must be", or null.
    pub must_be: Option<Cow<'static, str>>,
    /// The name in scenes.
    pub name: &'static str,
    /// The bounds of the effective values, such as a full turn for an angle, or null.
    pub period: Option<[f64; 2]>,
    /// The minimum and the maximum of each value, or null.
    pub range: Option<[f64; 2]>,
    /// The kind of the entity that a name refers to, including a name in place of a choice, or null for other types.
    pub refers_to: Option<Kind>,
    /// Whether a scene must give the attribute.
    pub required: bool,
    /// `number`, `whole number`, `word`, `file`, `name`, `choice`, `formula`, `truth` or `rotation`.
    #[serde(rename = "type")]
    pub value_type: &'static str,
    /// The unit of the values, or null.
    pub unit: Option<&'static str>,
    /// The variables of a formula, or null for other types.
    pub variables: Option<&'static [&'static str]>,
}

/// The allowed numbers of values of a list.
#[derive(Serialize)]
pub struct ListOf {
    /// The number of values in each group.
    pub group: usize,
    /// The minimum number of groups.
    pub least: usize,
    /// The maximum number of groups.
    pub most: usize,
}

/// A group of attributes. A scene gives exactly one of them.
#[derive(Serialize)]
pub struct Group {
    /// The noun for each of the attributes, with its article.
    pub meaning: &'static str,
    /// The names of the attributes.
    pub names: &'static [&'static str],
}

/// One of several alternatives.
#[derive(Serialize)]
pub struct Named {
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The name in scenes.
    pub name: &'static str,
    /// The number that scenes may use for the alternative, or null.
    pub number: Option<i64>,
}

/// A type of shader.
#[derive(Serialize)]
pub struct Shader {
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The name in scenes.
    pub name: &'static str,
    /// The number that scenes may use for the shader on planes, or null.
    pub number_on_planes: Option<i64>,
    /// The number that scenes may use for the shader on spheres, or null.
    pub number_on_spheres: Option<i64>,
}

impl Tables {
    /// Describes the language of these entity types.
    pub fn of(registry: &Registry) -> Self {
        Self {
            entities: registry.iter().map(Entity::of).collect(),
            profiles: by_name::<&Profile>().map(Named::from).collect(),
            shaders: registry.iter().filter(|entity| entity.kind() == Kind::Shader).map(Shader::of).collect(),
            version: VERSION,
        }
    }
}

impl Entity {
    fn of(entity: &'static entity::Entity) -> Self {
        Self {
            aliases: entity.aliases,
            attributes: entity.attributes().map(Attribute::of).collect(),
            kind: entity.kind(),
            meaning: entity.meaning,
            name: entity.name,
            one_of: entity
                .groups()
                .map(|group| Group { meaning: group.meaning, names: group.names })
                .collect(),
        }
    }
}

impl Attribute {
    fn of(attribute: &'static dyn attribute::Attribute) -> Self {
        let (value_type, refers_to, choices) = match attribute.value_type() {
            Type::Whole => ("whole number", None, None),
            Type::Number => ("number", None, None),
            Type::Rotation => ("rotation", None, None),
            Type::Word => ("word", None, None),
            Type::File => ("file", None, None),
            Type::Formula(_) => ("formula", None, None),
            Type::Truth => ("truth", None, None),
            Type::Name(kind) => ("name", Some(kind), None),
            Type::Choice(choices) => {
                ("choice", choices.kind, Some(choices.all().into_iter().map(Named::from).collect()))
            }
        };
        let some = |text: &'static str| Some(text).filter(|text| !text.is_empty());
        let default = attribute.default();
        Self {
            aliases: attribute.aliases(),
            choices,
            counts: match attribute.arity() {
                Counts::Of(counts) => counts,
                Counts::List { .. } => &[],
            },
            list: match attribute.arity() {
                Counts::Of(_) => None,
                Counts::List { group, least, most } => Some(ListOf { group, least, most }),
            },
            period: attribute.value_type().period(),
            range: attribute.range(),
            variables: match attribute.value_type() {
                Type::Formula(variables) => Some(variables),
                _ => None,
            },
            required: default.is_none(),
            default: default.as_ref().and_then(Constant::of),
            meaning: attribute.meaning(),
            must_be: Some(attribute.rule()).filter(|rule| !rule.is_empty()),
            name: attribute.name(),
            refers_to,
            value_type,
            unit: some(attribute.unit()),
        }
    }
}

impl From<ChoiceName> for Named {
    fn from(ChoiceName { name, number, meaning, .. }: ChoiceName) -> Self {
        Self { meaning, name, number }
    }
}

impl Shader {
    fn of(entity: &'static entity::Entity) -> Self {
        let [number_on_planes, number_on_spheres] = entity.numbers;
        Self { meaning: entity.meaning, name: entity.name, number_on_planes, number_on_spheres }
    }
}

/// The default values of an attribute, or one of its allowed values.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum Constant {
    /// An integer.
    Whole(i64),
    /// Several integers.
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
    /// Returns the values of an attribute, or `None` if it has none.
    pub fn of(datum: &Datum) -> Option<Self> {
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
            // A list of objects cannot be a default.
            Datum::Objects(_) | Datum::Absent => return None,
        })
    }
}
