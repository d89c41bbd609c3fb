//! A TextMate grammar of the notes' spelling, written from the tables: what editors colour scenes with.

use crate::scene::entity::Entity;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::value::Type;
use serde::Serialize;
use std::collections::BTreeMap;
use std::iter;

/// What follows a word.
const END: &str = r"(?=[\s{}]|$)";
/// A word in quotes.
const QUOTED: &str = r#""(?:[^"\\]|\\.)*"?"#;
/// A word without quotes, which no comment and no quote begins.
const BARE: &str = r#"[^\s{}#"][^\s{}]*"#;
const NUMBER: &str = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?";

const TYPE: &str = "storage.type.tabray";
const NAME: &str = "entity.name.type.tabray";
const ATTRIBUTE: &str = "support.type.property-name.tabray";
const NUMERIC: &str = "constant.numeric.tabray";
const CHOICE: &str = "constant.language.tabray";
const REFERENCE: &str = "variable.other.tabray";
const IN_QUOTES: &str = "string.quoted.double.tabray";
const WORD: &str = "string.unquoted.tabray";

/// A grammar: what editors read from a `.tmLanguage.json`.
///
/// It is a list of rules for each entity type. Wherever a word can begin, some rule takes the whole word, so that
/// none is ever found in the middle of another one.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Grammar {
    /// The endings of the files that it is for.
    pub file_types: [&'static str; 1],
    /// What editors call the language.
    pub name: &'static str,
    /// The rules for what stands outside of entities.
    pub patterns: Vec<Rule>,
    /// The rules that others include, by name.
    pub repository: BTreeMap<&'static str, Rule>,
    /// What themes call the language.
    pub scope_name: &'static str,
}

/// A rule: what it matches and the scope which that gets, by which a theme gives it a colour. What a rule does not need
/// is left out.
#[derive(Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Rule {
    /// Where what it matches begins; it ends at `end`, and `patterns` are for what is between.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub begin: Option<String>,
    /// The scopes of the groups of `begin`, by number.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub begin_captures: BTreeMap<&'static str, Scope>,
    /// Where it ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<String>,
    /// The scopes of the groups of `end`, by number.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub end_captures: BTreeMap<&'static str, Scope>,
    /// The name of the rule, behind a `#`, that stands in this one's place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub include: Option<String>,
    /// What it matches, within a line.
    #[serde(rename = "match", skip_serializing_if = "Option::is_none")]
    pub pattern: Option<String>,
    /// The scope of what it matches.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<&'static str>,
    /// The rules for what is between `begin` and `end`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub patterns: Vec<Rule>,
}

/// What a theme gives a colour by.
#[derive(Serialize)]
pub struct Scope {
    /// Its name.
    pub name: &'static str,
}

impl Rule {
    fn matching(pattern: impl Into<String>, name: Option<&'static str>) -> Self {
        Self { pattern: Some(pattern.into()), name, ..Self::default() }
    }

    /// The rule of this name in the repository.
    fn include(rule: &str) -> Self {
        Self { include: Some(format!("#{rule}")), ..Self::default() }
    }
}

/// The grammar of these entity types.
pub fn of(registry: &Registry) -> Grammar {
    let mut repository: BTreeMap<_, _> =
        registry.iter().map(|entity| (entity.name, entity_rule(entity))).collect();
    let number = format!("{NUMBER}{END}");
    repository.extend([
        ("comment-line", Rule::matching("#.*$", Some("comment.line.number-sign.tabray"))),
        ("any-number", Rule::matching(number, Some(NUMERIC))),
        ("quoted-word", Rule::matching(QUOTED, Some(IN_QUOTES))),
        ("bare-word", Rule::matching(BARE, None)),
        // A plugin may have come since.
        ("other-entity", within(BARE, None, iter::empty())),
    ]);
    let known = registry.iter().map(|entity| entity.name);
    Grammar {
        file_types: ["ray"],
        name: "tabray scene",
        patterns: iter::once("comment-line")
            .chain(known)
            .chain(["other-entity"])
            .map(Rule::include)
            .collect(),
        repository,
        scope_name: "source.tabray",
    }
}

/// An entity from its type to its closing brace.
fn entity_rule(entity: &'static Entity) -> Rule {
    let names = iter::once(entity.name).chain(entity.aliases.iter().copied());
    within(&one_of(names), Some(TYPE), entity.attributes().map(attribute_rule))
}

/// An entity whose type matches `begin`, with these rules between its braces, and those for any other word.
fn within(begin: &str, scope: Option<&'static str>, attributes: impl Iterator<Item = Rule>) -> Rule {
    let comment = || iter::once(Rule::include("comment-line"));
    let rest = ["any-number", "quoted-word", "bare-word"].map(Rule::include);
    let body = Rule {
        begin: Some(r"\{".to_owned()),
        end: Some(r"\}".to_owned()),
        patterns: comment().chain(attributes).chain(rest).collect(),
        ..Rule::default()
    };
    let name = Rule::matching(format!("{QUOTED}|{BARE}"), Some(NAME));
    Rule {
        begin: Some(format!("({begin}){END}")),
        begin_captures: captures(scope.as_slice()),
        // Right after the body.
        end: Some(r"(?<=\})".to_owned()),
        patterns: comment().chain([name, body]).collect(),
        ..Rule::default()
    }
}

/// An attribute. Numbers are known by themselves; any other value may look like anything, even like an attribute.
fn attribute_rule(attribute: &'static dyn Attribute) -> Rule {
    let names = iter::once(attribute.name()).chain(attribute.aliases().iter().copied());
    let begin = format!("({}){END}", one_of(names));
    let (end, scopes) = match attribute.value_type() {
        Type::Whole | Type::Number => return Rule::matching(begin, Some(ATTRIBUTE)),
        Type::Name(_) => (format!("({QUOTED}|{BARE})|(?=[{{}}])"), &[REFERENCE][..]),
        Type::Word | Type::Formula => (format!("({QUOTED})|({BARE})|(?=[{{}}])"), &[IN_QUOTES, WORD][..]),
        Type::Choice(choices) => {
            let known = one_of(choices.all().iter().map(|choice| choice.name));
            let end = format!("({QUOTED})|({NUMBER}){END}|({known}){END}|({BARE})|(?=[{{}}])");
            (end, &[IN_QUOTES, NUMERIC, CHOICE, WORD][..])
        }
    };
    Rule {
        begin: Some(begin),
        begin_captures: captures(&[ATTRIBUTE]),
        end: Some(end),
        end_captures: captures(scopes),
        patterns: vec![Rule::include("comment-line")],
        ..Rule::default()
    }
}

/// The scopes of groups, from the first one on.
fn captures(scopes: &[&'static str]) -> BTreeMap<&'static str, Scope> {
    iter::zip(["1", "2", "3", "4"], scopes.iter().map(|name| Scope { name })).collect()
}

/// A pattern of these names, which are letters, digits and `_`.
fn one_of<'n>(names: impl Iterator<Item = &'n str>) -> String {
    names.collect::<Vec<_>>().join("|")
}
