//! The lights that facets of rough surfaces mirror: rays meet them both by chance and by aim.

use tabray_world::lamp::Lamp;
use tabray_world::rules::Rules;
use tabray_world::scene::kind::Kind;
use tabray_world::scene::model::{Model, Object};

/// Tells whether facets aim at a light: it has a size, and is seen in mirrors.
pub fn is_aimed_at(light: &Lamp) -> bool {
    !light.is_far() && light.emitter().is_some_and(|emitter| !emitter.has_highlights())
}

/// Returns, for each object of a scene, the index of the light whose visible shape it is, among these lights, if facets aim
/// at it; nothing where facets aim at none.
pub fn of(model: &Model, lights: &[usize]) -> Vec<Option<usize>> {
    let aimed: Vec<usize> =
        lights.iter().copied().filter(|index| is_aimed_at(&model.lights[*index].value)).collect();
    if aimed.is_empty()
        || model.camera.value.rules == Rules::Notes
        || model.objects.iter().all(|object| object.material.roughness() == 0.0)
    {
        return Vec::new();
    }
    let lamp = |order: usize| aimed.iter().copied().find(|index| model.lights[*index].args.order() == order);
    let lamp_of = |object: &Object| {
        let is_lamp = object.args.entity().kind() == Kind::Light;
        is_lamp.then(|| lamp(object.args.order())).flatten()
    };
    model.objects.iter().map(lamp_of).collect()
}
