//! The types of an attribute's values, for all editor code that depends on them. New types of values are added here.

use super::view::{Entity, View};
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::choice::Choices;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::value::Type;

/// The values that an attribute expects.
#[derive(Clone, Copy)]
pub enum ExpectedValue {
    /// Numbers, or formulas of named numbers in quotes.
    Numbers,
    /// A formula in these variables.
    Formula(&'static [&'static str]),
    /// The name of a file.
    File,
    /// The name of an entity of a kind.
    Name(Kind),
    /// One of several alternatives.
    Choice(Choices),
    /// Yes or no.
    Truth,
    /// Any word.
    Word,
}

/// Returns the values that an attribute takes.
pub fn expected_value(entity: &Entity, attribute: &dyn Attribute) -> ExpectedValue {
    match attribute.value_type() {
        Type::Whole | Type::Number | Type::Rotation => ExpectedValue::Numbers,
        Type::Formula(variables) => ExpectedValue::Formula(variables),
        Type::File => ExpectedValue::File,
        // A texture is read from a file, whatever the type of the attribute.
        Type::Word if entity.known.is_some_and(|known| known.kind() == Kind::Texture) => ExpectedValue::File,
        Type::Word => ExpectedValue::Word,
        Type::Name(kind) => ExpectedValue::Name(kind),
        Type::Choice(choices) => ExpectedValue::Choice(choices),
        Type::Truth => ExpectedValue::Truth,
    }
}

/// Returns the name of the value with this index in a row, or an empty string if it has none.
pub fn value_name(attribute: &dyn Attribute, index: usize) -> &'static str {
    let names = attribute.each();
    if names.is_empty() { "" } else { names[index % names.len()] }
}

/// Returns the words for yes and no.
pub fn truths(view: &View) -> [&'static str; 2] {
    match view.syntax {
        tabray_lang::syntax::Syntax::Notes => ["yes", "no"],
        tabray_lang::syntax::Syntax::Toml => ["true", "false"],
    }
}
