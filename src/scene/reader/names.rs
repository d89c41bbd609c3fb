//! The names of a scene: which entities have them, and what references to them mean.

use super::fault::{Fault, Place, Severity};
use super::guesses::find_attribute;
use super::parsed::{Form, Parsed, Word};
use super::report::Report;
use crate::scene::entity::Entity;
use crate::scene::kind::Kind;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::value::{Datum, Type};
use crate::text::{self, nearest};
use crate::world::body::NamedBody;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// A name and the kind of the entity: a material and an object may have the same name.
type Name = (Kind, String);

/// The scope in which a name must be unique: the entity type for an object, and an empty string, the whole kind, for
/// the others.
type Title = &'static str;

/// The entities that claimed a name: the first one, and those that claimed it again.
struct Claims {
    first: (Title, Place),
    /// The other scopes in which the name was claimed.
    titles: Vec<Title>,
    again: Vec<(Title, Place)>,
}

/// The maximum number of faults of one sort that are listed separately.
const MAX_LISTED: usize = 8;

/// The names of a scene, as far as the scene has been checked.
pub struct Names {
    /// The place where each name is first defined, before or after its uses.
    places: HashMap<Name, Place>,
    /// Names of entities of unknown types, which a reference may mean.
    doubtful: HashSet<String>,
    /// The names claimed so far.
    claimed: HashMap<Name, Claims>,
    /// The entities that can be referred to so far.
    defined: HashMap<Name, Datum>,
    /// The names of objects that other entities refer to.
    /// For each, the order of the object that has it first, once that is defined, and its body.
    patterns: HashMap<String, (Option<usize>, NamedBody)>,
    /// References to entities not (yet) defined, each with all its places.
    unresolved: BTreeMap<Name, Vec<Place>>,
}

impl Names {
    /// Collects all names of a scene; none is claimed yet.
    pub fn of(registry: &Registry, parsed: &[Parsed<'_>]) -> Self {
        let (mut places, mut doubtful, mut patterns) = (HashMap::new(), HashSet::new(), HashMap::new());
        for Parsed { kind, name, attributes, .. } in parsed {
            let text = name.text.to_string();
            match registry.find(&kind.text) {
                Some(entity) => {
                    let refers = |attribute: &&'static dyn Attribute| {
                        matches!(attribute.value_type(), Type::Name(Kind::Object))
                    };
                    for attribute in entity.attributes().filter(refers) {
                        let is_it = |word: &Word<'_>| {
                            find_attribute(entity, &word.text).map(|known| known.name())
                                == Some(attribute.name())
                        };
                        let given = attributes.iter().filter(|(word, _)| is_it(word));
                        patterns.extend(
                            given
                                .flat_map(|(_, values)| values)
                                .map(|value| (value.text.to_string(), Default::default())),
                        );
                    }
                    places.entry((entity.kind(), text)).or_insert_with(|| name.place.clone());
                }
                None => {
                    doubtful.insert(text);
                }
            }
        }
        Self {
            places,
            doubtful,
            patterns,
            claimed: HashMap::new(),
            defined: HashMap::new(),
            unresolved: BTreeMap::new(),
        }
    }

    /// Gives an entity its name, and reports an invalid name. Returns whether the entity counts: of several materials,
    /// textures or objects of one type with the same name, only the first does.
    pub fn claim(&mut self, entity: &'static Entity, word: &Word<'_>, report: &mut Report) -> bool {
        let Word { text, form, place } = word;
        let kind = entity.kind();
        if text.is_empty() && *form == Form::Text {
            report.add(
                Fault::error(place.clone(), format!("this {kind} has an empty name"))
                    .help("a name is any word; put it in quotes if it contains white space"),
            );
        }
        if text.contains(char::is_control) {
            report.add(
                Fault::error(place.clone(), format!("`{}` cannot be a name", text.escape_debug()))
                    .help("a name must not contain newlines or other control characters"),
            );
        }
        if text.is_empty() || kind == Kind::Camera {
            return true;
        }
        // The course's own images show a sphere `left` and an fplane `left` in one scene.
        let title = if kind == Kind::Object { entity.name } else { "" };
        match self.claimed.entry((kind, text.to_string())) {
            Entry::Vacant(free) => {
                free.insert(Claims { first: (title, place.clone()), titles: Vec::new(), again: Vec::new() });
                true
            }
            Entry::Occupied(mut taken) => {
                let Claims { first, titles, again } = taken.get_mut();
                let is_first = first.0 != title && !titles.contains(&title);
                if is_first {
                    titles.push(title);
                }
                again.push((title, place.clone()));
                is_first || kind == Kind::Light
            }
        }
    }

    /// Warns of names that several entities have: once for each name, or once for all of them where they are many.
    pub fn report_repeated(&self, report: &mut Report) {
        let (mut left_out, mut shared) = (Vec::new(), Vec::new());
        for ((kind, text), Claims { first, again, .. }) in
            self.claimed.iter().filter(|(_, all)| !all.again.is_empty())
        {
            let mut titles: BTreeMap<Title, Vec<&Place>> = BTreeMap::new();
            let mut firsts = Vec::new();
            for (title, place) in [first].into_iter().chain(again) {
                let places = titles.entry(title).or_default();
                places.push(place);
                firsts.extend((places.len() == 1).then_some(place));
            }
            for (title, places) in titles {
                let what = if title.is_empty() { kind.to_string() } else { title.to_owned() };
                if *kind == Kind::Light { &mut shared } else { &mut left_out }.push(Repeated {
                    what,
                    text,
                    places,
                });
            }
            shared.push(Repeated { what: kind.to_string(), text, places: firsts });
        }
        for (Repeated { what, text, places }, names, more) in few(left_out) {
            let message = match (names, places.len()) {
                (0, 2) => format!("{what} `{text}` is defined twice"),
                (0, count) => format!("{what} `{text}` is defined {count} times"),
                _ => {
                    format!("{what} `{text}` and {} are defined more than once", text::count(names, "other"))
                }
            };
            let label = if more == 0 { "ignored".to_owned() } else { format!("ignored, as are {more} more") };
            report.add(
                Fault::warning(places[1].clone(), message)
                    .label(label)
                    .also(places[0].clone(), "this one is used")
                    .help("only the first definition of a name is used: rename the others"),
            );
        }
        for (Repeated { what, text, places }, names, more) in few(shared) {
            let message = match (names, places.len()) {
                (0, 2) => format!("two {what}s have the name `{text}`"),
                (0, count) => format!("{count} {what}s have the name `{text}`"),
                _ => format!(
                    "several entities have the name `{text}`, and {} too",
                    text::count(names, "other name")
                ),
            };
            let label = if more == 0 { String::new() } else { format!("and {more} more") };
            report.add(
                Fault::warning(places[1].clone(), message)
                    .label(label)
                    .also(places[0].clone(), "the first one")
                    .help("all of them are used, but messages and dumps cannot tell them apart"),
            );
        }
    }

    /// Returns the body that an object of this name and order is to fill, if other entities refer to it.
    pub fn body(&self, name: &str, order: usize) -> Option<NamedBody> {
        let (first, body) = self.patterns.get(name)?;
        (*first == Some(order)).then(|| body.clone())
    }

    /// Defines a name, so that later entities can refer to it.
    pub fn define(&mut self, kind: Kind, name: &str, datum: Datum) {
        self.defined.entry((kind, name.to_owned())).or_insert(datum);
    }

    /// Defines an object, if other entities refer to one of its name and it is the first.
    pub fn define_object(&mut self, name: &str, order: usize) {
        let Some((first @ None, body)) = self.patterns.get_mut(name) else { return };
        *first = Some(order);
        let datum = Datum::Object { name: Arc::from(name), body: body.clone() };
        self.define(Kind::Object, name, datum);
    }

    /// Returns the entity that a word refers to. If it is not defined, the reference is remembered and a stand-in is
    /// returned, so that the entity that refers to it can be checked.
    pub fn resolve(&mut self, kind: Kind, word: &Word<'_>) -> Datum {
        let name = (kind, word.text.to_string());
        if let Some(datum) = self.defined.get(&name) {
            return datum.clone();
        }
        if !self.doubtful.contains(&name.1) {
            self.unresolved.entry(name).or_default().push(word.place.clone());
        }
        stand_in(kind, &word.text)
    }

    /// Reports the references to undefined names, one fault for each name.
    pub fn report_unresolved(&self, registry: &Registry, report: &mut Report) {
        let mut known: BTreeMap<Kind, Vec<&str>> = BTreeMap::new();
        for (kind, text) in self.places.keys() {
            known.entry(*kind).or_default().push(text);
        }
        known.values_mut().for_each(|known| known.sort_unstable());
        // In the order of the text, so that guesses are made only for references that are listed.
        let mut unresolved: Vec<_> = self.unresolved.iter().collect();
        unresolved.sort_by_key(|(_, places)| places[0].as_ref().map(|place| place.start));
        for ((kind, text), places) in unresolved {
            let is_told = report.tells(Severity::Error, &places[0]);
            let fault = match self.places.get(&(*kind, text.clone())) {
                Some(defined) => {
                    Fault::error(places[0].clone(), format!("{kind} `{text}` is used before it is defined"))
                        .label(suggestion(None, places))
                        .also(defined.clone(), "defined here")
                        .help(format!("{} must be defined before it is used", kind.with_article()))
                }
                None => {
                    let known = known.get(kind).filter(|_| is_told).into_iter().flatten().copied();
                    Fault::error(places[0].clone(), format!("there is no {kind} `{text}`"))
                        .label(suggestion(nearest(text, known), places))
                        .help(format!(
                            "define it before this: {}",
                            registry.example(*kind, text, report.syntax())
                        ))
                }
            };
            report.add(fault);
        }
    }
}

/// Entities that share a name.
struct Repeated<'n> {
    what: String,
    text: &'n str,
    places: Vec<&'n Place>,
}

/// Keeps the names that are repeated, each with the number of further names and further places that it stands for. Of
/// more than [`MAX_LISTED`] names, keeps only the first.
fn few(mut all: Vec<Repeated<'_>>) -> Vec<(Repeated<'_>, usize, usize)> {
    all.retain(|repeated| repeated.places.len() > 1);
    all.sort_by_key(|repeated| (repeated.places[1].as_ref().map(|place| place.start), repeated.text));
    let (names, later) = (all.len(), all.iter().map(|repeated| repeated.places.len() - 1).sum::<usize>());
    if names > MAX_LISTED {
        return all.into_iter().take(1).map(|first| (first, names - 1, later - 1)).collect();
    }
    let more: Vec<_> = all.iter().map(|repeated| repeated.places.len() - 2).collect();
    all.into_iter().zip(more).map(|(repeated, more)| (repeated, 0, more)).collect()
}

/// Returns a default entity, in place of one that is faulty or missing.
pub fn stand_in(kind: Kind, name: &str) -> Datum {
    let name = Arc::from(name);
    match kind {
        Kind::Texture => Datum::Texture { name, texture: Arc::default() },
        Kind::Object => Datum::Object { name, body: NamedBody::default() },
        _ => Datum::Material { name, material: Arc::default() },
    }
}

/// Returns the label of a fault that may stand for several places.
pub fn suggestion(near: Option<&str>, places: &[Place]) -> String {
    let more = text::count(places.len() - 1, "more place");
    match (near, places.len()) {
        (None, 1) => String::new(),
        (None, _) => format!("here and in {more}"),
        (Some(near), 1) => format!("did you mean `{near}`?"),
        (Some(near), _) => format!("did you mean `{near}`? (here and in {more})"),
    }
}
