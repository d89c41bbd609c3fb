//! Makes a [`Model`] from a scene's entities.

use super::check::{Check, Source, TOGETHER};
use super::fault::{Fault, Places, Severity};
use super::names::suggestion;
use super::options::ReadOptions;
use super::report::Report;
use crate::registry::Registry;
use std::mem::{swap, take};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tabray_core::parallel;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::model::{Item, Model};
use tabray_core::scene::store::{Record, Store};
use tabray_core::text::list;

/// A model, the places of its entities, and the time for making it, without parsing.
pub type Checked = (Option<Model>, Places, Duration);

/// Makes a model from entities, and reports all their errors and warnings. Returns a model only for a scene without
/// errors. File names are relative to `folder`. A text with syntax errors is not read to its end.
pub fn model(
    registry: &Registry,
    folder: &Path,
    accuracy: ReadOptions<'_>,
    source: &mut Source<'_, '_>,
    report: &mut Report<'_>,
) -> Checked {
    let now = accuracy.clock.unwrap_or(|| Duration::ZERO);
    let mut check = Check::new(registry, folder, accuracy, report);
    let mut time = Duration::ZERO;
    match source {
        Source::List(parsed) => {
            let start = now();
            parsed.chunks(TOGETHER).for_each(|parsed| check.entities(&parsed.iter().collect::<Vec<_>>()));
            time += now() - start;
        }
        Source::Stream(stream) => {
            let mut entities = stream();
            while !entities.is_empty() {
                let work = || {
                    let start = now();
                    entities
                        .chunks(TOGETHER)
                        .for_each(|some| check.entities(&some.iter().collect::<Vec<_>>()));
                    time += now() - start;
                };
                let ((), next) = parallel::join(true, work, &mut *stream);
                entities = next;
            }
        }
        Source::Text(_, parser) => {
            // While some entities are checked, the next ones are parsed.
            let [mut memory, mut other] = [vec![None; TOGETHER], vec![None; TOGETHER]];
            let mut count = parser.entities(&mut memory);
            while count > 0 {
                parser.repeats.take_repeated().into_iter().for_each(|range| check.report.repeat(range));
                let entities: Vec<_> = memory[..count].iter().flatten().collect();
                let work = || {
                    let start = now();
                    check.entities(&entities);
                    time += now() - start;
                };
                (_, count) = parallel::join(count == TOGETHER, work, || parser.entities(&mut other));
                swap(&mut memory, &mut other);
            }
        }
    }
    let start = now();
    // Objects and lights are constructed last, because they may need the camera, which may come later in the text.
    let store = check.construct_waiting(source);
    check.textures_can_be_read(&store, source);
    check.light_by_background(&store, source);
    let (model, places) = check.finish(&store, source);
    (model, places, time + (now() - start))
}

/// The message about a scene without a camera.
pub const NO_CAMERA: &str = "the scene has no camera";

impl Check<'_, '_> {
    /// Returns the model, after reporting the errors that only the whole scene shows.
    fn finish(mut self, store: &Arc<Store>, source: &Source<'_, '_>) -> (Option<Model>, Places) {
        let mut camera_misspelt = false;
        self.report.count_more(Severity::Error, self.unknown.others().count());
        let mut unknown: Vec<_> = take(&mut self.unknown.names).into_iter().collect();
        unknown.sort_by_key(|(_, (place, _))| place.as_ref().map(|place| place.start));
        for ((_, name), (place, count)) in unknown {
            let is_told = self.report.would_list(Severity::Error, &place);
            let near = if is_told { self.registry.nearest(&name) } else { None };
            camera_misspelt |=
                near.and_then(|near| self.registry.find(near)).is_some_and(|e| e.kind() == Kind::Camera);
            let known = list(self.registry.iter().map(|entity| entity.name));
            let fault = Fault::error(place, format!("there is no entity type `{name}`"));
            self.report.add(
                fault
                    .label(suggestion(near, count))
                    .meant(near)
                    .help(format!("the entity types are {known}")),
            );
        }
        let parsed = |order| source.entity(self.registry, order, &self.places.get(order));
        let place = |order| parsed(order)?.name.place.clone();
        self.names.report_unresolved(self.registry, store, place, self.report);
        self.names.report_repeated(store, place, self.may_share_names, self.report);
        if let Some(first) = parsed(0)
            && self.first_camera.is_none()
            && !camera_misspelt
        {
            self.report.add(
                Fault::error(first.kind.place.clone(), NO_CAMERA).label("expected a camera").help(format!(
                    "add one: {}",
                    self.registry.example(Kind::Camera, "NAME", self.report.syntax())
                )),
            );
        }
        if let Some(levels) = self.levels.take().filter(|_| !self.report.is_fatal()) {
            self.report.add_gathered(levels);
        }
        let files = self.report.files().to_vec();
        let Self {
            camera,
            materials,
            textures,
            shaders,
            objects,
            labels,
            patterns,
            lights,
            background,
            places,
            ..
        } = self;
        let model = camera.map(|camera| Model {
            camera: item(store, camera),
            materials: materials.into_iter().map(|material| item(store, material)).collect(),
            textures: textures.into_iter().map(|texture| item(store, texture)).collect(),
            shaders: shaders.into_iter().map(|shader| item(store, shader)).collect(),
            objects,
            labels,
            patterns,
            lights,
            background: background.map(|background| item(store, background)),
            files,
        });
        (model, places)
    }
}

fn item<T>(store: &Arc<Store>, (order, value): (usize, T)) -> Item<T> {
    Item { args: Record::new(store, order), value }
}
