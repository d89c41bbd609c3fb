//! A TextMate grammar of the notes' syntax, generated from the tables, for colouring scenes in editors.

use serde::Serialize;
use std::collections::BTreeMap;
use std::iter;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::value::Type;
use tabray_lang::registry::Registry;

/// Matches the end of a word.
const END: &str = r"(?=[\s{}]|$)";
/// Matches a word in quotes that ends on its line.
const QUOTED: &str = r#""(?:[^"\\]|\\.)*(?:"|(?<!\\)$)"#;
/// Matches the beginning of a quoted word that continues on the next line after a `\`.
const CONTINUED: &str = r#""(?=(?:[^"\\]|\\.)*\\$)"#;
/// Matches a word without quotes that does not begin a comment.
const BARE: &str = r#"[^\s{}#"][^\s{}]*"#;
const NUMBER: &str = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?";

const TYPE: &str = "storage.type.tabray";
const NAME: &str = "entity.name.type.tabray";
const ATTRIBUTE: &str = "support.type.property-name.tabray";
const NUMERIC: &str = "constant.numeric.tabray";
const CHOICE: &str = "constant.language.tabray";
const REFERENCE: &str = "variable.other.tabray";
const KEYWORD: &str = "keyword.control.tabray";
const IN_QUOTES: &str = "string.quoted.double.tabray";
const WORD: &str = "string.unquoted.tabray";

/// A grammar, in the format of a `.tmLanguage.json`.
///
/// It has rules for each entity type. Wherever a word can begin, some rule matches the whole word, and so no rule
/// matches in the middle of a word.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Grammar {
    /// The extensions of the grammar's files.
    pub file_types: [&'static str; 1],
    /// The name of the language in editors.
    pub name: &'static str,
    /// The rules for text outside of entities.
    pub patterns: Vec<Rule>,
    /// The rules that others include, by name.
    pub repository: BTreeMap<&'static str, Rule>,
    /// The scope of the language, which themes refer to.
    pub scope_name: &'static str,
}

/// A rule: a pattern, and the scope of the matched text, which a theme colours. Unused fields are omitted.
#[derive(Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Rule {
    /// The pattern at which the match begins. It ends at `end`, and `patterns` apply to the text between.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub begin: Option<String>,
    /// The scopes of the capture groups of `begin`, by number.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub begin_captures: BTreeMap<&'static str, Scope>,
    /// The pattern at which the match ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<String>,
    /// The scopes of the capture groups of `end`, by number.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub end_captures: BTreeMap<&'static str, Scope>,
    /// The name of the rule to use in place of this one, after a `#`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub include: Option<String>,
    /// The pattern to match within a line.
    #[serde(rename = "match", skip_serializing_if = "Option::is_none")]
    pub pattern: Option<String>,
    /// The scope of the matched text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<&'static str>,
    /// The rules for the text between `begin` and `end`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub patterns: Vec<Rule>,
}

/// A scope, by which a theme chooses a colour.
#[derive(Serialize)]
pub struct Scope {
    /// The scope's name.
    pub name: &'static str,
}

impl Rule {
    fn matching(pattern: impl Into<String>, name: Option<&'static str>) -> Self {
        Self { pattern: Some(pattern.into()), name, ..Self::default() }
    }

    /// Refers to the rule with this name in the repository.
    fn include(rule: &str) -> Self {
        Self { include: Some(format!("#{rule}")), ..Self::default() }
    }
}

/// Returns the grammar of these entity types.
pub fn of(registry: &Registry) -> Grammar {
    let mut repository: BTreeMap<_, _> =
        registry.iter().map(|entity| (entity.name, entity_rule(entity))).collect();
    let number = format!("{NUMBER}{END}");
    repository.extend([
        ("comment-line", Rule::matching("#.*$", Some("comment.line.number-sign.tabray"))),
        ("any-number", Rule::matching(number, Some(NUMERIC))),
        ("quoted-word", Rule::matching(QUOTED, Some(IN_QUOTES))),
        ("continued-word", continued_word()),
        ("bare-word", Rule::matching(BARE, None)),
        // The program that reads the scene may have more plugins than the one that wrote the grammar.
        ("other-entity", within(BARE, None, iter::empty())),
    ]);
    let known = || registry.iter().map(|entity| entity.name);
    let all = || {
        let rules = iter::once("comment-line").chain(["let", "include", "repeat"]).chain(known());
        rules.chain(["other-entity"]).map(Rule::include).collect::<Vec<_>>()
    };
    repository.extend(computed(all()));
    Grammar {
        file_types: ["ray"],
        name: "tabray scene",
        patterns: all(),
        repository,
        scope_name: "source.tabray",
    }
}

/// Matches a quoted word on several lines.
fn continued_word() -> Rule {
    Rule {
        begin: Some(CONTINUED.to_owned()),
        end: Some(r#""|(?<!\\)$"#.to_owned()),
        name: Some(IN_QUOTES),
        patterns: vec![Rule::matching(r"\\.", None)],
        ..Rule::default()
    }
}

/// Matches an entity from its type to its closing brace.
fn entity_rule(entity: &'static Entity) -> Rule {
    let names = iter::once(entity.name).chain(entity.aliases.iter().copied());
    within(&one_of(names), Some(TYPE), entity.attributes().map(|attribute| attribute_rule(entity, attribute)))
}

/// Matches an entity whose type matches `begin`. Between its braces, applies these rules and those for any other word.
fn within(begin: &str, scope: Option<&'static str>, attributes: impl Iterator<Item = Rule>) -> Rule {
    let comment = || iter::once(Rule::include("comment-line"));
    let rest = ["any-number", "quoted-word", "continued-word", "bare-word"].map(Rule::include);
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
        // This is the position right after the closing brace.
        end: Some(r"(?<=\})".to_owned()),
        patterns: comment().chain([name, body]).collect(),
        ..Rule::default()
    }
}

/// Returns the rules for other items: named numbers, included files, and `repeat`, with these rules nested in it.
fn computed(all: Vec<Rule>) -> [(&'static str, Rule); 3] {
    let named = |keyword| format!(r"({keyword})\s+({QUOTED}|{BARE}){END}");
    let rest = ["any-number", "quoted-word", "bare-word"].map(Rule::include);
    let body =
        Rule { begin: Some(r"\{".to_owned()), end: Some(r"\}".to_owned()), patterns: all, ..Rule::default() };
    let number = Rule {
        begin: Some(named("let")),
        begin_captures: captures(&[KEYWORD, NAME]),
        end: Some(format!("({QUOTED})|({NUMBER}){END}|({BARE})|(?=[{{}}])|(?<=\")")),
        end_captures: captures(&[IN_QUOTES, NUMERIC, WORD]),
        patterns: ["comment-line", "continued-word"].map(Rule::include).into(),
        ..Rule::default()
    };
    let file = Rule {
        begin: Some(format!("(include){END}")),
        begin_captures: captures(&[KEYWORD]),
        end: Some(format!("({QUOTED})|({BARE})|(?=[{{}}])")),
        end_captures: captures(&[IN_QUOTES, WORD]),
        patterns: vec![Rule::include("comment-line")],
        ..Rule::default()
    };
    let rounds = Rule {
        begin: Some(named("repeat")),
        begin_captures: captures(&[KEYWORD, NAME]),
        end: Some(r"(?<=\})".to_owned()),
        patterns: iter::once(Rule::include("comment-line")).chain([body]).chain(rest).collect(),
        ..Rule::default()
    };
    [("let", number), ("include", file), ("repeat", rounds)]
}

/// Matches an attribute. Numbers are recognised on their own. Other values may look like anything, even like an
/// attribute.
fn attribute_rule(entity: &'static Entity, attribute: &'static dyn Attribute) -> Rule {
    let names = iter::once(attribute.name()).chain(attribute.aliases().iter().copied());
    let begin = format!("({}){END}", one_of(names));
    let (end, scopes) = match attribute.value_type() {
        Type::Whole | Type::Number | Type::Rotation => return Rule::matching(begin, Some(ATTRIBUTE)),
        Type::Name(_) if attribute.arity().most() > 1 => {
            let others = entity
                .attributes()
                .flat_map(|other| iter::once(other.name()).chain(other.aliases().iter().copied()));
            return Rule {
                begin: Some(begin),
                begin_captures: captures(&[ATTRIBUTE]),
                // Like the reader, this ends at the next attribute.
                end: Some(format!("(?=[{{}}]|(?:{}){END})", one_of(others))),
                patterns: vec![
                    Rule::include("comment-line"),
                    Rule::matching(format!("{QUOTED}|{BARE}"), Some(REFERENCE)),
                ],
                ..Rule::default()
            };
        }
        Type::Name(_) => (format!("({QUOTED}|{BARE})|(?=[{{}}])"), &[REFERENCE][..]),
        Type::Truth => {
            (format!("({QUOTED})|(yes|no){END}|({BARE})|(?=[{{}}])"), &[IN_QUOTES, CHOICE, WORD][..])
        }
        Type::Word | Type::File | Type::Formula(_) => {
            (format!("({QUOTED})|({BARE})|(?=[{{}}])|(?<=\")"), &[IN_QUOTES, WORD][..])
        }
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
        patterns: ["comment-line", "continued-word"].map(Rule::include).into(),
        ..Rule::default()
    }
}

/// Assigns these scopes to the capture groups, from group 1 on.
fn captures(scopes: &[&'static str]) -> BTreeMap<&'static str, Scope> {
    iter::zip(["1", "2", "3", "4"], scopes.iter().map(|name| Scope { name })).collect()
}

/// Returns a pattern that matches any of these names of letters, digits and `_`.
fn one_of<'n>(names: impl Iterator<Item = &'n str>) -> String {
    names.collect::<Vec<_>>().join("|")
}
