//! The tables for programs, as JSON: all that the scene language has. `docs/tools.md` tells the same of each field.
//!
//! Fields stand in the order in which they are written.

use crate::scene::choice::ChoiceName;
use crate::scene::entity;
use crate::scene::kind::Kind;
use crate::scene::pparm;
use crate::scene::procedural::{OnPlane, OnSphere};
use crate::scene::profile::Profile;
use crate::scene::reference::by_name;
use crate::scene::registry::Registry;
use crate::scene::schema::Constant;
use crate::scene::value::Type;
use serde::Serialize;
use std::iter;

/// Grows when a field is taken away or comes to mean something else, and not when one is added.
const VERSION: u32 = 1;

/// All that the language has.
#[derive(Serialize)]
pub struct Tables {
    /// The entity types, sorted by name.
    pub entities: Vec<Entity>,
    /// The profiles, sorted by name.
    pub profiles: Vec<Named>,
    /// The procedural shaders, sorted by name.
    pub shaders: Vec<Shader>,
    /// Grows when a field is taken away or comes to mean something else, and not when one is added.
    pub version: u32,
}

/// An entity type.
#[derive(Serialize)]
pub struct Entity {
    /// Other names that scenes may use.
    pub aliases: &'static [&'static str],
    /// Its attributes, in the order of the dump.
    pub attributes: Vec<Attribute>,
    /// `camera`, `material`, `texture`, `object` or `light`.
    pub kind: Kind,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// What scenes call it.
    pub name: &'static str,
}

/// An attribute.
#[derive(Serialize)]
pub struct Attribute {
    /// Other names that scenes may use.
    pub aliases: &'static [&'static str],
    /// For a choice, all that it may be; else null.
    pub choices: Option<Vec<Named>>,
    /// How many values it takes: `[1, 3]` for one or three.
    pub counts: &'static [usize],
    /// Its values where a scene gives none: one value, or several in an array; null where there is nothing then.
    pub default: Option<Constant>,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// The rule for its values, in words that end "it must be ...", or null.
    pub must_be: Option<&'static str>,
    /// What scenes call it.
    pub name: &'static str,
    /// For a name, the kind of entity that it is the name of; else null.
    pub refers_to: Option<Kind>,
    /// Whether a scene must give it.
    pub required: bool,
    /// `number`, `whole number`, `word`, `name`, `choice` or `formula`.
    #[serde(rename = "type")]
    pub value_type: &'static str,
    /// The unit of its values, or null.
    pub unit: Option<&'static str>,
}

/// One of several things to choose from.
#[derive(Serialize)]
pub struct Named {
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// What scenes call it.
    pub name: &'static str,
    /// The number by which scenes may choose it, or null.
    pub number: Option<i64>,
}

/// A procedural shader.
#[derive(Serialize)]
pub struct Shader {
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// What scenes call it.
    pub name: &'static str,
    /// The number by which scenes may choose it on planes, or null.
    pub number_on_planes: Option<i64>,
    /// The number by which scenes may choose it on spheres, or null.
    pub number_on_spheres: Option<i64>,
}

impl Tables {
    /// The language of these entity types.
    pub fn of(registry: &Registry) -> Self {
        Self {
            entities: registry.iter().map(Entity::of).collect(),
            profiles: by_name::<&Profile>().map(Named::from).collect(),
            shaders: iter::zip(by_name::<OnPlane>(), by_name::<OnSphere>()).map(Shader::of).collect(),
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
        }
    }
}

impl Attribute {
    fn of(attribute: &'static dyn pparm::Attribute) -> Self {
        let (value_type, refers_to, choices) = match attribute.value_type() {
            Type::Whole => ("whole number", None, None),
            Type::Number => ("number", None, None),
            Type::Word => ("word", None, None),
            Type::Formula => ("formula", None, None),
            Type::Name(kind) => ("name", Some(kind), None),
            Type::Choice(choices) => {
                ("choice", None, Some(choices.all().into_iter().map(Named::from).collect()))
            }
        };
        let some = |text: &'static str| Some(text).filter(|text| !text.is_empty());
        let default = attribute.default();
        Self {
            aliases: attribute.aliases(),
            choices,
            counts: attribute.arity(),
            required: default.is_none(),
            default: default.as_ref().and_then(Constant::of),
            meaning: attribute.meaning(),
            must_be: some(attribute.rule()),
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
    fn of((on_plane, on_sphere): (ChoiceName, ChoiceName)) -> Self {
        Self {
            meaning: on_plane.meaning,
            name: on_plane.name,
            number_on_planes: on_plane.number,
            number_on_spheres: on_sphere.number,
        }
    }
}
