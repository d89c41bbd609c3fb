//! Checks parsed entities, and constructs those that others can refer to.

use super::attributes::{AttributeChecker, whole};
use super::fault::{Fault, Place, Places};
use super::guesses::find_attribute;
use super::levels;
use super::missing::Missing;
use super::names::{Names, placeholder};
use super::notes;
use super::options::ReadOptions;
use super::pack_valid::{Packed, ValidPacker};
use super::parsed::{Parsed, Word};
use super::report::Report;
use super::statements::Parser;
use crate::registry::Registry;
use std::borrow::Cow;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::mem::replace;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_core::parallel;
use tabray_core::scene::entity::{Args, Construct, Entity, Refusal, Setting};
use tabray_core::scene::kind::Kind;
use tabray_core::scene::model::{Item, Object};
use tabray_core::scene::store::Store;
use tabray_core::scene::value::Datum;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::background::EnclosedBackground;
use tabray_core::world::body::{Label, NamedBody, ShaderFactory};
use tabray_core::world::lamp::Lamp;
use tabray_core::world::material::Material;
use tabray_core::world::rules::Rules;
use tabray_core::world::sensor::Sensor;
use tabray_core::world::texture::{Alpha, Texture};

/// The entities of a scene, parsed during the check or before it.
pub enum Source<'s, 'a> {
    /// A text in the notes' syntax, and its parser.
    Text(&'a str, Box<Parser<'a, 's>>),
    /// A long text in TOML, as a function that returns the next entities until there are none. Entities are not kept:
    /// if there is anything to report about them, the text is read again as a list.
    Stream(Box<dyn FnMut() -> Vec<Parsed<'a>> + Send + 's>),
    /// Entities, in order.
    List(&'s [Parsed<'a>]),
}

impl<'a> Source<'_, 'a> {
    /// Returns an entity, given its place.
    pub(super) fn entity(
        &self,
        registry: &Registry,
        order: usize,
        place: &Place,
    ) -> Option<Cow<'_, Parsed<'a>>> {
        match self {
            Self::Text(text, parser) => {
                let mut parsed = notes::again(registry, text, place.as_ref()?.start)?;
                parser.repeats.sets.put(&mut parsed, registry, None);
                Some(Cow::Owned(parsed))
            }
            Self::Stream(_) => None,
            Self::List(parsed) => parsed.get(order).map(Cow::Borrowed),
        }
    }
}

/// The number of entities that are parsed and then checked together: 8 times that of one thread.
pub(super) const TOGETHER: usize = 1 << 11;
/// The number of entities that a thread checks together.
pub(super) const PIECE: usize = 1 << 8;

/// The default limit for the memory of all textures of a scene, in bytes: far more than scenes need, and far less than
/// a small file can claim.
const TEXTURE_MEMORY: u64 = 1 << 30;

pub(super) struct Check<'r, 't> {
    pub(super) registry: &'r Registry,
    pub(super) report: &'r mut Report<'t>,
    pub(super) names: Names,
    /// Unknown entity types.
    pub(super) unknown: Missing<()>,
    /// The place of the first camera's name.
    pub(super) first_camera: Option<Place>,
    /// The place of the first background's name.
    first_background: Option<Place>,
    pub(super) setting: Arc<Setting>,
    /// The accuracy and the rules of light that override those of the scene.
    above_all: (Option<Accuracy>, Option<Rules>),
    /// Whether entities that share a name and are all used are allowed without a warning.
    pub(super) may_share_names: bool,
    /// Whether colours that may be meant as 0 to 255 are allowed without a warning.
    may_be_bright: bool,
    /// The given entities, and their places.
    pub(super) store: Store,
    pub(super) places: Places,
    /// The constructed entities, with their orders.
    pub(super) camera: Option<(usize, Sensor)>,
    pub(super) materials: Vec<(usize, Arc<Material>)>,
    pub(super) textures: Vec<(usize, Arc<Texture>)>,
    /// The textures by the paths of their files, and whether they cut surfaces out.
    files: HashMap<(PathBuf, Alpha), Arc<Texture>>,
    pub(super) shaders: Vec<(usize, ShaderFactory)>,
    /// The memory left for the images of textures, in bytes.
    pub(super) texture_memory: u64,
    pub(super) objects: Vec<Object>,
    pub(super) labels: Vec<(usize, Label)>,
    /// The objects that other entities refer to.
    pub(super) patterns: Vec<Item<NamedBody>>,
    pub(super) lights: Vec<Item<Lamp>>,
    /// The warning about colours from 0 to 255, if any.
    pub(super) levels: Option<Fault>,
    pub(super) background: Option<(usize, Arc<dyn EnclosedBackground>)>,
    packer: ValidPacker<'r>,
}

impl<'r, 't> Check<'r, 't> {
    /// Begins the check of a scene. Its file names are relative to `folder`.
    pub fn new(
        registry: &'r Registry,
        folder: &Path,
        accuracy: ReadOptions<'_>,
        report: &'r mut Report<'t>,
    ) -> Self {
        let camera = Sensor { accuracy: accuracy.by_default, ..Sensor::default() };
        let memory = accuracy.memory.unwrap_or(u64::MAX);
        let (folder, materials) = (folder.to_owned(), Arc::default());
        let ReadOptions { only_rays, labels_apart, .. } = accuracy;
        let setting = Setting { camera, folder, materials, only_rays, labels_apart, memory };
        Self {
            registry,
            report,
            names: Names::default(),
            unknown: Missing::default(),
            first_camera: None,
            first_background: None,
            setting: Arc::new(setting),
            above_all: (accuracy.above_all, accuracy.rules),
            may_share_names: accuracy.may_share_names,
            may_be_bright: accuracy.may_be_bright,
            store: Store::default(),
            places: Places::default(),
            camera: None,
            materials: Vec::new(),
            textures: Vec::new(),
            files: HashMap::new(),
            shaders: Vec::new(),
            texture_memory: accuracy.memory.unwrap_or(TEXTURE_MEMORY),
            objects: Vec::new(),
            labels: Vec::new(),
            patterns: Vec::new(),
            lights: Vec::new(),
            levels: None,
            background: None,
            packer: ValidPacker::new(registry),
        }
    }
}

impl Check<'_, '_> {
    /// Checks some consecutive entities.
    pub(super) fn entities<'p>(&mut self, parsed: &[&'p Parsed<'p>]) {
        let mut rest = parsed;
        while let Some(first) = rest.first() {
            // Entities that others can refer to, and types, are defined before the entities that use them are checked.
            let waiting = rest.iter().take_while(|parsed| self.packer.waits(&self.store, parsed)).count();
            if waiting == 0 {
                self.entity(first);
                rest = &rest[1..];
                continue;
            }
            let (run, others) = rest.split_at(waiting);
            rest = others;
            if run.len() <= PIECE {
                let mut packer = replace(&mut self.packer, ValidPacker::new(self.registry));
                packer.check(&self.names, &self.store, run);
                self.take(run, &packer);
                self.packer = packer;
                continue;
            }
            let (registry, names, store) = (self.registry, &self.names, &self.store);
            let pieces: Vec<_> = run.chunks(PIECE).collect();
            let checked = parallel::map(pieces.len(), |piece| {
                let mut packer = ValidPacker::new(registry);
                packer.check(names, store, pieces[piece]);
                packer
            });
            pieces.into_iter().zip(&checked).for_each(|(run, packer)| self.take(run, packer));
        }
    }

    /// Takes over checked entities. An entity with something to report is checked again.
    fn take(&mut self, parsed: &[&Parsed<'_>], packer: &ValidPacker<'_>) {
        for (parsed, packed) in parsed.iter().zip(packer.packed()) {
            match packed {
                None => self.entity(parsed),
                Some(Packed { entity, hash, bytes }) => {
                    if self.names.claim(&self.store, entity, (&parsed.name, hash), self.report) {
                        self.store.add_packed(bytes);
                    } else {
                        self.store.add(entity, &parsed.name.text, None);
                    }
                    self.places.add(&parsed.place);
                }
            }
        }
    }

    /// Checks an entity against its table. An entity that others can refer to is constructed at once, and the others
    /// wait.
    fn entity(&mut self, parsed: &Parsed<'_>) {
        let order = self.store.count();
        self.places.add(&parsed.place);
        let Some(entity) = self.registry.find(&parsed.kind.text) else {
            self.unknown.add((), &parsed.kind, self.names.hash_of(&parsed.kind.text));
            self.names.doubt(&parsed.name.text);
            self.store.skip();
            return;
        };
        let text = &parsed.name.text;
        let hash = self.names.hash(entity.kind(), text);
        let counts = self.names.claim(&self.store, entity, (&parsed.name, hash), self.report);
        self.refuse_second(entity.kind(), &parsed.name);
        let values = AttributeChecker {
            registry: self.registry,
            entity,
            names: &mut self.names,
            store: &self.store,
            report: self.report,
        }
        .values(parsed);
        let values = values.filter(|_| counts);
        self.store.add(entity, text, values.as_deref());
        // Many entities often refer to the same object or the same type of shader.
        for (datum, _) in values.iter().flatten() {
            let (kind, name) = match datum {
                Datum::Object { name, .. } => (Kind::Object, name),
                Datum::Shader { name, .. } => (Kind::Shader, name),
                _ => continue,
            };
            if !name.is_empty() && self.names.defined(kind, name).is_none() {
                self.define(kind, name, datum);
            }
        }
        if let Some(values) = values
            && !matches!(entity.kind(), Kind::Object | Kind::Light)
        {
            let args = Args::new(entity, text.to_string(), order, values, self.setting.clone());
            self.construct(parsed, &args);
        }
        // A placeholder replaces a faulty entity, and so the entities that refer to it are checked, too.
        if counts
            && matches!(entity.kind(), Kind::Material | Kind::Texture | Kind::Shader)
            && self.names.defined(entity.kind(), text).is_none()
        {
            self.define(entity.kind(), text, &placeholder(entity.kind()));
        }
    }

    /// Reports a second entity of a kind that a scene can have only once.
    fn refuse_second(&mut self, kind: Kind, Word { text, place, .. }: &Word<'_>) {
        let (first, how_many) = match kind {
            Kind::Camera => (&mut self.first_camera, "exactly"),
            Kind::Background => (&mut self.first_background, "at most"),
            _ => return,
        };
        if let Some(first) = first.replace(place.clone()) {
            self.report.add(
                Fault::error(place.clone(), format!("a second {kind} `{text}`"))
                    .also(first, "the first one")
                    .help(format!("a scene has {how_many} one {kind}")),
            );
        }
    }

    fn define(&mut self, kind: Kind, name: &str, datum: &Datum) {
        let index = self.store.index(datum);
        self.names.define(kind, name, index);
    }

    /// Constructs an entity that others can refer to from its checked values.
    fn construct(&mut self, parsed: &Parsed<'_>, args: &Args) {
        let (kind, order, name) = (args.entity.kind(), args.order, Arc::from(args.name.as_str()));
        match args.entity.construct {
            Construct::Camera(construct) => {
                if let Some(camera) = self.made(parsed, args, construct) {
                    let camera = args.sensor(camera, self.above_all);
                    self.warn_of_unused(parsed, args, &camera);
                    Arc::make_mut(&mut self.setting).camera = camera.clone();
                    self.camera = Some((order, camera));
                }
            }
            Construct::Material(construct) => {
                if let Some(material) = self.made(parsed, args, construct) {
                    self.warn_of_levels(parsed, args);
                    let material = Arc::new(material);
                    self.define(kind, &args.name, &Datum::Material { name, material: material.clone() });
                    self.materials.push((order, material));
                }
            }
            Construct::Texture(construct) => {
                if let Some(texture) = self.made(parsed, args, construct) {
                    self.report.add_file(texture.path().to_owned());
                    // Equal textures share one image, and so its file is read once.
                    let texture = match self.files.entry((texture.path().to_owned(), texture.alpha_use())) {
                        Entry::Occupied(known) => known.get().clone(),
                        Entry::Vacant(free) => free.insert(Arc::new(texture)).clone(),
                    };
                    self.define(kind, &args.name, &Datum::Texture { name, texture: texture.clone() });
                    self.textures.push((order, texture));
                }
            }
            Construct::Shader(construct) => {
                if let Some(paint) = self.made(parsed, args, construct) {
                    self.define(kind, &args.name, &Datum::Shader { name, paint: paint.clone() });
                    self.shaders.push((order, paint));
                }
            }
            Construct::Background(construct) => {
                let made = self.made(parsed, args, construct);
                self.background = made.map(|background| (order, background.into()));
            }
            Construct::Object(_) | Construct::Light(_) => {}
        }
    }

    /// Warns of the colours of a material if they are from 0 to 255, with one warning for all materials.
    fn warn_of_levels(&mut self, parsed: &Parsed<'_>, args: &Args) {
        let Some((attribute, fault)) = levels::warning(args).filter(|_| !self.may_be_bright) else { return };
        let place = place_of(args.entity, parsed, Some(attribute));
        match &mut self.levels {
            Some(first) => first.count_similar(place),
            None => self.levels = Some(Fault { place, ..fault }),
        }
    }

    /// Warns of attributes of a camera that its rules of light do not use.
    fn warn_of_unused(&mut self, parsed: &Parsed<'_>, args: &Args, camera: &Sensor) {
        let unused = (camera.rules == Rules::Notes).then(|| args.given_of_free_rules()).into_iter().flatten();
        for attribute in unused {
            let place = place_of(args.entity, parsed, Some(attribute));
            let message = format!("`{attribute}` has no effect under the notes' rules of light");
            let help = "they cut 255 times the light to a byte; under the free rules, light is shown by `exposure`, \
                        `tone` and `transfer`";
            self.report.add(Fault::warning(place, message).help(help));
        }
    }

    /// Calls a constructor with checked values, and reports a refusal.
    fn made<T>(
        &mut self,
        parsed: &Parsed<'_>,
        args: &Args,
        construct: fn(&Args) -> Result<T, Refusal>,
    ) -> Option<T> {
        construct(args).map_err(|refusal| self.refuse(Some(parsed), args, refusal)).ok()
    }

    pub(super) fn refuse(&mut self, parsed: Option<&Parsed<'_>>, args: &Args, refusal: Refusal) {
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
}

/// Returns the place of an attribute with its values, or of the entity's name if the attribute is not given.
pub(super) fn place_of(entity: &'static Entity, parsed: &Parsed<'_>, attribute: Option<&str>) -> Place {
    let known = |word: &Word<'_>| find_attribute(entity, &word.text).map(|known| known.name());
    let given = attribute
        .and_then(|attribute| parsed.attributes().rev().find(|(word, _)| known(word) == Some(attribute)));
    given.map_or(parsed.name.place.clone(), |(word, values)| whole(word, values))
}
