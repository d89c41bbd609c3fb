//! The two syntaxes of scenes, and their notations of names, attributes and values.

use std::path::Path;
use tabray_core::named;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::counts::OneOf;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::value::{Datum, Type, yes_or_no};
use tabray_core::text::shortest;
use tabray_exact::formula::variables::{CURVE, PATCH, SPACE};

/// A syntax of the scene language.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Syntax {
    /// The syntax of the course notes.
    ///
    /// For example, `sphere ball { radius 2 }`.
    #[default]
    Notes,
    /// TOML.
    ///
    /// For example, `[sphere.ball]`, and `radius = 2` below it.
    Toml,
}

named!(Syntax { Notes => "ray", Toml => "toml" });

impl Syntax {
    /// Returns the syntax of a file, by its extension.
    pub fn of_name(name: impl AsRef<Path>) -> Option<Self> {
        let extension = name.as_ref().extension()?;
        Some(if extension.eq_ignore_ascii_case("toml") { Self::Toml } else { Self::Notes })
    }

    /// Guesses the syntax of a text without a file name: only TOML begins with a bracket, with `TYPE.NAME =` or with
    /// `include =`.
    pub fn of_text(text: &str) -> Self {
        let mut lines = text.lines().map(str::trim);
        let first = lines.find(|line| !line.is_empty() && !line.starts_with('#')).unwrap_or_default();
        let key = first.split_once('=').map_or("", |(key, _)| key.trim_end());
        let is_key = (key.contains('.') || key == "include") && !key.contains(char::is_whitespace);
        if first.starts_with('[') || is_key { Self::Toml } else { Self::Notes }
    }

    /// Returns the notation of an attribute, in short: `center N N N`.
    pub fn usage(self, attribute: &dyn Attribute) -> String {
        let (value, count) = match attribute.value_type() {
            Type::Whole | Type::Number | Type::Rotation => {
                ("N", attribute.arity().examples().first().copied().unwrap_or(1))
            }
            Type::Word => ("WORD", 1),
            Type::File => ("FILE", 1),
            Type::Name(_) => ("NAME", attribute.arity().examples().first().copied().unwrap_or(1)),
            Type::Choice(_) => ("N", 1),
            Type::Formula(SPACE) => ("x^2 + y^2 + z^2 - 1", 1),
            Type::Formula(PATCH) => ("u * cos(v)", 1),
            Type::Formula(CURVE) => ("2 + sin(t)", 1),
            Type::Formula(_) => ("2 + sin(y)", 1),
            Type::Truth if self == Self::Toml => ("true", 1),
            Type::Truth => ("yes", 1),
        };
        let is_text =
            matches!(attribute.value_type(), Type::Word | Type::File | Type::Name(_) | Type::Formula(_));
        let values = vec![if is_text { self.word(value) } else { value.to_owned() }; count];
        self.pair(attribute.name(), &values)
    }

    /// Returns the notation of an entity of a type, with its required attributes.
    pub fn entity_usage(self, entity: &Entity, name: &str) -> String {
        let required = entity.attributes().filter(|attribute| attribute.default().is_none());
        let mut body: Vec<_> = required.map(|attribute| self.usage(attribute)).collect();
        let first = |group: &OneOf| {
            entity.attributes().find(|attribute| group.names.first() == Some(&attribute.name()))
        };
        body.extend(entity.groups().filter_map(first).map(|attribute| self.usage(attribute)));
        if body.len() < entity.attributes().count() {
            body.push("...".to_owned());
        }
        self.entity(entity.name, name, &body)
    }

    /// Returns the notation of an entity with these attributes.
    pub fn entity(self, kind: &str, name: &str, body: &[String]) -> String {
        let name = self.key(name);
        match self {
            Self::Notes => format!("`{kind} {name} {{ {} }}`", body.join("  ")),
            Self::Toml if body == ["..."] => format!("`[{kind}.{name}]`, followed by its attributes"),
            Self::Toml => format!("`[{kind}.{name}]`, followed by `{}`", body.join("`, `")),
        }
    }

    /// Writes an attribute and its values.
    pub fn pair(self, attribute: &str, values: &[String]) -> String {
        match (self, values) {
            (Self::Notes, values) => format!("{attribute} {}", values.join(" ")),
            (Self::Toml, [value]) => format!("{attribute} = {value}"),
            (Self::Toml, values) => format!("{attribute} = [{}]", values.join(", ")),
        }
    }

    /// Returns the values of an attribute in this syntax. Numbers keep all bits when they are read back.
    pub fn values(self, datum: &Datum) -> Vec<String> {
        match datum {
            Datum::Whole(numbers) => numbers.iter().map(i64::to_string).collect(),
            Datum::Numbers(numbers) => numbers.iter().map(|number| shortest(*number)).collect(),
            Datum::Word(word) => vec![self.word(word)],
            Datum::Formula(formula) => vec![quoted(&formula.to_string())],
            Datum::Formulas(formulas) => {
                formulas.iter().map(|formula| quoted(&formula.to_string())).collect()
            }
            Datum::Truth(truth) if self == Self::Toml => vec![truth.to_string()],
            Datum::Truth(truth) => vec![yes_or_no(*truth).to_owned()],
            Datum::Absent => Vec::new(),
            Datum::Material { name, .. }
            | Datum::Texture { name, .. }
            | Datum::Shader { name, .. }
            | Datum::Object { name, .. } => {
                vec![self.word(name)]
            }
            Datum::Objects(all) => all.iter().map(|(name, _)| self.word(name)).collect(),
            Datum::Choice(choice) => {
                vec![choice.number.map_or_else(|| self.word(choice.name), |number| number.to_string())]
            }
        }
    }

    /// Writes the name of an entity for its definition.
    pub fn key(self, name: &str) -> String {
        let is_bare =
            |name: &str| name.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"_-".contains(&byte));
        match self {
            Self::Notes => self.word(name),
            Self::Toml if !name.is_empty() && is_bare(name) => name.to_owned(),
            Self::Toml => quoted(name),
        }
    }

    /// Writes a word as a value. The notes' syntax needs quotes only if the bare word would be misread.
    pub fn word(self, word: &str) -> String {
        let splits = |c: char| c.is_whitespace() || c == '{' || c == '}';
        let bare = !word.is_empty() && !word.starts_with(['#', '"']) && !word.contains(splits);
        if self == Self::Notes && bare { word.to_owned() } else { quoted(word) }
    }
}

/// Writes a quoted word for both syntaxes.
fn quoted(word: &str) -> String {
    format!("\"{}\"", word.replace('\\', "\\\\").replace('"', "\\\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_without_a_name_tells_its_spelling() {
        assert_eq!(Syntax::of_text("# [a]\n\n  [camera.eye]\n"), Syntax::Toml);
        assert_eq!(Syntax::of_text("camera.eye = { pixeldim = [8, 6] }"), Syntax::Toml);
        assert_eq!(Syntax::of_text("camera eye { }"), Syntax::Notes);
        assert_eq!(Syntax::of_text("camera a.b=c { }"), Syntax::Notes);
        assert_eq!(Syntax::of_text(""), Syntax::Notes);
    }

    #[test]
    fn quotes_stand_only_where_a_word_would_not_be_read() {
        for (word, notes, toml) in [
            ("red", "red", "red"),
            ("5", "5", "5"),
            ("light.red", "light.red", "\"light.red\""),
            ("dark red", "\"dark red\"", "\"dark red\""),
            ("#1", "\"#1\"", "\"#1\""),
            ("a\"b\\", "a\"b\\", "\"a\\\"b\\\\\""),
            ("", "\"\"", "\"\""),
        ] {
            assert_eq!(
                (Syntax::Notes.key(word), Syntax::Toml.key(word)),
                (notes.to_owned(), toml.to_owned())
            );
        }
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        for (number, text) in [(2.0, "2"), (-0.0, "-0"), (0.1, "0.1"), (1e300, "1e300"), (1e-7, "1e-7")] {
            assert_eq!(shortest(number), text);
        }
    }
}
