//! The attributes of the object that a pixel shows, as a page offers them to be changed.

use super::frame::Frame;
use crate::editor::{self, Text};
use crate::render::plan::Plan;
use crate::render::trace;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::syntax::Syntax;
use crate::scene::value::Type;
use serde::Serialize;

/// An object and those of its attributes that are numbers.
#[derive(Serialize)]
pub struct Fields {
    /// The name of the object.
    name: String,
    /// Its entity type.
    kind: &'static str,
    /// Its attributes.
    attributes: Vec<Field>,
}

/// An attribute of numbers.
#[derive(Serialize)]
struct Field {
    /// The name in the scene language.
    name: &'static str,
    /// The meaning, the unit and the rule, as people read them.
    about: String,
    /// What each of the values is, where the table names them.
    each: &'static [&'static str],
    /// The values, as a scene writes them.
    values: Vec<String>,
    /// The least and the greatest number that each value may be; null where the table does not say.
    range: Option<[f64; 2]>,
    /// Whether the values are whole numbers.
    whole: bool,
    /// Why the values cannot be changed here; null where they can be.
    fixed: Option<&'static str>,
}

/// Returns the attributes of the object that the centre of a pixel shows; `None` where it shows none.
pub fn of_pixel(registry: &Registry, frame: &Frame, [x, y]: [usize; 2]) -> Option<Fields> {
    let sight = frame.model.camera.value.sight(x as f64, y as f64);
    let hit = trace::first_hit(&Plan::new(&frame.model), &sight)?;
    let (entity, args) = (hit.object.args.entity(), hit.object.args.args());
    let view = editor::read(registry, &frame.name, Text::new(frame.text.clone()));
    let (name, written) = (hit.object.args.name(), view.entity(hit.object.args.name()));
    let field = |attribute: &'static dyn Attribute, values: Vec<String>| {
        let fixed = match &written {
            None => Some("it is repeated or included: change the text"),
            Some(entity) if view.computes(entity, attribute.name()) => {
                Some("it is a formula: change the text")
            }
            Some(_) => None,
        };
        let parts = [attribute.meaning(), attribute.unit(), &attribute.rule()];
        let about: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        Field {
            name: attribute.name(),
            about: about.join("; "),
            each: attribute.each(),
            values,
            range: attribute.range(),
            whole: matches!(attribute.value_type(), Type::Whole),
            fixed,
        }
    };
    let numbers = args.values().filter(|(attribute, _)| {
        matches!(attribute.value_type(), Type::Number | Type::Whole) && attribute.arity().most() <= 16
    });
    let attributes =
        numbers.map(|(attribute, datum)| field(attribute, Syntax::Notes.values(datum))).collect();
    Some(Fields { name: name.to_owned(), kind: entity.name, attributes })
}
