//! Entities as written, checked against the tables of their types, then made into a [`Model`].

use super::fault::{Fault, Place, Report};
use super::notes::{find_attribute, near_attribute};
use super::values;
use super::written::{Word, Written};
use crate::camera::Camera;
use crate::entity::{Args, Construct, Entity, Kind, MATERIAL, Refusal};
use crate::geometry::Light;
use crate::material::Material;
use crate::model::{Item, Model, Object};
use crate::pparm::Attribute;
use crate::registry::Registry;
use crate::value::{Datum, Type};
use crate::words::{self, list, nearest};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// Makes a model of entities as written and reports all their faults. Without faults there is a model.
pub fn model(registry: &Registry, written: Vec<Written<'_>>, report: &mut Report) -> Option<Model> {
    let kind_of = |entity: &Written<'_>| registry.find(&entity.kind.text).map(Entity::kind);
    let mut check = Check {
        registry,
        report,
        all_materials: HashMap::new(),
        materials: HashMap::new(),
        doubtful: HashSet::new(),
        names: HashMap::new(),
        unresolved: BTreeMap::new(),
        unknown: BTreeMap::new(),
        camera: None,
        model: Parts::default(),
    };
    for entity in &written {
        match kind_of(entity) {
            Some(Kind::Material) => {
                check.all_materials.entry(entity.name.text.to_string()).or_insert(entity.name.place.clone());
            }
            Some(_) => {}
            None => {
                check.doubtful.insert(entity.name.text.to_string());
            }
        }
    }
    let first = written.first().map(|entity| entity.kind.place.clone());
    for entity in written {
        check.entity(entity);
    }
    check.finish(first)
}

/// The parts of a model as they come.
#[derive(Default)]
struct Parts {
    camera: Option<Item<Camera>>,
    materials: Vec<Item<Arc<Material>>>,
    objects: Vec<Object>,
    lights: Vec<Item<Box<dyn Light>>>,
}

struct Check<'r> {
    registry: &'r Registry,
    report: &'r mut Report,
    /// Where each material of the scene is named first, before or after its use.
    all_materials: HashMap<String, Place>,
    /// The materials defined so far; a faulty one stands in as a black one, so that its users are checked too.
    materials: HashMap<String, (Arc<str>, Arc<Material>)>,
    /// Names of entities of no known type: they may be what a reference means.
    doubtful: HashSet<String>,
    /// Where each name of a kind was given first.
    names: HashMap<(Kind, String), Place>,
    /// References to materials that are not there (yet), each with all its places.
    unresolved: BTreeMap<String, Vec<Place>>,
    /// Entity types that are not there, each with all its places.
    unknown: BTreeMap<String, Vec<Place>>,
    /// Where the first camera is named.
    camera: Option<Place>,
    model: Parts,
}

impl Check<'_> {
    fn entity(&mut self, written: Written<'_>) {
        let Some(entity) = self.registry.find(&written.kind.text) else {
            self.unknown.entry(written.kind.text.to_string()).or_default().push(written.kind.place);
            return;
        };
        self.name(entity, &written);
        let values = self.values(entity, &written);
        let name = written.name.text.to_string();
        let args = values.map(|values| Args::new(entity, name.clone(), values));
        match entity.construct {
            Construct::Camera(construct) => {
                if let Some(value) = self.made(&written, args, construct) {
                    self.model.camera = Some(value);
                }
            }
            Construct::Material(construct) => {
                let made = self.made(&written, args, construct);
                let material = made.map(|Item { args, value }| Item { args, value: Arc::new(value) });
                let value = material.as_ref().map(|item| item.value.clone()).unwrap_or_default();
                self.materials.entry(name.clone()).or_insert_with(|| (Arc::from(name), value));
                self.model.materials.extend(material);
            }
            Construct::Object(construct) => {
                if let Some(Item { args, value }) = self.made(&written, args, construct) {
                    let material = args.get(&MATERIAL);
                    self.model.objects.push(Object {
                        args,
                        material,
                        shape: value.shape,
                        shader: value.shader,
                    });
                }
            }
            Construct::Light(construct) => {
                let made = self.made(&written, args, construct);
                self.model.lights.extend(made);
            }
        }
    }

    /// What a constructor makes of checked values.
    fn made<T>(
        &mut self,
        written: &Written<'_>,
        args: Option<Args>,
        construct: fn(&Args) -> Result<T, Refusal>,
    ) -> Option<Item<T>> {
        let args = args?;
        match construct(&args) {
            Ok(value) => Some(Item { args, value }),
            Err(refusal) => {
                let attribute = refusal.attribute.and_then(|name| find_attribute(args.entity, name));
                let marked = attribute.and_then(|attribute| {
                    let known = |word: &Word<'_>| find_attribute(args.entity, &word.text).map(|a| a.name());
                    written.attributes.iter().rfind(|(word, _)| known(word) == Some(attribute.name()))
                });
                let place = marked.map_or(written.name.place.clone(), |(word, values)| whole(word, values));
                let message = format!("{} `{}` {}", args.entity.name, args.name, refusal.message);
                self.report.add(Fault::error(place, message).help(refusal.help));
                None
            }
        }
    }

    /// Checks that the entity's name is one, and not taken.
    fn name(&mut self, entity: &'static Entity, written: &Written<'_>) {
        let Word { text, place } = &written.name;
        let splits = |c: char| c.is_whitespace() || c == '{' || c == '}';
        if text.starts_with('#') || text.contains(splits) {
            self.report.add(
                Fault::error(place.clone(), format!("`{text}` cannot be a name"))
                    .help("a name has no blanks and no braces, and does not begin with `#`"),
            );
        }
        let kind = entity.kind();
        if kind == Kind::Camera {
            match &self.camera {
                None => self.camera = Some(place.clone()),
                Some(first) => self.report.add(
                    Fault::error(place.clone(), format!("a second camera `{text}`"))
                        .also(first.clone(), "the first one")
                        .help("a scene has one camera"),
                ),
            }
            return;
        }
        match self.names.get(&(kind, text.to_string())) {
            None => {
                self.names.insert((kind, text.to_string()), place.clone());
            }
            Some(_) if text.is_empty() => {}
            Some(first) => {
                let fault = if kind == Kind::Material {
                    Fault::error(place.clone(), format!("material `{text}` is defined twice"))
                        .help("give one of them another name")
                } else {
                    Fault::warning(place.clone(), format!("two {kind}s have the name `{text}`"))
                        .help("both are in the picture; messages and dumps cannot tell them apart")
                };
                self.report.add(fault.also(first.clone(), "the first one"));
            }
        }
    }

    /// A datum for each attribute of the type, or nothing where a fault was reported.
    fn values(&mut self, entity: &'static Entity, written: &Written<'_>) -> Option<Vec<Datum>> {
        let title = match written.name.text.as_ref() {
            "" => format!("this {}", entity.name),
            name => format!("{} `{name}`", entity.name),
        };
        let attributes: Vec<_> = entity.attributes().collect();
        let mut given: Vec<Option<&(Word<'_>, Vec<Word<'_>>)>> = vec![None; attributes.len()];
        let mut sound = true;
        let mut meant = Vec::new();
        for pair in &written.attributes {
            let (word, _) = pair;
            let known = find_attribute(entity, &word.text);
            match known.and_then(|known| attributes.iter().position(|a| a.name() == known.name())) {
                None => {
                    sound = false;
                    meant.extend(self.unknown_attribute(entity, &title, word));
                }
                Some(at) => {
                    if let Some((first, _)) = given[at].replace(pair) {
                        self.report.add(
                            Fault::warning(word.place.clone(), format!("{title} has `{}` twice", word.text))
                                .label("this one counts")
                                .also(first.place.clone(), "this one does not"),
                        );
                    }
                }
            }
        }
        let mut missing = Vec::new();
        let mut values = Vec::new();
        for (attribute, given) in attributes.iter().zip(given) {
            let datum = match given {
                Some((word, words)) => self.datum(*attribute, &title, word, words),
                None => {
                    // One that is misspelt is not missing as well.
                    if attribute.default().is_none() && !meant.contains(&attribute.name()) {
                        missing.push(*attribute);
                    }
                    attribute.default()
                }
            };
            sound &= datum.is_some();
            values.extend(datum);
        }
        if !missing.is_empty() {
            let wanted: Vec<_> = missing.iter().map(|attribute| attribute.usage()).collect();
            let fault = format!("{title} lacks {}", list(missing.iter().map(|attribute| attribute.name())));
            self.report.add(
                Fault::error(written.name.place.clone(), fault)
                    .help(format!("give it `{}`", wanted.join("` and `"))),
            );
        } else if written.attributes.is_empty() && !attributes.is_empty() {
            sound = false;
            let names = list(attributes.iter().map(|attribute| attribute.name()));
            self.report.add(
                Fault::error(written.name.place.clone(), format!("{title} has no attributes"))
                    .help(format!("give it one at least of {names}")),
            );
        }
        sound.then_some(values)
    }

    /// Reports an attribute that the type does not have, and returns the one that was meant perhaps.
    fn unknown_attribute(
        &mut self,
        entity: &'static Entity,
        title: &str,
        word: &Word<'_>,
    ) -> Option<&'static str> {
        let near = near_attribute(entity, &word.text).map(|near| near.name());
        let mut fault = Fault::error(word.place.clone(), format!("{title} has no attribute `{}`", word.text));
        if let Some(near) = near {
            fault = fault.label(format!("did you mean `{near}`?"));
        }
        let names = list(entity.attributes().map(|attribute| attribute.name()));
        self.report.add(fault.help(format!("a {} takes {names}", entity.name)));
        near
    }

    /// The values of one attribute, checked for type, number and rule.
    fn datum(
        &mut self,
        attribute: &'static dyn Attribute,
        title: &str,
        word: &Word<'_>,
        words: &[Word<'_>],
    ) -> Option<Datum> {
        if !attribute.arity().contains(&words.len()) {
            let takes = attribute.takes();
            let message = format!("`{}` of {title} takes {takes}, not {}", word.text, words.len());
            self.report.add(Fault::error(whole(word, words), message).help(format!(
                "`{}` is {}",
                attribute.name(),
                attribute.meaning()
            )));
            return None;
        }
        let datum = match (attribute.value_type(), words) {
            (Type::Name(_), [name]) => self.reference(name),
            (value_type, _) => match values::read(value_type, words) {
                Ok(datum) => datum,
                Err(faults) => {
                    for fault in faults {
                        self.report.add(fault.label(format!("`{}` takes {}", word.text, attribute.takes())));
                    }
                    return None;
                }
            },
        };
        if !attribute.allows(&datum) {
            let given = words.iter().map(|word| word.text.as_ref()).collect::<Vec<_>>().join(" ");
            let message = format!("`{}` of {title} must be {}, not {given}", word.text, attribute.rule());
            let place = words.first().map_or(word.place.clone(), |first| whole(first, words));
            self.report.add(Fault::error(place, message).help(format!(
                "`{}` is {}",
                attribute.name(),
                attribute.meaning()
            )));
            return None;
        }
        Some(datum)
    }

    /// The material of this name. One that is missing is reported at the end, with all its places.
    fn reference(&mut self, word: &Word<'_>) -> Datum {
        if let Some((name, material)) = self.materials.get(word.text.as_ref()) {
            return Datum::Material { name: name.clone(), material: material.clone() };
        }
        if !self.doubtful.contains(word.text.as_ref()) {
            self.unresolved.entry(word.text.to_string()).or_default().push(word.place.clone());
        }
        Datum::Material { name: Arc::from(word.text.as_ref()), material: Arc::default() }
    }

    /// The model, or the faults that show only when all is read. The scene's first word is at `first`.
    fn finish(mut self, first: Option<Place>) -> Option<Model> {
        let mut camera_misspelt = false;
        for (name, places) in std::mem::take(&mut self.unknown) {
            let near = self.registry.nearest(&name);
            camera_misspelt |=
                near.and_then(|near| self.registry.find(near)).is_some_and(|e| e.kind() == Kind::Camera);
            let known = list(self.registry.iter().map(|entity| entity.name));
            let fault = Fault::error(places[0].clone(), format!("there is no entity type `{name}`"));
            self.report.add(fault.label(suggestion(near, &places)).help(format!("the types are {known}")));
        }
        for (name, places) in std::mem::take(&mut self.unresolved) {
            let fault = match self.all_materials.get(&name) {
                Some(defined) => {
                    let message = format!("material `{name}` is used before it is defined");
                    Fault::error(places[0].clone(), message)
                        .label(suggestion(None, &places))
                        .also(defined.clone(), "it is defined here")
                        .help("materials stand above the objects that are made of them")
                }
                None => {
                    let near = nearest(&name, self.all_materials.keys().map(String::as_str));
                    Fault::error(places[0].clone(), format!("there is no material `{name}`"))
                        .label(suggestion(near, &places))
                        .help(format!("define it above: {}", self.registry.example(Kind::Material, &name)))
                }
            };
            self.report.add(fault);
        }
        if let Some(first) = first
            && self.camera.is_none()
            && !camera_misspelt
        {
            self.report.add(
                Fault::error(first, "the scene has no camera")
                    .label("a camera belongs before this")
                    .help(format!("add one: {}", self.registry.example(Kind::Camera, "NAME"))),
            );
        }
        let Parts { camera, materials, objects, lights } = self.model;
        Some(Model { camera: camera?, materials, objects, lights })
    }
}

/// The label of a fault that may stand in several places.
fn suggestion(near: Option<&str>, places: &[Place]) -> String {
    let more = words::count(places.len() - 1, "more place");
    match (near, places.len()) {
        (None, 1) => String::new(),
        (None, _) => format!("here and in {more}"),
        (Some(near), 1) => format!("did you mean `{near}`?"),
        (Some(near), _) => format!("did you mean `{near}`? (here and in {more})"),
    }
}

/// From an attribute's name, or its first value, to its last value.
fn whole(first: &Word<'_>, words: &[Word<'_>]) -> Place {
    let last = words.last().unwrap_or(first);
    Some(first.place.as_ref()?.start..last.place.as_ref()?.end)
}
