//! The tables for other programs, as JSON: the whole scene language. `docs/data/fields.csv` describes the same fields.
//!
//! Fields are declared in the order in which they are written.

use crate::reference::by_name;
use crate::registry::Registry;
use crate::schema::Constant;
use serde::Serialize;
use std::borrow::Cow;
use tabray_core::scene::attribute;
use tabray_core::scene::choice::ChoiceName;
use tabray_core::scene::counts::Counts;
use tabray_core::scene::entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::profile::Profile;
use tabray_core::scene::value::Type;

/// The format's version: it grows when a field is removed or changes its meaning, and not when one is added.
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
    /// The format's version: it grows when a field is removed or changes its meaning, and not when one is added.
    pub version: u32,
}

/// An entity type.
#[derive(Serialize)]
pub struct Entity {
    /// Other names that scenes may use.
    pub aliases: &'static [&'static str],
    /// The type's attributes, in the order of the dump.
    pub attributes: Vec<Attribute>,
    /// `camera`, `material`, `texture`, `shader`, `object`, `light` or `background`.
    pub kind: Kind,
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The name in scenes.
    pub name: &'static str,
    /// The groups of attributes from each of which a scene gives exactly one.
    pub one_of: Vec<Group>,
}

/// An attribute.
#[derive(Serialize)]
pub struct Attribute {
    /// Other names that scenes may use.
    pub aliases: &'static [&'static str],
    /// All allowed values of a choice; null for other types.
    pub choices: Option<Vec<Named>>,
    /// The numbers of values that the attribute may take: `[1, 3]` for one or three; empty for a list.
    pub counts: &'static [usize],
    /// The values where a scene gives none: one value, or several in an array; null where there is no default.
    pub default: Option<Constant>,
    /// The numbers of values that a list takes; null for other attributes.
    pub list: Option<ListOf>,
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The rule for the values, in words that end "it must be ...", or null.
    pub must_be: Option<Cow<'static, str>>,
    /// The name in scenes.
    pub name: &'static str,
    /// The least and the greatest number that makes a difference, such as an angle's within a full turn; null where there
    /// are none.
    pub period: Option<[f64; 2]>,
    /// The least and the greatest number that each value may be; null where there are none.
    pub range: Option<[f64; 2]>,
    /// The kind of entity that a name refers to, also where it may stand for a choice; null for other types.
    pub refers_to: Option<Kind>,
    /// Whether a scene must give it.
    pub required: bool,
    /// `number`, `whole number`, `word`, `file`, `name`, `choice`, `formula`, `truth` or `rotation`.
    #[serde(rename = "type")]
    pub value_type: &'static str,
    /// The unit of the values, or null.
    pub unit: Option<&'static str>,
    /// The variables of a formula; null for other types.
    pub variables: Option<&'static [&'static str]>,
}

/// The numbers of values that a list takes.
#[derive(Serialize)]
pub struct ListOf {
    /// The number of values in each group.
    pub group: usize,
    /// The least number of groups.
    pub least: usize,
    /// The most number of groups.
    pub most: usize,
}

/// Attributes from which a scene gives exactly one.
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
    /// The number by which scenes may choose the alternative, or null.
    pub number: Option<i64>,
}

/// A type of shader.
#[derive(Serialize)]
pub struct Shader {
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The name in scenes.
    pub name: &'static str,
    /// The number by which scenes may choose the shader on planes, or null.
    pub number_on_planes: Option<i64>,
    /// The number by which scenes may choose the shader on spheres, or null.
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
