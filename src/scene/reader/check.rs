//! Checks parsed entities and makes a [`Model`] of them.

use super::attributes::{Against, whole};
use super::fault::{Fault, Place, Severity};
use super::guesses::find_attribute;
use super::names::{Names, stand_in, suggestion};
use super::parsed::{Parsed, Word};
use super::report::Report;
use crate::scene::entity::{Args, Construct, Entity, MATERIAL, Refusal, Setting};
use crate::scene::kind::Kind;
use crate::scene::model::{Item, Model, Object};
use crate::scene::registry::Registry;
use crate::scene::value::Datum;
use crate::text::list;
use crate::world::accuracy::Accuracy;
use crate::world::body::{AnyLight, Body, Warning};
use crate::world::camera::Camera;
use crate::world::material::Material;
use crate::world::texture::Texture;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Makes a model of parsed entities and reports all their faults. Returns a model only if there are no faults. File
/// names are relative to `folder`.
pub fn model(
    registry: &Registry,
    folder: &Path,
    accuracy: Chosen,
    parsed: Vec<Parsed<'_>>,
    report: &mut Report,
) -> Option<Model> {
    let names = Names::of(registry, &parsed);
    let camera = Camera { accuracy: accuracy.by_default, ..Camera::default() };
    let memory = accuracy.memory.unwrap_or(u64::MAX);
    let setting = Setting { camera, folder: folder.to_owned(), materials: Arc::default(), memory };
    let mut check = Check {
        registry,
        report,
        names,
        unknown: BTreeMap::new(),
        first_camera: None,
        setting: Arc::new(setting),
        accuracy: accuracy.above_all,
        camera: None,
        materials: Vec::new(),
        textures: Vec::new(),
        files: HashMap::new(),
        texture_memory: accuracy.memory.unwrap_or(TEXTURE_MEMORY),
        objects: Vec::new(),
        lights: Vec::new(),
    };
    // Objects and lights may ask for the camera, wherever it stands in the text, so they are constructed last.
    let waiting: Vec<_> =
        parsed.iter().enumerate().filter_map(|(order, entity)| check.table(order, entity)).collect();
    let materials = check.materials.iter().map(|item| (item.args.name.clone(), item.value.clone())).collect();
    Arc::make_mut(&mut check.setting).materials = Arc::new(materials);
    for (parsed, args) in waiting {
        check.construct(parsed, args);
    }
    check.textures_can_be_read(&parsed);
    check.finish(&parsed)
}

/// The default limit on the memory of all textures of a scene, in bytes: far more than scenes need, and far less than a
/// small file can claim to hold.
const TEXTURE_MEMORY: u64 = 1 << 30;

/// The accuracy of a scene and its memory limit, as far as the caller chooses them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chosen {
    /// The accuracy that overrides the scene's own.
    pub above_all: Option<Accuracy>,
    /// The accuracy where the scene chooses none.
    pub by_default: Accuracy,
    /// The limit on the memory of the scene's textures and of its objects' files, in bytes; by default 1 GiB for the
    /// textures, and none for the objects, which take little more than their files do.
    pub memory: Option<u64>,
}

/// An entity's checked values, with its parsed text.
type Checked<'w> = (&'w Parsed<'w>, Args);

struct Check<'r> {
    registry: &'r Registry,
    report: &'r mut Report,
    names: Names,
    /// Unknown entity types, each with all its places.
    unknown: BTreeMap<String, Vec<Place>>,
    /// The place of the first camera's name.
    first_camera: Option<Place>,
    setting: Arc<Setting>,
    /// The accuracy that overrides the scene's own.
    accuracy: Option<Accuracy>,
    camera: Option<Item<Camera>>,
    materials: Vec<Item<Arc<Material>>>,
    textures: Vec<Item<Arc<Texture>>>,
    /// The textures by the paths of their files.
    files: HashMap<PathBuf, Arc<Texture>>,
    /// How many more bytes the images of textures may take.
    texture_memory: u64,
    objects: Vec<Object>,
    lights: Vec<Item<AnyLight>>,
}

impl Check<'_> {
    /// Checks an entity against its table. An entity that others can refer to is constructed at once; the others are
    /// returned.
    fn table<'w>(&mut self, order: usize, parsed: &'w Parsed<'w>) -> Option<Checked<'w>> {
        let Some(entity) = self.registry.find(&parsed.kind.text) else {
            let kind = parsed.kind.text.to_string();
            self.unknown.entry(kind).or_default().push(parsed.kind.place.clone());
            return None;
        };
        let Word { text, place, .. } = &parsed.name;
        let counts = self.names.claim(entity, &parsed.name, self.report);
        if entity.kind() == Kind::Camera
            && let Some(first) = self.first_camera.replace(place.clone())
        {
            self.report.add(
                Fault::error(place.clone(), format!("a second camera `{text}`"))
                    .also(first, "the first one")
                    .help("a scene has exactly one camera"),
            );
        }
        let values = Against { entity, names: &mut self.names, report: self.report }.values(parsed);
        let args = values.map(|values| Args::new(entity, text.to_string(), order, values));
        if !counts {
            return None;
        }
        if matches!(entity.kind(), Kind::Object | Kind::Light) {
            return args.map(|args| (parsed, args));
        }
        if let Some(args) = args {
            self.construct(parsed, args);
        }
        // If the entity is faulty, a stand-in takes its place, so that the entities that refer to it are checked too.
        if matches!(entity.kind(), Kind::Material | Kind::Texture) {
            self.names.define(entity.kind(), text, stand_in(entity.kind(), text));
        }
        None
    }

    /// Constructs an entity from its checked values.
    fn construct(&mut self, parsed: &Parsed<'_>, mut args: Args) {
        args.setting = self.setting.clone();
        let (kind, name) = (args.entity.kind(), args.name.clone());
        match args.entity.construct {
            Construct::Camera(construct) => {
                if let Some(mut camera) = self.made(parsed, args, construct) {
                    camera.value.accuracy = self.accuracy.unwrap_or(camera.value.accuracy);
                    Arc::make_mut(&mut self.setting).camera = camera.value.clone();
                    self.camera = Some(camera);
                }
            }
            Construct::Material(construct) => {
                if let Some(Item { args, value }) = self.made(parsed, args, construct) {
                    let material = Arc::new(value);
                    let shown =
                        Datum::Material { name: Arc::from(name.as_str()), material: material.clone() };
                    self.names.define(kind, &name, shown);
                    self.materials.push(Item { args, value: material });
                }
            }
            Construct::Texture(construct) => {
                if let Some(Item { args, value }) = self.made(parsed, args, construct) {
                    self.report.add_file(value.path().to_owned());
                    // Textures with the same file share one image, so that the file is read once.
                    let texture = match self.files.entry(value.path().to_owned()) {
                        Entry::Occupied(known) => known.get().clone(),
                        Entry::Vacant(free) => free.insert(Arc::new(value)).clone(),
                    };
                    let shown = Datum::Texture { name: Arc::from(name.as_str()), texture: texture.clone() };
                    self.names.define(kind, &name, shown);
                    self.textures.push(Item { args, value: texture });
                }
            }
            Construct::Object(construct) => {
                for file in args.files() {
                    self.report.add_file(self.setting.folder.join(file));
                }
                if let Some(Item { args, value }) = self.made(parsed, args, construct) {
                    let Body { shape, shader, warnings, bytes } = value;
                    for Warning { attribute, message, help } in warnings {
                        let place = place_of(args.entity, parsed, Some(attribute));
                        let message = format!("{} `{}` {message}", args.entity.name, args.name);
                        self.report.add(Fault::warning(place, message).help(help));
                    }
                    if bytes > 0 {
                        let setting = Arc::make_mut(&mut self.setting);
                        setting.memory = setting.memory.saturating_sub(bytes);
                        self.texture_memory = self.texture_memory.min(setting.memory);
                    }
                    let material = args.get(&MATERIAL);
                    self.objects.push(Object { args, material, shape, shader });
                }
            }
            Construct::Light(construct) => {
                let light = self.made(parsed, args, construct);
                self.lights.extend(light);
            }
        }
    }

    /// Calls a constructor with checked values and reports a refusal.
    fn made<T>(
        &mut self,
        parsed: &Parsed<'_>,
        args: Args,
        construct: fn(&Args) -> Result<T, Refusal>,
    ) -> Option<Item<T>> {
        match construct(&args) {
            Ok(value) => Some(Item { args, value }),
            Err(refusal) => {
                debug_assert!(
                    args.has_what_is_refused(&refusal),
                    "the plugin `{}` refuses `{}`, which is not in the table it registers at {}: name an attribute of that table",
                    args.entity.name,
                    refusal.attribute.unwrap_or_default(),
                    args.entity.place()
                );
                let place = place_of(args.entity, parsed, refusal.attribute);
                let message = format!("{} `{}` {}", args.entity.name, args.name, refusal.message);
                self.report.add(Fault::error(place, message).help(refusal.help));
                None
            }
        }
    }

    /// Reads the textures that some entity refers to, and no others.
    fn textures_can_be_read(&mut self, parsed: &[Parsed<'_>]) {
        let users =
            self.objects.iter().map(|object| &object.args).chain(self.lights.iter().map(|light| &light.args));
        let used: BTreeSet<_> = users.flat_map(|args| args.textures()).collect();
        for Item { args, value } in &self.textures {
            if !used.contains(args.name.as_str()) {
                continue;
            }
            let read = value.load_within(self.texture_memory);
            self.texture_memory -= value.bytes().min(self.texture_memory);
            if let Err(reason) = read {
                let is_told = self.report.tells(Severity::Error, &parsed[args.order].place);
                let near = if is_told { value.near() } else { None };
                let reason =
                    near.map_or(reason.to_owned(), |near| format!("it does not exist, but `{near}` does"));
                let message = format!("the file of texture `{}` cannot be read: {reason}", args.name);
                let mut files = args.values().filter(|(_, datum)| matches!(datum, Datum::Word(_)));
                let place =
                    place_of(args.entity, &parsed[args.order], files.next().map(|(file, _)| file.name()));
                self.report.add(
                    Fault::error(place, message).help(
                        "a texture is a PPM or PNG file, and its name is relative to the scene's folder",
                    ),
                );
            }
        }
    }

    /// Returns the model, after reporting the faults that show only when the whole scene has been read.
    fn finish(mut self, parsed: &[Parsed<'_>]) -> Option<Model> {
        let mut camera_misspelt = false;
        let mut unknown: Vec<_> = std::mem::take(&mut self.unknown).into_iter().collect();
        unknown.sort_by_key(|(_, places)| places[0].as_ref().map(|place| place.start));
        for (name, places) in unknown {
            let is_told = self.report.tells(Severity::Error, &places[0]);
            let near = if is_told { self.registry.nearest(&name) } else { None };
            camera_misspelt |=
                near.and_then(|near| self.registry.find(near)).is_some_and(|e| e.kind() == Kind::Camera);
            let known = list(self.registry.iter().map(|entity| entity.name));
            let fault = Fault::error(places[0].clone(), format!("there is no entity type `{name}`"));
            self.report
                .add(fault.label(suggestion(near, &places)).help(format!("the entity types are {known}")));
        }
        self.names.report_unresolved(self.registry, self.report);
        self.names.report_repeated(self.report);
        if let Some(first) = parsed.first()
            && self.first_camera.is_none()
            && !camera_misspelt
        {
            self.report.add(
                Fault::error(first.kind.place.clone(), "the scene has no camera")
                    .label("expected a camera")
                    .help(format!(
                        "add one: {}",
                        self.registry.example(Kind::Camera, "NAME", self.report.syntax())
                    )),
            );
        }
        let Self { camera, materials, textures, objects, lights, .. } = self;
        Some(Model { camera: camera?, materials, textures, objects, lights })
    }
}

/// Returns the place of an attribute with its values, or of the entity's name where the attribute is not given.
fn place_of(entity: &'static Entity, parsed: &Parsed<'_>, attribute: Option<&str>) -> Place {
    let known = |word: &Word<'_>| find_attribute(entity, &word.text).map(|known| known.name());
    let given = attribute
        .and_then(|attribute| parsed.attributes.iter().rfind(|(word, _)| known(word) == Some(attribute)));
    given.map_or(parsed.name.place.clone(), |(word, values)| whole(word, values))
}
