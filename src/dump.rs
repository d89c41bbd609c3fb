//! A model as text: as the notes' program dumps it, or as a scene that loads again.

use crate::entity::{Args, Kind};
use crate::model::Model;

/// The notes' dump: camera, materials, objects and lights, numbers to one decimal.
pub fn notes(model: &Model) -> String {
    let mut text = String::new();
    let kinds = [Kind::Camera, Kind::Material, Kind::Object, Kind::Light];
    for (kind, args) in kinds.into_iter().flat_map(|kind| entities(model, kind).map(move |args| (kind, args)))
    {
        let (before, after_name, after) = match kind {
            Kind::Camera => ("", "", "\n\n"),
            Kind::Material => ("\n", " ", ""),
            Kind::Object | Kind::Light => ("", " ", "\n"),
        };
        text += before;
        text += &format!("{:<12} {}{after_name}\n", args.entity.dump_name, args.name);
        text.extend(args.entity.rows().map(|row| row.dump(args)));
        text += after;
    }
    text
}

/// A scene in the notes' language that loads again to the identical model: every number to its last bit.
pub fn ray(model: &Model) -> String {
    let mut text = String::new();
    for kind in [Kind::Camera, Kind::Material, Kind::Light, Kind::Object] {
        for args in entities(model, kind) {
            if !text.is_empty() {
                text.push('\n');
            }
            text += &entity(args);
        }
    }
    text
}

fn entity(args: &Args) -> String {
    let mut text = format!("{} {}\n{{\n", args.entity.name, args.name);
    let width = args.values().map(|(attribute, _)| attribute.name().len()).max().unwrap_or(0);
    for (attribute, datum) in args.values() {
        text += &format!("    {:<width$} {datum}\n", attribute.name());
    }
    text + "}\n"
}

fn entities(model: &Model, kind: Kind) -> Box<dyn Iterator<Item = &Args> + '_> {
    match kind {
        Kind::Camera => Box::new(std::iter::once(&model.camera.args)),
        Kind::Material => Box::new(model.materials.iter().map(|item| &item.args)),
        Kind::Object => Box::new(model.objects.iter().map(|object| &object.args)),
        Kind::Light => Box::new(model.lights.iter().map(|item| &item.args)),
    }
}
