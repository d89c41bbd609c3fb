//! The tables as JSON: all that the scene language has, for programs. `docs/tools.md` tells what each field means.

use crate::scene::choice::{Choice, ChoiceName};
use crate::scene::entity::Entity;
use crate::scene::pparm::Attribute;
use crate::scene::procedural::{OnPlane, OnSphere};
use crate::scene::profile::Profile;
use crate::scene::registry::Registry;
use crate::scene::schema::constant;
use crate::scene::value::{Datum, Type};
use serde_json::{Value, json};

/// Grows when a field is taken away or comes to mean something else, and not when one is added.
const VERSION: u32 = 1;

/// The entity types with their attributes, the procedural shaders and the profiles, each sorted by name.
pub fn json(registry: &Registry) -> Value {
    json!({
        "version": VERSION,
        "entities": registry.iter().map(entity).collect::<Vec<_>>(),
        "shaders": shaders(),
        "profiles": by_name::<&Profile>().into_iter().map(choice).collect::<Vec<_>>(),
    })
}

fn entity(entity: &'static Entity) -> Value {
    json!({
        "name": entity.name,
        "kind": entity.kind().to_string(),
        "meaning": entity.meaning,
        "aliases": entity.aliases,
        "attributes": entity.attributes().map(attribute).collect::<Vec<_>>(),
    })
}

fn attribute(attribute: &'static dyn Attribute) -> Value {
    let (value_type, refers_to, choices) = match attribute.value_type() {
        Type::Whole => ("whole number", None, None),
        Type::Number => ("number", None, None),
        Type::Word => ("word", None, None),
        Type::Formula => ("formula", None, None),
        Type::Name(kind) => ("name", Some(kind.to_string()), None),
        Type::Choice(choices) => {
            ("choice", None, Some(choices.all().into_iter().map(choice).collect::<Vec<_>>()))
        }
    };
    let default = attribute.default();
    json!({
        "name": attribute.name(),
        "aliases": attribute.aliases(),
        "meaning": attribute.meaning(),
        "unit": some(attribute.unit()),
        "type": value_type,
        "counts": attribute.arity(),
        "refers_to": refers_to,
        "choices": choices,
        "required": default.is_none(),
        "default": default.filter(|default| *default != Datum::Absent).map(|default| constant(&default)),
        "must_be": some(attribute.rule()),
    })
}

/// The shaders, which may have a number on planes and another one on spheres.
fn shaders() -> Vec<Value> {
    let on_spheres = by_name::<OnSphere>();
    let numbers = by_name::<OnPlane>().into_iter().zip(on_spheres);
    numbers
        .map(|(on_plane, on_sphere)| {
            json!({
                "name": on_plane.name,
                "meaning": on_plane.meaning,
                "number_on_planes": on_plane.number,
                "number_on_spheres": on_sphere.number,
            })
        })
        .collect()
}

fn choice(choice: ChoiceName) -> Value {
    json!({ "name": choice.name, "meaning": choice.meaning, "number": choice.number })
}

fn by_name<T: Choice>() -> Vec<ChoiceName> {
    let mut all: Vec<_> = T::all().iter().map(T::option).collect();
    all.sort_by_key(|choice| choice.name);
    all
}

fn some(text: &str) -> Option<&str> {
    Some(text).filter(|text| !text.is_empty())
}
