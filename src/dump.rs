//! A model as text: as the notes' program dumps it, or as a scene that loads again.

use crate::entity::{Args, Kind};
use crate::model::Model;
use crate::pparm::Attribute;
use crate::value::Datum;

/// The notes' dump: camera, materials, objects and lights, numbers to one decimal. Textures are not in it.
pub fn notes(model: &Model) -> String {
    let kinds = [Kind::Camera, Kind::Material, Kind::Object, Kind::Light];
    kinds.into_iter().flat_map(|kind| model.entities(kind)).map(notes_block).collect()
}

fn notes_block(args: &Args) -> String {
    let (before, after_name, after) = match args.entity.kind() {
        Kind::Camera => ("", "", "\n\n"),
        Kind::Material | Kind::Texture => ("\n", " ", ""),
        Kind::Object | Kind::Light => ("", " ", "\n"),
    };
    let lines: String = args.entity.rows().map(|row| row.dump(args)).collect();
    format!("{before}{:<12} {}{after_name}\n{lines}{after}", args.entity.dump_name, args.name)
}

/// A scene in the notes' language that loads again to the identical model: every number to its last bit, the
/// entities in their order. Values that are the default are left out.
pub fn ray(model: &Model) -> String {
    let blocks: Vec<_> = in_order(model).into_iter().map(ray_block).collect();
    blocks.join("\n")
}

fn ray_block(args: &Args) -> String {
    let given = given(args);
    let width = given.iter().map(|(attribute, _)| attribute.name().len()).max().unwrap_or(0);
    let lines: String = given
        .iter()
        .map(|(attribute, datum)| format!("    {:<width$} {datum}\n", attribute.name()))
        .collect();
    format!("{} {}\n{{\n{lines}}}\n", args.entity.name, args.name)
}

/// All entities of a model in the order of its scene.
fn in_order(model: &Model) -> Vec<&Args> {
    let kinds = [Kind::Camera, Kind::Material, Kind::Texture, Kind::Object, Kind::Light];
    let mut all: Vec<_> = kinds.into_iter().flat_map(|kind| model.entities(kind)).collect();
    all.sort_by_key(|args| args.order);
    all
}

/// The attributes that are not at their default, or all where there would be none.
fn given(args: &Args) -> Vec<(&'static dyn Attribute, &Datum)> {
    // Compared as text: 0 and -0 are equal and yet not the same.
    let is_default = |attribute: &dyn Attribute, datum: &Datum| {
        attribute.default().is_some_and(|default| default.to_string() == datum.to_string())
    };
    let given: Vec<_> = args.values().filter(|(attribute, datum)| !is_default(*attribute, datum)).collect();
    if given.is_empty() { args.values().collect() } else { given }
}
