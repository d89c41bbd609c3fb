//! Warnings about the light of surfaces where it does not count, or counts twice.

use super::fault::Fault;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::model::{Model, Object};
use tabray_core::scene::value::Datum;
use tabray_core::world::material::{Material, Rgb};

/// Returns what to warn of in a scene.
pub fn warnings(model: &Model) -> impl Iterator<Item = Fault> {
    [counted_twice(model), left_out(model), met_by_chance(model)].into_iter().flatten()
}

/// Warns of `ambient` beside `bounces`.
fn counted_twice(model: &Model) -> Option<Fault> {
    if model.camera.value.bounces == 0 {
        return None;
    }
    let has_both = |material: &Material| material.ambient != Rgb::ZERO && material.diffuse != Rgb::ZERO;
    let material = model.materials.iter().find(|item| has_both(&item.value))?;
    let message = format!("the `ambient` of `{}` counts beside the light of `bounces`", material.args.name());
    Some(Fault::warning(None, message).help(
        "`ambient` stands in for light from everywhere, which `bounces` computes: leave one of them out",
    ))
}

/// Warns of emission in a material that is not an object's own.
fn left_out(model: &Model) -> Option<Fault> {
    let kinds = [Kind::Object, Kind::Shader].into_iter().flat_map(|kind| model.entities(kind));
    let found = kinds.into_iter().find_map(|record| {
        let args = record.args();
        let mut values = args.values().filter(|(attribute, _)| attribute.name() != "material");
        values.find_map(|(_, value)| match value {
            Datum::Material { name, material } if material.emission != Rgb::ZERO => Some(name.to_string()),
            _ => None,
        })
    })?;
    let message = format!("the `emission` of `{found}` does not count here");
    Some(Fault::warning(None, message).help("only an object's own `material` gives light by `emission`"))
}

/// Warns of a surface that gives light and that no sample aims at.
fn met_by_chance(model: &Model) -> Option<Fault> {
    if model.camera.value.bounces == 0 {
        return None;
    }
    let is_met =
        |object: &&Object| object.material.emission != Rgb::ZERO && object.shape.luminous().is_none();
    let name = model.objects.iter().find(is_met)?.args.name();
    let message = format!("samples meet the light of `{name}` by chance alone, so it takes many of them");
    Some(Fault::warning(None, message).help(
        "samples aim at spheres, discs, rectangles, boxes and meshes with `emission`: let one of these give the light",
    ))
}
