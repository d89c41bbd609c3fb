//! The Python package's functions of entity types, as type checkers see them: they are those of the tables.

use crate::common::{registry, root};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use tabray::scene::list_json::{Attribute, Entity, Tables};

const HEAD: &str = r#""""The entity types of the scene language: a function for each, which makes the dict of one entity."""

from typing import Any, Sequence, Union

import numpy as np
from numpy.typing import NDArray

Entity = dict[str, dict[str, dict[str, Any]]]

_Numbers = Union[float, str, np.number[Any], Sequence[Any], NDArray[Any], None]
_Words = Union[str, Sequence[str], None]
_Word = Union[str, int, None]
_Formula = Union[str, float, None]
_Truth = Union[bool, str, None]

__all__: list[str]
"#;

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

#[test]
fn the_functions_of_entity_types_are_typed_as_the_tables_say() {
    let functions: String = Tables::of(registry()).entities.iter().map(function).collect();
    let (text, path) = (format!("{HEAD}{functions}"), root().join("src/python/tabray/entities.pyi"));
    if fs::read_to_string(&path).is_ok_and(|known| known == text) {
        return;
    }
    fs::write(path.with_extension("pyi.new"), text).expect("a file");
    panic!("{} is not what the tables say: rename entities.pyi.new beside it to that", path.display());
}
