//! The names of a scene: their entities, and the references to them.

use super::fault::{Fault, Place, Severity};
use super::files;
use super::missing::Missing;
use super::parsed::{Form, Word};
use super::report::Report;
use crate::registry::Registry;
use hashbrown::hash_table::Entry;
use hashbrown::{DefaultHashBuilder, HashMap, HashSet, HashTable};
use std::collections::BTreeMap;
use std::hash::BuildHasher;
use std::mem::take;
use std::sync::{Arc, LazyLock};
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::procedural;
use tabray_core::scene::store::Store;
use tabray_core::scene::value::{Datum, Value};
use tabray_core::text::{self, nearest};
use tabray_core::world::body::{NamedBody, ShaderFactory};

/// The scope in which a name must be unique: the entity type for an object, and an empty string, which stands for the
/// whole kind, for the others.
pub(super) type Scope = &'static str;

/// Further claims to a name that is already in use.
#[derive(Default)]
pub(super) struct RepeatedClaims {
    /// The other scopes in which the name was claimed.
    scopes: Vec<Scope>,
    /// The claims, each with the order of the entity.
    pub again: Vec<(Scope, usize)>,
}

/// An entity: half the hash of its name, and its order.
struct First {
    hash: u32,
    order: u32,
}

/// The names in the checked part of a scene. Their letters are in the [`Store`].
#[derive(Default)]
pub struct Names {
    hasher: DefaultHashBuilder,
    /// The first entity of each kind and name.
    firsts: HashTable<First>,
    /// The entities that claimed a name again, by the order of the first one.
    pub(super) again: BTreeMap<usize, RepeatedClaims>,
    /// The hashes of the names of entities with unknown types, which a reference may mean.
    doubtful: HashSet<u64>,
    /// The materials, textures and shaders defined so far, and the objects referred to so far, by the indices of their
    /// data.
    defined: [HashMap<String, u32>; 4],
    /// The objects that other entities refer to, by their orders, with a datum each.
    patterns: BTreeMap<usize, Datum>,
    /// References to entities that are not defined yet.
    unresolved: Missing<Kind>,
    /// Whether an entity refers to a list of objects.
    pub combines: bool,
}

impl Names {
    /// Returns the hash of a word.
    pub fn hash_of(&self, word: &str) -> u64 {
        self.hasher.hash_one(word)
    }

    /// Notes the name of an entity with an unknown type.
    pub fn doubt(&mut self, name: &str) {
        let hash = self.hash_of(name);
        self.doubtful.insert(hash);
    }

    /// Claims a name for an entity, and reports an invalid name. `hash` comes from [`hash`](Self::hash). Returns
    /// whether the entity counts: of several materials, textures or objects of one type with the same name, only the
    /// first does.
    pub fn claim(
        &mut self,
        store: &Store,
        entity: &'static Entity,
        (word, hash): (&Word<'_>, u32),
        report: &mut Report<'_>,
    ) -> bool {
        let Word { text, form, place } = word;
        let kind = entity.kind();
        if text.is_empty() && *form == Form::Text {
            report.add(
                Fault::error(place.clone(), format!("this {kind} has an empty name"))
                    .help("a name is any word; put it in quotes if it contains white space"),
            );
        }
        if !text.bytes().all(|byte| byte.is_ascii_graphic()) && text.contains(char::is_control) {
            report.add(
                Fault::error(place.clone(), format!("`{}` cannot be a name", text.escape_debug()))
                    .help("a name must not contain newlines or other control characters"),
            );
        }
        let order = store.count();
        let is_same = |first: &First| is_of(store, first, hash, kind, text);
        let first = match self.firsts.entry(spread(hash), is_same, |first| spread(first.hash)) {
            Entry::Occupied(first) => first.get().order as usize,
            Entry::Vacant(free) => {
                free.insert(First { hash, order: order as u32 });
                return true;
            }
        };
        if text.is_empty() || matches!(kind, Kind::Camera | Kind::Background) {
            return true;
        }
        let (scope, first_scope) = (scope(entity), store.entity(first).map_or("", scope));
        let RepeatedClaims { scopes, again } = self.again.entry(first).or_default();
        let is_first = first_scope != scope && !scopes.contains(&scope);
        if is_first {
            scopes.push(scope);
        }
        again.push((scope, order));
        is_first || kind == Kind::Light
    }

    /// Frees unneeded memory after all names are claimed.
    pub fn forget(&mut self) {
        if self.unresolved.is_empty() {
            self.firsts = HashTable::new();
        }
    }

    /// Finds the first entity with a kind and name.
    fn first(&self, store: &Store, kind: Kind, name: &str) -> Option<usize> {
        let hash = self.hash(kind, name);
        let first = self.firsts.find(spread(hash), |first| is_of(store, first, hash, kind, name));
        first.map(|first| first.order as usize)
    }

    /// Returns half a hash of the name of an entity of a kind.
    pub fn hash(&self, kind: Kind, name: &str) -> u32 {
        (self.hasher.hash_one((kind, name)) >> 32) as u32
    }

    /// Defines a name for references from later entities.
    pub fn define(&mut self, kind: Kind, name: &str, index: u32) {
        self.defined[table_of(kind)].insert(name.to_owned(), index);
    }

    /// Returns the index of the datum of a defined entity.
    pub fn defined(&self, kind: Kind, name: &str) -> Option<u32> {
        self.defined[table_of(kind)].get(name).copied()
    }

    /// Takes the objects that other entities refer to, by their orders, with a datum each.
    pub fn patterns(&mut self) -> BTreeMap<usize, Datum> {
        take(&mut self.patterns)
    }

    /// Returns the entity that a word refers to. If it is undefined, notes the reference and returns a placeholder, so
    /// that the referring entity can be checked.
    pub fn resolve(&mut self, store: &Store, kind: Kind, word: &Word<'_>) -> Datum {
        if let Some(index) = self.defined(kind, &word.text) {
            return store.datum(index).clone();
        }
        if kind == Kind::Object
            && let Some(order) = self.first(store, kind, &word.text)
        {
            let new = || Datum::Object { name: Arc::from(&*word.text), body: NamedBody::default() };
            return self.patterns.entry(order).or_insert_with(new).clone();
        }
        if kind == Kind::Shader
            && let Some(paint) = procedural::of_type(&word.text)
        {
            return Datum::Shader { name: Arc::from(&*word.text), paint: paint.clone() };
        }
        let hash = self.hash_of(&word.text);
        self.unresolved.add(kind, word, hash);
        placeholder(kind)
    }

    /// Reports the references to undefined names, one fault for each name. `place` returns the place of an entity's
    /// name, given its order.
    pub fn report_unresolved(
        &self,
        registry: &Registry,
        store: &Store,
        place: impl Fn(usize) -> Place,
        report: &mut Report<'_>,
    ) {
        // The order of the text restricts guesses to listed references.
        let is_doubtful = |hash| self.doubtful.contains(&hash);
        let unresolved = self.unresolved.names.iter();
        let mut unresolved: Vec<_> =
            unresolved.filter(|((_, text), _)| !is_doubtful(self.hash_of(text))).collect();
        let others = self.unresolved.others().filter(|hash| !is_doubtful(*hash)).count();
        report.count_more(Severity::Error, others);
        unresolved.sort_by_key(|(_, (place, _))| place.as_ref().map(|place| place.start));
        let known = known(store, unresolved.iter().map(|((kind, _), _)| *kind));
        for ((kind, text), (first, count)) in unresolved {
            let is_told = report.would_list(Severity::Error, first);
            let fault = match self.first(store, *kind, text) {
                Some(defined) => {
                    Fault::error(first.clone(), format!("{kind} `{text}` is used before it is defined"))
                        .label(suggestion(None, *count))
                        .also(place(defined), "defined here")
                        .help(format!("{} must be defined before it is used", kind.with_article()))
                }
                // A type with required attributes cannot replace a shader.
                None if *kind == Kind::Shader
                    && let Some(entity) = registry.find(text).filter(|entity| entity.kind() == *kind) =>
                {
                    let usage = report.syntax().entity_usage(entity, "NAME");
                    Fault::error(first.clone(), format!("there is no shader `{text}`"))
                        .label(suggestion(None, *count))
                        .help(format!("`{text}` is a type of shader: define one first: {usage}"))
                }
                None => {
                    let known = known.get(kind).filter(|_| is_told).into_iter().flatten().copied();
                    // An entity does not refer to itself.
                    let own = if is_told { owner(store, &place, first) } else { None };
                    let known: Vec<_> = known.filter(|name| Some(*name) != own).collect();
                    let of_file = files::stem(text).filter(|stem| known.contains(stem));
                    let near = of_file.or_else(|| nearest(text, known));
                    let cure = files::cure(*kind, text, None, report.syntax()).filter(|_| near.is_none());
                    let define = || match of_file {
                        Some(_) => format!("here stands the name of the {kind}, not that of a file"),
                        None => {
                            format!("define it first: {}", registry.example(*kind, text, report.syntax()))
                        }
                    };
                    Fault::error(first.clone(), format!("there is no {kind} `{text}`"))
                        .label(suggestion(near, *count))
                        .meant(near)
                        .help(cure.unwrap_or_else(define))
                }
            };
            report.add(fault);
        }
    }
}

/// Returns the names of the entities of each of these kinds, in alphabetical order.
fn known(store: &Store, kinds: impl Iterator<Item = Kind>) -> BTreeMap<Kind, Vec<&str>> {
    let mut known: BTreeMap<Kind, Vec<&str>> = kinds.map(|kind| (kind, Vec::new())).collect();
    let orders = if known.is_empty() { 0..0 } else { 0..store.count() };
    for (entity, order) in orders.filter_map(|order| Some((store.entity(order)?, order))) {
        if let Some(known) = known.get_mut(&entity.kind()) {
            known.push(store.name(order));
        }
    }
    if let Some(known) = known.get_mut(&Kind::Shader) {
        known.extend(procedural::types().map(|entity| entity.name));
    }
    known.values_mut().for_each(|known| {
        known.sort_unstable();
        known.dedup();
    });
    known
}

/// Returns the name of the entity that contains a place: the last entity with a name before the place.
fn owner<'s>(store: &'s Store, place: impl Fn(usize) -> Place, at: &Place) -> Option<&'s str> {
    let (at, mut orders) = (at.as_ref()?.start, 0..store.count());
    while !orders.is_empty() {
        let middle = orders.start + orders.len() / 2;
        if place(middle)?.start < at { orders.start = middle + 1 } else { orders.end = middle }
    }
    orders.start.checked_sub(1).map(|order| store.name(order))
}

/// Returns the index of the table of the defined entities of a kind.
fn table_of(kind: Kind) -> usize {
    match kind {
        Kind::Shader => 3,
        Kind::Object => 2,
        Kind::Texture => 1,
        _ => 0,
    }
}

/// Returns the scope in which the name of an entity must be unique. The course's own images show a sphere `left` and an
/// fplane `left` in one scene.
pub(super) fn scope(entity: &'static Entity) -> Scope {
    if entity.kind() == Kind::Object { entity.name } else { "" }
}

/// Spreads the bits of half a hash over the upper and the lower bits of a hash.
fn spread(hash: u32) -> u64 {
    // 2^64 divided by the golden ratio (Knuth's multiplicative hashing).
    u64::from(hash).wrapping_mul(0x9E37_79B9_7F4A_7C15)
}

/// Tells whether an entity, given by its hash and its order, has this kind and name.
fn is_of(store: &Store, first: &First, hash: u32, kind: Kind, name: &str) -> bool {
    let order = first.order as usize;
    // An entity under check has a name, but is not in the store yet.
    first.hash == hash
        && order < store.count()
        && store.entity(order).is_some_and(|entity| entity.kind() == kind)
        && store.name(order) == name
}

/// Returns a default entity in place of a faulty or missing one. All default entities of a kind are the same.
pub fn placeholder(kind: Kind) -> Datum {
    match kind {
        Kind::Object => return Datum::Object { name: Arc::from(""), body: NamedBody::default() },
        Kind::Shader => return ShaderFactory::default().to_datum(),
        _ => {}
    }
    static PLACEHOLDERS: LazyLock<[Datum; 2]> = LazyLock::new(|| {
        [
            Datum::Material { name: Arc::from(""), material: Arc::default() },
            Datum::Texture { name: Arc::from(""), texture: Arc::default() },
        ]
    });
    PLACEHOLDERS[usize::from(kind == Kind::Texture)].clone()
}

/// Returns the label of a fault that may have several places.
pub fn suggestion(near: Option<&str>, places: usize) -> String {
    let more = text::count(places - 1, "more place");
    match (near, places) {
        (None, 1) => String::new(),
        (None, _) => format!("here and in {more}"),
        (Some(near), 1) => format!("did you mean `{near}`?"),
        (Some(near), _) => format!("did you mean `{near}`? (here and in {more})"),
    }
}
