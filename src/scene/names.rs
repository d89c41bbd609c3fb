//! The names of a scene: who has them, and what those that refer to them mean.

use super::fault::{Fault, Place, Report};
use super::written::{Form, Word, Written};
use crate::entity::Kind;
use crate::registry::Registry;
use crate::value::Datum;
use crate::words::{self, nearest};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// A name of a kind: the same name may stand for a material and for an object.
type Name = (Kind, String);

/// The names of a scene, as far as it has been read.
pub struct Names {
    /// Where each name stands first, before or after its uses.
    places: HashMap<Name, Place>,
    /// Names of entities of no known type: they may be what a reference means.
    doubtful: HashSet<String>,
    /// The names that were claimed so far.
    claimed: HashSet<Name>,
    /// What can be referred to so far.
    defined: HashMap<Name, Datum>,
    /// References to what is not there (yet), each with all its places.
    unresolved: BTreeMap<Name, Vec<Place>>,
}

impl Names {
    /// All names of a scene, none of them claimed yet.
    pub fn of(registry: &Registry, written: &[Written<'_>]) -> Self {
        let (mut places, mut doubtful) = (HashMap::new(), HashSet::new());
        for Written { kind, name, .. } in written {
            let text = name.text.to_string();
            match registry.find(&kind.text) {
                Some(entity) => {
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
            claimed: HashSet::new(),
            defined: HashMap::new(),
            unresolved: BTreeMap::new(),
        }
    }

    /// Gives an entity its name, and reports a word that is none and a name that is taken.
    pub fn claim(&mut self, kind: Kind, word: &Word<'_>, report: &mut Report) {
        let Word { text, form, place } = word;
        if text.is_empty() && *form == Form::Text {
            report.add(
                Fault::error(place.clone(), format!("this {kind} has an empty name"))
                    .help("a name is any word; one with blanks stands in quotes"),
            );
        }
        if text.contains(char::is_control) {
            report.add(
                Fault::error(place.clone(), format!("`{}` cannot be a name", text.escape_debug()))
                    .help("a name has no line ends and no other control characters"),
            );
        }
        let name = (kind, text.to_string());
        if self.claimed.insert(name.clone()) || text.is_empty() || kind == Kind::Camera {
            return;
        }
        let fault = match kind {
            Kind::Material | Kind::Texture => {
                Fault::error(place.clone(), format!("{kind} `{text}` is defined twice"))
                    .help("give one of them another name")
            }
            _ => Fault::warning(place.clone(), format!("two {kind}s have the name `{text}`"))
                .help("both are in the picture; messages and dumps cannot tell them apart"),
        };
        report.add(fault.also(self.places.get(&name).cloned().flatten(), "the first one"));
    }

    /// Lets what follows refer to a name.
    pub fn define(&mut self, kind: Kind, name: &str, datum: Datum) {
        self.defined.entry((kind, name.to_owned())).or_insert(datum);
    }

    /// What a word refers to. If that is not there, it is remembered, and something stands in for it, so that
    /// whatever refers to it can be checked.
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

    /// Reports the references to what was not there, one fault for each name.
    pub fn report_unresolved(&self, registry: &Registry, report: &mut Report) {
        for ((kind, text), places) in &self.unresolved {
            let fault = match self.places.get(&(*kind, text.clone())) {
                Some(defined) => {
                    Fault::error(places[0].clone(), format!("{kind} `{text}` is used before it is defined"))
                        .label(suggestion(None, places))
                        .also(defined.clone(), "it is defined here")
                        .help(format!("a {kind} stands above what refers to it"))
                }
                None => {
                    let known = self.places.keys().filter(|(known, _)| known == kind);
                    let mut known: Vec<_> = known.map(|(_, text)| text.as_str()).collect();
                    known.sort_unstable();
                    Fault::error(places[0].clone(), format!("there is no {kind} `{text}`"))
                        .label(suggestion(nearest(text, known), places))
                        .help(format!("define it above: {}", registry.example(*kind, text, report.syntax())))
                }
            };
            report.add(fault);
        }
    }
}

/// What is referred to where the thing itself is faulty or missing.
pub fn stand_in(kind: Kind, name: &str) -> Datum {
    let name = Arc::from(name);
    match kind {
        Kind::Texture => Datum::Texture { name, texture: Arc::default() },
        _ => Datum::Material { name, material: Arc::default() },
    }
}

/// The label of a fault that may stand in several places.
pub fn suggestion(near: Option<&str>, places: &[Place]) -> String {
    let more = words::count(places.len() - 1, "more place");
    match (near, places.len()) {
        (None, 1) => String::new(),
        (None, _) => format!("here and in {more}"),
        (Some(near), 1) => format!("did you mean `{near}`?"),
        (Some(near), _) => format!("did you mean `{near}`? (here and in {more})"),
    }
}
