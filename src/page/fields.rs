//! The numbers of a scene's entities, as a page offers them to be changed.

use super::Shown;
use super::trial_values::given;
use serde::Serialize;
use std::borrow::Cow;
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::COLOUR;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::model::Model;
use tabray_core::scene::store::Record;
use tabray_core::scene::value::{Datum, Type};
use tabray_editor::View;
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// An entity of a scene, or its named numbers.
#[derive(Serialize)]
pub struct Named {
    /// The key for a page's requests: its index among the scene's entities, from 0, or the word for numbers.
    pub(super) order: String,
    /// Its entity type.
    pub(super) kind: &'static str,
    pub(super) name: String,
}

/// An entity and those of its attributes that are numbers.
#[derive(Serialize)]
pub struct Fields {
    #[serde(flatten)]
    pub(super) entity: Named,
    pub(super) attributes: Vec<Field>,
}

/// An attribute of numbers, or a named number.
#[derive(Serialize)]
pub(super) struct Field {
    /// The name in the scene language.
    pub name: Cow<'static, str>,
    /// The name of its material, if it is a colour of that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// What people read in place of the name, where the scene says so.
    pub label: Option<String>,
    /// The meaning, the unit and the rule, as people read them.
    pub about: String,
    /// The name of each value, where the table has names.
    pub each: &'static [&'static str],
    /// The values, as a scene writes them.
    pub values: Vec<String>,
    /// The least and the greatest number that each value may be; null where the table does not say.
    pub range: Option<[f64; 2]>,
    /// Which numbers the values may be: `any`, `not negative` or `positive`.
    pub signs: &'static str,
    /// Whether the values are whole numbers.
    pub whole: bool,
    /// Why the values cannot be changed here; null where they can be.
    pub fixed: Option<&'static str>,
}

/// The maximum number of entities that a page lists.
const MAX_FIELDS: usize = 1000;

/// Returns the entities of a scene: the camera, the lights, the background, the materials and the objects.
fn records(model: &Model) -> impl Iterator<Item = &Record> {
    let lights = model.lights.iter().map(|light| &light.args);
    let background = model.background.iter().map(|background| &background.args);
    let materials = model.materials.iter().map(|material| &material.args);
    let objects = model.objects.iter().map(|object| &object.args);
    [&model.camera.args].into_iter().chain(lights).chain(background).chain(materials).chain(objects)
}

fn named(record: &Record) -> Named {
    Named { order: record.order().to_string(), kind: record.entity().name, name: record.name().to_owned() }
}

/// Lists the entities of a scene that have numbers, or the first of them.
pub fn all(model: &Model) -> impl Iterator<Item = Named> {
    let has_numbers = |record: &&Record| record.entity().attributes().any(is_number);
    records(model).filter(has_numbers).take(MAX_FIELDS).map(named)
}

/// Returns the attributes of the object that the centre of a pixel shows; `None` where it shows none.
pub fn of_pixel(registry: &Registry, shown: Shown, [x, y]: [usize; 2]) -> Option<Fields> {
    let sight = shown.model.camera.value.sight(x as f64, y as f64);
    let hit = trace::first_hit(&Plan::new(shown.model), &sight)?;
    Some(of(registry, shown, &hit.object.args))
}

/// Returns the attributes of an entity by its index; `None` if the scene has none.
pub fn of_entity(registry: &Registry, shown: Shown, order: usize) -> Option<Fields> {
    let record = records(shown.model).find(|record| record.order() == order)?;
    Some(of(registry, shown, record))
}

fn is_number(attribute: &'static dyn Attribute) -> bool {
    matches!(attribute.value_type(), Type::Number | Type::Whole) && attribute.arity().most() <= 16
}

/// Returns why the values of an entity's attribute cannot be changed in the text; `None` where they can be.
pub fn fixed(view: &View, name: &str, attribute: &dyn Attribute) -> Option<&'static str> {
    match view.entity(name) {
        None => Some("it is repeated or included: change the text"),
        Some(entity) if view.computes(entity, attribute.name()) => Some("it is a formula: change the text"),
        Some(_) => None,
    }
}

/// Returns which numbers the values of an attribute may be.
fn signs(attribute: &dyn Attribute, count: usize) -> &'static str {
    let may_be = |number: i8| {
        attribute.allows(&match attribute.value_type() {
            Type::Whole => Datum::Whole(vec![number.into(); count]),
            _ => Datum::Numbers(vec![number.into(); count]),
        })
    };
    match [-1, 0].map(may_be) {
        [true, _] => "any",
        [_, true] => "not negative",
        _ => "positive",
    }
}

fn of(registry: &Registry, shown: Shown, record: &Record) -> Fields {
    let args = record.args();
    let view = shown.view(registry);
    let field = |attribute: &'static dyn Attribute, values: Vec<String>| {
        let parts = [attribute.meaning(), attribute.unit(), &attribute.rule()];
        let about: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        Field {
            name: attribute.name().into(),
            material: None,
            label: None,
            about: about.join("; "),
            each: attribute.each(),
            signs: signs(attribute, values.len()),
            values,
            range: attribute.range(),
            whole: matches!(attribute.value_type(), Type::Whole),
            fixed: fixed(&view, record.name(), attribute),
        }
    };
    let numbers =
        args.values().filter(|(attribute, datum)| is_number(*attribute) && !matches!(datum, Datum::Absent));
    let own = numbers.map(|(attribute, datum)| field(attribute, Syntax::Notes.values(datum)));
    // The colours that the text gives the object's material.
    let name = args.values().find_map(|(_, datum)| match datum {
        Datum::Material { name, .. } => Some(&**name),
        _ => None,
    });
    let material = shown.model.materials.iter().find(|material| Some(material.args.name()) == name);
    let values = material.map(|material| material.args.args());
    let colours = values.iter().flat_map(|values| values.values()).filter(|(attribute, _)| {
        let name = name.unwrap_or_default();
        attribute.each() == COLOUR
            && fixed(&view, name, *attribute).is_none()
            && !given(&view, name, attribute.name()).is_empty()
    });
    let colours = colours.map(|(attribute, datum)| Field {
        material: name.map(str::to_owned),
        ..field(attribute, Syntax::Notes.values(datum))
    });
    Fields { entity: named(record), attributes: colours.chain(own).collect() }
}
