//! Checks parsed entities and makes a [`Model`] of them.

use super::attributes::{Against, whole};
use super::fault::{Fault, Place, Places, Severity};
use super::guesses::find_attribute;
use super::made::{Made, made};
use super::names::{Missing, Names, stand_in, suggestion};
use super::notes;
use super::parsed::{Parsed, Word};
use super::quick::Quick;
use super::report::Report;
use super::threads::Threads;
use crate::scene::entity::{Args, Construct, Entity, Refusal, Setting};
use crate::scene::kind::Kind;
use crate::scene::model::{Item, Model, Object};
use crate::scene::registry::Registry;
use crate::scene::store::{Record, Store};
use crate::scene::value::Datum;
use crate::text::list;
use crate::world::accuracy::Accuracy;
use crate::world::body::{AnyLight, Body};
use crate::world::camera::Camera;
use crate::world::material::Material;
use crate::world::texture::Texture;
use std::borrow::Cow;
use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap};
use std::mem::{replace, swap, take};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The entities of a scene: parsed while they are checked, or all of them parsed before.
pub enum Source<'s, 'a> {
    /// A text in the notes' syntax, and its parser.
    Text(&'a str, notes::Parser<'a, 's>),
    /// Entities in their order.
    List(&'s [Parsed<'a>]),
}

impl<'a> Source<'_, 'a> {
    /// Returns an entity whose place is known.
    fn entity(&self, registry: &Registry, order: usize, place: &Place) -> Option<Cow<'_, Parsed<'a>>> {
        match self {
            Self::Text(text, _) => notes::again(registry, text, place.as_ref()?.start).map(Cow::Owned),
            Self::List(parsed) => parsed.get(order).map(Cow::Borrowed),
        }
    }
}

/// The number of entities that are parsed and then checked at one time: 8 times what a thread checks at one time.
const TOGETHER: usize = 1 << 11;
const PIECE: usize = 1 << 8;

/// A model, the places of its entities, and the time that it took to make, in addition to parsing.
pub type Checked = (Option<Model>, Places, Duration);

/// Makes a model of entities and reports all their faults. Returns a model only if there are no faults. File names are
/// relative to `folder`. If the text has syntax errors, it is not read to its end.
pub fn model(
    registry: &Registry,
    folder: &Path,
    accuracy: Chosen,
    source: &mut Source<'_, '_>,
    report: &mut Report<'_>,
) -> Checked {
    let camera = Camera { accuracy: accuracy.by_default, ..Camera::default() };
    let setting = Setting { camera, folder: folder.to_owned() };
    let threads = Threads::default();
    let mut check = Check {
        registry,
        report,
        names: Names::default(),
        unknown: Missing::default(),
        first_camera: None,
        setting: Arc::new(setting),
        accuracy: accuracy.above_all,
        store: Store::default(),
        places: Places::default(),
        camera: None,
        materials: Vec::new(),
        textures: Vec::new(),
        files: HashMap::new(),
        texture_memory: accuracy.textures.unwrap_or(TEXTURE_MEMORY),
        objects: Vec::new(),
        patterns: Vec::new(),
        lights: Vec::new(),
        quick: Quick::new(registry),
        threads: &threads,
    };
    let mut time = Duration::ZERO;
    match source {
        Source::List(parsed) => {
            let start = Instant::now();
            parsed.chunks(TOGETHER).for_each(|parsed| check.entities(&parsed.iter().collect::<Vec<_>>()));
            time += start.elapsed();
        }
        Source::Text(_, parser) => {
            // While some are checked, the next ones are parsed.
            let [mut memory, mut other] = [vec![None; TOGETHER], vec![None; TOGETHER]];
            let mut count = parser.entities(&mut memory);
            while count > 0 {
                let entities: Vec<_> = memory[..count].iter().flatten().collect();
                let work = || {
                    let start = Instant::now();
                    check.entities(&entities);
                    time += start.elapsed();
                };
                (_, count) = threads.join(count == TOGETHER, work, || parser.entities(&mut other));
                swap(&mut memory, &mut other);
            }
        }
    }
    let start = Instant::now();
    // Objects and lights may ask for the camera, wherever it stands in the text, so they are constructed last.
    let store = check.construct_waiting(source);
    check.textures_can_be_read(&store, source);
    let (model, places) = check.finish(&store, source);
    (model, places, time + start.elapsed())
}

/// The default limit on the memory of all textures of a scene, in bytes: far more than scenes need, and far less than a
/// small file can claim to hold.
const TEXTURE_MEMORY: u64 = 1 << 30;

/// The accuracy of a scene and the memory limit of its textures, as far as the caller chooses them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chosen {
    /// The accuracy that overrides the scene's own.
    pub above_all: Option<Accuracy>,
    /// The accuracy where the scene chooses none.
    pub by_default: Accuracy,
    /// The limit on the memory of the scene's textures, in bytes; by default 1 GiB.
    pub textures: Option<u64>,
}

struct Check<'r, 't> {
    registry: &'r Registry,
    report: &'r mut Report<'t>,
    names: Names,
    /// Unknown entity types.
    unknown: Missing<()>,
    /// The place of the first camera's name.
    first_camera: Option<Place>,
    setting: Arc<Setting>,
    /// The accuracy that overrides the scene's own.
    accuracy: Option<Accuracy>,
    /// The entities as they were given, and where.
    store: Store,
    places: Places,
    /// What was constructed, with the orders of the entities.
    camera: Option<(usize, Camera)>,
    materials: Vec<(usize, Arc<Material>)>,
    textures: Vec<(usize, Arc<Texture>)>,
    /// The textures by the paths of their files.
    files: HashMap<PathBuf, Arc<Texture>>,
    /// How many more bytes the images of textures may take.
    texture_memory: u64,
    objects: Vec<Object>,
    /// The objects that other entities refer to.
    patterns: Vec<Record>,
    lights: Vec<Item<AnyLight>>,
    quick: Quick<'r>,
    threads: &'r Threads,
}

impl Check<'_, '_> {
    /// Checks some entities that follow each other.
    fn entities<'p>(&mut self, parsed: &[&'p Parsed<'p>]) {
        let mut rest = parsed;
        while let Some(first) = rest.first() {
            // What others can refer to is defined before they are checked.
            let waiting = rest.iter().take_while(|parsed| self.quick.waits(parsed)).count();
            if waiting == 0 {
                self.entity(first);
                rest = &rest[1..];
                continue;
            }
            let (run, others) = rest.split_at(waiting);
            rest = others;
            if run.len() <= PIECE {
                let mut quick = replace(&mut self.quick, Quick::new(self.registry));
                quick.check(&self.names, &self.store, run);
                self.take(run, &quick);
                self.quick = quick;
                continue;
            }
            let (registry, names, store) = (self.registry, &self.names, &self.store);
            let pieces: Vec<_> = run.chunks(PIECE).collect();
            let checked = self.threads.map(pieces.len(), |piece| {
                let mut quick = Quick::new(registry);
                quick.check(names, store, pieces[piece]);
                quick
            });
            pieces.into_iter().zip(&checked).for_each(|(run, quick)| self.take(run, quick));
        }
    }

    /// Takes over entities that were checked, and checks those again about which there is something to say.
    fn take(&mut self, parsed: &[&Parsed<'_>], quick: &Quick<'_>) {
        for (parsed, packed) in parsed.iter().zip(quick.packed()) {
            match packed {
                None => self.entity(parsed),
                Some((entity, packed)) => {
                    if self.names.claim(&self.store, entity, &parsed.name, self.report) {
                        self.store.add_packed(packed);
                    } else {
                        self.store.add(entity, &parsed.name.text, None);
                    }
                    self.places.add(&parsed.place);
                }
            }
        }
    }

    /// Checks an entity against its table. An entity that others can refer to is constructed at once; the others wait.
    fn entity(&mut self, parsed: &Parsed<'_>) {
        let order = self.store.len();
        self.places.add(&parsed.place);
        let Some(entity) = self.registry.find(&parsed.kind.text) else {
            self.unknown.add((), &parsed.kind, self.names.hash_of(&parsed.kind.text));
            self.names.doubt(&parsed.name.text);
            self.store.skip();
            return;
        };
        let Word { text, place, .. } = &parsed.name;
        let counts = self.names.claim(&self.store, entity, &parsed.name, self.report);
        if entity.kind() == Kind::Camera
            && let Some(first) = self.first_camera.replace(place.clone())
        {
            self.report.add(
                Fault::error(place.clone(), format!("a second camera `{text}`"))
                    .also(first, "the first one")
                    .help("a scene has exactly one camera"),
            );
        }
        let values = Against { entity, names: &mut self.names, store: &self.store, report: self.report }
            .values(parsed);
        let values = values.filter(|_| counts);
        self.store.add(entity, text, values.as_deref());
        if let Some(values) = values
            && !matches!(entity.kind(), Kind::Object | Kind::Light)
        {
            self.construct(parsed, Args::new(entity, text.to_string(), order, values));
        }
        // If the entity is faulty, a stand-in takes its place, so that the entities that refer to it are checked too.
        if counts
            && matches!(entity.kind(), Kind::Material | Kind::Texture)
            && self.names.defined(entity.kind(), text).is_none()
        {
            self.define(entity.kind(), text, &stand_in(entity.kind()));
        }
    }

    fn define(&mut self, kind: Kind, name: &str, datum: &Datum) {
        let index = self.store.index(datum);
        self.names.define(kind, name, index);
    }

    /// Constructs an entity that others can refer to from its checked values.
    fn construct(&mut self, parsed: &Parsed<'_>, mut args: Args) {
        args.setting = self.setting.clone();
        let (kind, order, name) = (args.entity.kind(), args.order, Arc::from(args.name.as_str()));
        match args.entity.construct {
            Construct::Camera(construct) => {
                if let Some(mut camera) = self.made(parsed, &args, construct) {
                    camera.accuracy = self.accuracy.unwrap_or(camera.accuracy);
                    let folder = self.setting.folder.clone();
                    self.setting = Arc::new(Setting { camera: camera.clone(), folder });
                    self.camera = Some((order, camera));
                }
            }
            Construct::Material(construct) => {
                if let Some(material) = self.made(parsed, &args, construct) {
                    let material = Arc::new(material);
                    self.define(kind, &args.name, &Datum::Material { name, material: material.clone() });
                    self.materials.push((order, material));
                }
            }
            Construct::Texture(construct) => {
                if let Some(texture) = self.made(parsed, &args, construct) {
                    self.report.add_file(texture.path().to_owned());
                    // Textures with the same file share one image, so that the file is read once.
                    let texture = match self.files.entry(texture.path().to_owned()) {
                        Entry::Occupied(known) => known.get().clone(),
                        Entry::Vacant(free) => free.insert(Arc::new(texture)).clone(),
                    };
                    self.define(kind, &args.name, &Datum::Texture { name, texture: texture.clone() });
                    self.textures.push((order, texture));
                }
            }
            Construct::Object(_) | Construct::Light(_) => {}
        }
    }

    /// Constructs the objects and the lights.
    fn construct_waiting(&mut self, source: &Source<'_, '_>) -> Arc<Store> {
        self.store.setting = self.setting.clone();
        let store = Arc::new(take(&mut self.store));
        let patterns = self.names.patterns();
        self.names.forget();
        // One after the other, as one may refer to another before it.
        for (order, datum) in &patterns {
            let (args, record) = (store.args(*order), Record::new(&store, *order));
            if let (Some(Construct::Object(construct)), Datum::Object { body, .. }) =
                (store.sound(*order).map(|entity| entity.construct), datum)
                && !args.refers_to_nothing()
            {
                match construct(&args) {
                    Ok(made) => body.set(made),
                    Err(refusal) => {
                        let parsed = source.entity(self.registry, *order, &self.places.get(*order));
                        self.refuse(parsed.as_deref(), &args, refusal);
                    }
                }
            }
            self.patterns.push(record);
        }
        for start in (0..store.len()).step_by(8 * TOGETHER) {
            let orders = start..store.len().min(start + 8 * TOGETHER);
            let made = self.threads.map(orders.len().div_ceil(PIECE), |piece| {
                let start = start + piece * PIECE;
                made(&store, start..orders.end.min(start + PIECE), &patterns)
            });
            for (order, made) in made.into_iter().flatten() {
                let record = Record::new(&store, order);
                match made {
                    Ok(Made::Object(body)) => self.objects.extend(object(record, body)),
                    Ok(Made::Light(light)) => self.lights.push(Item { args: record, value: light }),
                    Err(refusal) => {
                        let parsed = source.entity(self.registry, order, &self.places.get(order));
                        self.refuse(parsed.as_deref(), &record.args(), refusal);
                    }
                }
            }
        }
        self.objects.shrink_to_fit();
        store
    }

    /// Calls a constructor with checked values and reports a refusal.
    fn made<T>(
        &mut self,
        parsed: &Parsed<'_>,
        args: &Args,
        construct: fn(&Args) -> Result<T, Refusal>,
    ) -> Option<T> {
        construct(args).map_err(|refusal| self.refuse(Some(parsed), args, refusal)).ok()
    }

    fn refuse(&mut self, parsed: Option<&Parsed<'_>>, args: &Args, refusal: Refusal) {
        debug_assert!(
            args.has_what_is_refused(&refusal),
            "the plugin `{}` refuses `{}`, which is not in the table it registers at {}: name an attribute of that table",
            args.entity.name,
            refusal.attribute.unwrap_or_default(),
            args.entity.place()
        );
        let place = parsed.and_then(|parsed| place_of(args.entity, parsed, refusal.attribute));
        let message = format!("{} `{}` {}", args.entity.name, args.name, refusal.message);
        self.report.add(Fault::error(place, message).help(refusal.help));
    }

    /// Reads the textures that some entity refers to, and no others.
    fn textures_can_be_read(&mut self, store: &Store, source: &Source<'_, '_>) {
        if self.textures.is_empty() {
            return;
        }
        let users =
            self.objects.iter().map(|object| &object.args).chain(self.lights.iter().map(|light| &light.args));
        let users = users.chain(&self.patterns);
        let (mut used, mut memory) = (BTreeSet::new(), None);
        for user in users {
            used.extend(user.args_in(&mut memory).textures().map(str::to_owned));
        }
        for (order, texture) in &self.textures {
            let args = store.args(*order);
            if !used.contains(&args.name) {
                continue;
            }
            let read = texture.load_within(self.texture_memory);
            self.texture_memory -= texture.bytes().min(self.texture_memory);
            if let Err(reason) = read {
                let place = self.places.get(*order);
                let is_told = self.report.tells(Severity::Error, &place);
                let near = if is_told { texture.near() } else { None };
                let reason =
                    near.map_or(reason.to_owned(), |near| format!("it does not exist, but `{near}` does"));
                let message = format!("the file of texture `{}` cannot be read: {reason}", args.name);
                let mut files = args.values().filter(|(_, datum)| matches!(datum, Datum::Word(_)));
                let file = files.next().map(|(file, _)| file.name());
                let parsed = source.entity(self.registry, *order, &place);
                let place = parsed.and_then(|parsed| place_of(args.entity, &parsed, file));
                self.report.add(
                    Fault::error(place, message).help(
                        "a texture is a PPM or PNG file, and its name is relative to the scene's folder",
                    ),
                );
            }
        }
    }

    /// Returns the model, after reporting the faults that show only when the whole scene has been read.
    fn finish(mut self, store: &Arc<Store>, source: &Source<'_, '_>) -> (Option<Model>, Places) {
        let mut camera_misspelt = false;
        self.report.count_more(Severity::Error, self.unknown.others().count());
        let mut unknown: Vec<_> = take(&mut self.unknown.names).into_iter().collect();
        unknown.sort_by_key(|(_, (place, _))| place.as_ref().map(|place| place.start));
        for ((_, name), (place, count)) in unknown {
            let is_told = self.report.tells(Severity::Error, &place);
            let near = if is_told { self.registry.nearest(&name) } else { None };
            camera_misspelt |=
                near.and_then(|near| self.registry.find(near)).is_some_and(|e| e.kind() == Kind::Camera);
            let known = list(self.registry.iter().map(|entity| entity.name));
            let fault = Fault::error(place, format!("there is no entity type `{name}`"));
            self.report
                .add(fault.label(suggestion(near, count)).help(format!("the entity types are {known}")));
        }
        let parsed = |order| source.entity(self.registry, order, &self.places.get(order));
        let place = |order| parsed(order)?.name.place.clone();
        self.names.report_unresolved(self.registry, store, place, self.report);
        self.names.report_repeated(store, place, self.report);
        if let Some(first) = parsed(0)
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
        let Self { camera, materials, textures, objects, patterns, lights, places, .. } = self;
        let model = camera.map(|camera| Model {
            camera: item(store, camera),
            materials: materials.into_iter().map(|material| item(store, material)).collect(),
            textures: textures.into_iter().map(|texture| item(store, texture)).collect(),
            objects,
            patterns,
            lights,
        });
        (model, places)
    }
}

fn item<T>(store: &Arc<Store>, (order, value): (usize, T)) -> Item<T> {
    Item { args: Record::new(store, order), value }
}

/// Returns an object, with the material that its record names.
fn object(record: Record, Body { shape, shader }: Body) -> Option<Object> {
    let material = record.material()?;
    Some(Object { args: record, material, shape, shader })
}

/// Returns the place of an attribute with its values, or of the entity's name where the attribute is not given.
fn place_of(entity: &'static Entity, parsed: &Parsed<'_>, attribute: Option<&str>) -> Place {
    let known = |word: &Word<'_>| find_attribute(entity, &word.text).map(|known| known.name());
    let given = attribute
        .and_then(|attribute| parsed.attributes().rev().find(|(word, _)| known(word) == Some(attribute)));
    given.map_or(parsed.name.place.clone(), |(word, values)| whole(word, values))
}
