//! The registry: all entity types of the program, by name.

use crate::syntax::Syntax;
use std::collections::BTreeMap;
use std::iter;
use std::sync::LazyLock;
use tabray_core::scene::choice::contradictions;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::procedural::ShaderType;
use tabray_core::scene::profile::Profile;
use tabray_core::text::nearest;

/// All entity types of the program.
pub struct Registry {
    entities: BTreeMap<&'static str, &'static Entity>,
    aliases: BTreeMap<&'static str, &'static Entity>,
}

impl Registry {
    /// Returns the entity types that the plugins registered, sorted by name.
    ///
    /// # Errors
    /// Fails if plugins contradict each other, with one line for each name that is registered twice, including both
    /// source positions, and for each profile that is not a formula.
    pub fn get() -> Result<&'static Registry, &'static str> {
        static REGISTRY: LazyLock<Result<Registry, String>> = LazyLock::new(|| {
            let choices = [
                contradictions::<ShaderType<0>>(),
                contradictions::<ShaderType<1>>(),
                contradictions::<&Profile>(),
                profiles(),
            ];
            let mut faults = choices.concat();
            faults.sort_unstable();
            let registry = Registry::of(inventory::iter::<Entity>());
            faults.extend(registry.as_ref().err().cloned());
            if faults.is_empty() { registry } else { Err(faults.join("\n")) }
        });
        REGISTRY.as_ref().map_err(String::as_str)
    }

    /// Makes a registry of these entity types.
    ///
    /// # Errors
    /// Fails if entity types contradict each other, with one line for each name that is given twice, including both
    /// source positions.
    pub fn of(entities: impl IntoIterator<Item = &'static Entity>) -> Result<Registry, String> {
        // `inventory` returns the entity types in the linker's order.
        let mut sorted: Vec<_> = entities.into_iter().collect();
        sorted.sort_unstable_by(|one, other| {
            one.name.cmp(other.name).then_with(|| one.place().cmp(&other.place()))
        });

        let mut faults = Vec::new();
        let mut by_name: BTreeMap<&str, &Entity> = BTreeMap::new();
        let mut aliases: BTreeMap<&str, &Entity> = BTreeMap::new();
        for &entity in &sorted {
            if let Some(first) = by_name.insert(entity.name, entity) {
                faults.push(taken("entity type", entity.name, first, entity));
            }
            let mut names = Vec::new();
            for attribute in entity.attributes() {
                for &name in iter::once(&attribute.name()).chain(attribute.aliases()) {
                    if names.contains(&name) {
                        faults.push(format!(
                            "the table of `{}` at {} has `{name}` twice: rename one of them",
                            entity.name,
                            entity.place()
                        ));
                    }
                    names.push(name);
                }
            }
        }
        for &entity in &sorted {
            for &alias in entity.aliases {
                let first = by_name.get(alias).copied().or_else(|| aliases.insert(alias, entity));
                if let Some(first) = first {
                    faults.push(taken("entity type", alias, first, entity));
                }
            }
        }
        if faults.is_empty() { Ok(Registry { entities: by_name, aliases }) } else { Err(faults.join("\n")) }
    }

    /// Finds the entity type with this name or alias.
    pub fn find(&self, name: &str) -> Option<&'static Entity> {
        self.entities.get(name).or_else(|| self.aliases.get(name)).copied()
    }

    /// Returns the name of the entity type that a word most likely means: one with this name in other programs, or one
    /// with a similar name.
    pub fn nearest(&self, word: &str) -> Option<&'static str> {
        let other = self.known_as(word).map(|entity| entity.name);
        other.or_else(|| nearest(word, self.entities.keys().copied()))
    }

    /// Returns the entity type with this name in other programs.
    pub(crate) fn known_as(&self, word: &str) -> Option<&'static Entity> {
        let lower = word.to_lowercase();
        self.iter().find(|entity| entity.known_as.contains(&lower.as_str()))
    }

    /// Returns the notation of an entity of this kind. If a type has the kind's own name, that type is the example.
    pub(crate) fn example(&self, kind: Kind, name: &str, syntax: Syntax) -> String {
        let is_one = |entity: &Entity| entity.kind() == kind && !entity.refers_to(kind);
        let entity = self.find(&kind.to_string()).or_else(|| self.by_simplicity(is_one).first().copied());
        entity.map(|entity| syntax.entity_usage(entity, name)).unwrap_or_default()
    }

    /// Returns the entity types without a list that meet a condition, those with the fewest attributes first, then by
    /// name.
    pub fn by_simplicity(&self, is_one: impl Fn(&Entity) -> bool) -> Vec<&'static Entity> {
        let has_no_list = |entity: &Entity| entity.attributes().all(|its| its.arity().examples().len() == 1);
        let mut all: Vec<_> = self.iter().filter(|entity| is_one(entity) && has_no_list(entity)).collect();
        all.sort_by_key(|entity| entity.attributes().count());
        all
    }

    /// Describes the beginning of a scene, for users who have none yet.
    pub(crate) fn first_steps(&self, syntax: Syntax) -> String {
        let camera = self.example(Kind::Camera, "NAME", syntax);
        format!("a scene begins with a camera, {camera}; materials, objects and lights follow")
    }

    /// Returns whether there are no entity types: the program links no plugins.
    pub fn is_empty(&self) -> bool {
        self.entities.is_empty()
    }

    /// Returns all entity types, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = &'static Entity> {
        self.entities.values().copied()
    }
}

/// Returns an error message for each profile that is not a formula.
fn profiles() -> Vec<String> {
    let mut faults: Vec<_> = inventory::iter::<Profile>().filter_map(Profile::fault).collect();
    faults.sort_unstable();
    faults
}

fn taken(what: &str, name: &str, first: &Entity, second: &Entity) -> String {
    format!(
        "the {what} `{name}` is registered twice, at {} and at {}: rename one of them",
        first.place(),
        second.place()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reader;
    use std::path::Path;
    use tabray_core::scene::pparm::{Pparm, Row, Table};
    use tabray_core::scene::value::{Datum, Type};
    use tabray_core::world::body::Body;

    static SIZE: Pparm<f64> = Pparm::required("size", "how large it is").alias(&["extent"]);
    static EXTENT: Pparm<f64> = Pparm::required("extent", "how far it reaches");
    const SOUND: Table = &[&SIZE];
    const TWICE: Table = &[&SIZE as &dyn Row, &EXTENT];

    static BOX: Entity = Entity::shape("box", "a box", &[SOUND], |_| unreachable());
    static CRATE: Entity = Entity::shape("crate", "a crate", &[SOUND], |_| unreachable()).alias(&["box"]);
    static OTHER_BOX: Entity = Entity::shape("box", "another box", &[SOUND], |_| unreachable());
    static TORN: Entity = Entity::shape("torn", "a contradiction", &[TWICE], |_| unreachable());

    fn unreachable() -> Result<Body, tabray_core::scene::entity::Refusal> {
        unreachable!("nothing is built here")
    }

    fn fault(entities: &[&'static Entity]) -> String {
        Registry::of(entities.iter().copied()).err().expect("a fault")
    }

    #[test]
    fn no_scene_is_read_without_entity_types() {
        let none = Registry::of([]).expect("no contradiction");
        for scene in ["", "sphere ball { radius 1 }", "[sphere.ball]"] {
            let Err(report) = reader::read(&none, "scene", Path::new(""), scene.as_bytes(), None) else {
                panic!("`{scene}` is read");
            };
            let told = report.to_string();
            assert!(told.starts_with("error: this program has no entity types"), "{told}");
            assert!(told.contains("use tabray_plugins as _;"), "{told}");
        }
        assert!(reader::build(&none, []).is_err());
    }

    #[test]
    fn a_name_taken_twice_is_refused_with_both_places() {
        for order in [[&BOX, &OTHER_BOX], [&OTHER_BOX, &BOX]] {
            let expected = format!(
                "the entity type `box` is registered twice, at {} and at {}: rename one of them",
                BOX.place(),
                OTHER_BOX.place()
            );
            assert_eq!(fault(&order), expected);
        }
        assert!(BOX.place().starts_with("src/lang/registry.rs:"), "{}", BOX.place());
    }

    #[test]
    fn an_alias_that_is_another_types_name_is_refused() {
        assert!(fault(&[&CRATE, &BOX]).starts_with("the entity type `box` is registered twice, at "));
        assert!(Registry::of([&CRATE]).is_ok_and(|registry| registry.find("box").is_some()));
    }

    #[test]
    fn a_table_with_one_name_twice_is_refused_with_its_place() {
        let expected =
            format!("the table of `torn` at {} has `extent` twice: rename one of them", TORN.place());
        assert_eq!(fault(&[&TORN]), expected);
    }

    #[test]
    fn every_table_keeps_its_own_rules() {
        let registry = Registry::get().expect("no two plugins claim one name");
        for entity in registry.iter() {
            let of = |what: &str| format!("{what} of `{}`, {}", entity.name, entity.place());
            let is_short = |meaning: &str| !meaning.is_empty() && !meaning.ends_with('.');
            let meant = "the meaning is a few words without a full stop:";
            assert!(is_short(entity.meaning), "{meant} {}", of("that"));
            for attribute in entity.attributes() {
                let of = |what: &str| of(&format!("{what} of `{}`", attribute.name()));
                assert!(is_short(attribute.meaning()), "{meant} {}", of("that"));
                assert!(
                    (1..1000).contains(&attribute.arity().most()),
                    "some number of values is taken, and fewer than are kept: {}",
                    of("the arity")
                );
                assert!(
                    attribute.default().is_none_or(|datum| attribute.allows(&datum)),
                    "{} does not keep its own rule, to be {}",
                    of("the default"),
                    attribute.rule()
                );
                assert!(
                    attribute.range().is_none_or(|[least, most]| least <= most),
                    "the range has numbers: {}",
                    of("that")
                );
                if let Type::Name(kind) = attribute.value_type() {
                    let is_there = registry.iter().any(|entity| entity.kind() == kind);
                    assert!(is_there, "no plugin makes a {kind}, {}", of("the type"));
                }
            }
            for name in entity.groups().flat_map(|group| group.names) {
                let attribute = entity.attributes().find(|attribute| attribute.name() == *name);
                let may_be_absent = attribute.and_then(|known| known.default()) == Some(Datum::Absent);
                assert!(may_be_absent, "one of a group may be left out: `{name}` of `{}`", entity.name);
            }
        }
    }

    #[test]
    fn names_are_sorted_and_plugins_are_named_by_their_files() {
        let registry = Registry::get().expect("no two plugins claim one name");
        let names: Vec<_> = registry.iter().map(|entity| entity.name).collect();
        assert!(names.is_sorted());
        for entity in registry.iter() {
            let file = format!("plugins/{}.rs:", entity.name);
            assert!(
                entity.place().starts_with(&file),
                "`{}` is registered at {}: a plugin's file is named after it, `plugins/{}.rs`",
                entity.name,
                entity.place(),
                entity.name
            );
        }
    }
}
