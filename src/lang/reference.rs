//! The reference of the scene language: the meanings of its words, generated from the tables.

use crate::registry::Registry;
use crate::syntax::Syntax;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::choice::{Choice, ChoiceName};
use tabray_core::scene::counts::OneOf;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::profile::Profile;
use tabray_core::scene::value::Datum;
use tabray_core::text;

/// The part of the reference that does not depend on the entity types.
const LANGUAGE: &str = include_str!("language.md");

// The page is in `docs/`. A link to it in this folder makes it a part of packages of this crate.
const _: () =
    assert!(LANGUAGE.len() > 1000, "language.md is no link: clone with `git -c core.symlinks=true clone`");

/// Returns the whole reference as one Markdown text.
pub fn markdown(registry: &Registry) -> String {
    let mut text = LANGUAGE.to_owned();
    let mut add = |title: &str, words: &mut dyn Iterator<Item = Word>| {
        text += &format!("\n## {title}\n");
        text.extend(words.map(|word| {
            format!("\n### {}\n\n{}.\n{}", word.name, text::capital(word.meaning), word.details)
        }));
    };
    for (kind, title) in [
        (Kind::Camera, "The camera"),
        (Kind::Material, "Materials"),
        (Kind::Texture, "Textures"),
        (Kind::Light, "Lights"),
        (Kind::Object, "Objects"),
        (Kind::Shader, "Shaders"),
        (Kind::Background, "Backgrounds"),
    ] {
        add(title, &mut registry.iter().filter(|entity| entity.kind() == kind).map(Word::entity));
    }
    add("Profiles", &mut profiles());
    text
}

/// Returns a page, with its name, for each word of the language: each entity type and profile. The pages are in
/// `snapshots/reference`, and refer to the images beside that folder.
pub fn pages(registry: &Registry) -> impl Iterator<Item = (&'static str, String)> {
    let entities = registry.iter().map(|entity| {
        let (name, kind) = (entity.name, text::capital(&entity.kind().to_string()));
        let scene = format!(
            "\n[This scene](../../scenes/entities/{name}.ray):\n\n![{name}](../entities/{name}.snap.png)\n"
        );
        (kind, scene, Word::entity(entity))
    });
    let profiles = profiles().map(|word| ("Profile".to_owned(), String::new(), word));
    entities.chain(profiles).map(|(what, scene, Word { name, meaning, place, details })| {
        let file = place.split(':').next().unwrap_or_default();
        let plugin = format!("[{file}](../../{file})");
        (name, format!("# {name}\n\n{what}: {meaning}. Its plugin is {plugin}.\n{scene}{details}"))
    })
}

/// A word of the language.
struct Word {
    name: &'static str,
    meaning: &'static str,
    /// The file and line that register the word.
    place: String,
    /// Further details: lines of Markdown, beginning with an empty one.
    details: String,
}

impl Word {
    fn entity(entity: &'static Entity) -> Self {
        let also = match entity.aliases {
            [] => String::new(),
            aliases => format!("\nAlso written {}.\n", text::list(aliases.iter().copied())),
        };
        let rows: String = entity.attributes().map(attribute_row).collect();
        let one_of = |group: &OneOf| {
            format!("\nExactly one of {} is given: {}.\n", group.describe("and"), group.meaning)
        };
        let groups: String = entity.groups().map(one_of).collect();
        let numbers = numbers(&[(entity.numbers[0], " on planes"), (entity.numbers[1], " on spheres")]);
        let details = format!(
            "{also}{numbers}\n| attribute | values | default | meaning |\n|---|---|---|---|\n{rows}{groups}"
        );
        Self { name: entity.name, meaning: entity.meaning, place: entity.place(), details }
    }

    /// Describes an alternative that may have a number.
    fn choice(choice: ChoiceName) -> Self {
        let details = numbers(&[(choice.number, "")]);
        Self { name: choice.name, meaning: choice.meaning, place: text::place(choice.place), details }
    }
}

/// Lists the numbers of a word with their places, if it has any.
fn numbers(numbers: &[(Option<i64>, &str)]) -> String {
    let told = numbers.iter().filter_map(|(number, place)| Some(format!("{}{place}", (*number)?)));
    let told = told.collect::<Vec<_>>().join(" and ");
    if told.is_empty() { told } else { format!("\nIts number is {told}.\n") }
}

fn profiles() -> impl Iterator<Item = Word> {
    by_name::<&'static Profile>().map(Word::choice)
}

/// Returns all alternatives of a type, sorted by name.
pub(super) fn by_name<T: Choice>() -> impl Iterator<Item = ChoiceName> {
    let mut all: Vec<_> = T::all().iter().map(T::option).collect();
    all.sort_unstable_by_key(|choice| choice.name);
    all.into_iter()
}

fn attribute_row(attribute: &'static dyn Attribute) -> String {
    let names = [attribute.name()]
        .iter()
        .chain(attribute.aliases())
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>();
    let default = match attribute.default() {
        None => "required".to_owned(),
        Some(Datum::Absent) => "none".to_owned(),
        Some(datum) => format!("`{}`", Syntax::Notes.values(&datum).join(" ")),
    };
    let mut meaning = attribute.meaning().to_owned();
    if !attribute.unit().is_empty() {
        meaning += &format!(", in {}", attribute.unit());
    }
    if !attribute.rule().is_empty() {
        meaning += &format!("; must be {}", attribute.rule());
    }
    format!("| {} | {} | {default} | {meaning} |\n", names.join(", "), attribute.takes())
}
