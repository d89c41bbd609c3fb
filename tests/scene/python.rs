//! The Python package's functions of entity types, as type checkers see them: they are those of the tables.

use crate::common::{registry, root};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use tabray::scene::list_json::{Attribute, Entity, Tables};

/// The words of Python that are not names. As names of arguments, they take an underscore at their end.
const KEYWORDS: [&str; 12] =
    ["and", "as", "class", "def", "for", "from", "if", "in", "is", "lambda", "not", "or"];

fn value_type(attribute: &Attribute) -> &'static str {
    match attribute.value_type {
        "word" | "file" | "name" => "_Words",
        "choice" => "_Word",
        "formula" => "_Formula",
        "truth" => "_Truth",
        _ => "_Numbers",
    }
}

fn function(entity: &Entity) -> String {
    let mut text = format!("\ndef {}(\n    name: str,\n    /,\n    *,\n", entity.name);
    let mut names = BTreeSet::new();
    for attribute in &entity.attributes {
        for name in [attribute.name].iter().chain(attribute.aliases) {
            if *name == "name" || !names.insert(*name) {
                continue;
            }
            let end = if KEYWORDS.contains(name) { "_" } else { "" };
            writeln!(text, "    {name}{end}: {} = None,", value_type(attribute)).expect("a string");
        }
    }
    if names.is_empty() {
        text = text.replace("    *,\n", "");
    }
    text + ") -> Entity: ...\n"
}

/// The stub for type checkers, which has a function for each entity type that it knows. It need not know all: a new
/// plugin is typed as any function is, until the stub is made again.
#[test]
fn the_functions_of_entity_types_are_typed_as_the_tables_say() {
    let path = root().join("src/python/tabray/entities.pyi");
    let known = fs::read_to_string(&path).expect("the stub");
    let mut functions =
        known.match_indices("\ndef ").filter(|(at, def)| !known[at + def.len()..].starts_with("__"));
    let head = &known[..functions.next().expect("a function").0];
    let tables = Tables::of(registry());
    let text = |is_told: &dyn Fn(&str) -> bool| {
        let told = tables.entities.iter().filter(|entity| is_told(entity.name));
        head.to_owned() + &told.map(function).collect::<String>()
    };
    if known == text(&|name| known.contains(&format!("\ndef {name}("))) {
        return;
    }
    fs::write(path.with_extension("pyi.new"), text(&|_| true)).expect("a file");
    panic!("{} is not what the tables say: rename entities.pyi.new beside it to that", path.display());
}
