//! A TextMate grammar of the notes' spelling, written from the tables: what editors colour scenes with.

use crate::scene::entity::Entity;
use crate::scene::pparm::Attribute;
use crate::scene::registry::Registry;
use crate::scene::value::Type;
use serde_json::{Map, Value, json};
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

/// The grammar, as the JSON that editors read from a `.tmLanguage.json`.
///
/// It is a list of rules for each entity type. Wherever a word can begin, some rule takes the whole word, so that
/// none is ever found in the middle of another one.
pub fn of(registry: &Registry) -> Value {
    let mut repository: Map<_, _> =
        registry.iter().map(|entity| (entity.name.to_owned(), entity_rule(entity))).collect();
    repository.insert(
        "comment-line".to_owned(),
        json!({ "name": "comment.line.number-sign.tabray", "match": "#.*$" }),
    );
    repository.insert("any-number".to_owned(), json!({ "name": NUMERIC, "match": format!("{NUMBER}{END}") }));
    repository.insert("quoted-word".to_owned(), json!({ "name": IN_QUOTES, "match": QUOTED }));
    repository.insert("bare-word".to_owned(), json!({ "match": BARE }));
    // A plugin may have come since.
    let other = within(BARE, None, ["any-number", "quoted-word", "bare-word"].map(include).to_vec());
    repository.insert("other-entity".to_owned(), other);
    let known = registry.iter().map(|entity| entity.name);
    json!({
        "name": "tabray scene",
        "scopeName": "source.tabray",
        "fileTypes": ["ray"],
        "patterns": iter::once("comment-line").chain(known).chain(["other-entity"]).map(include).collect::<Vec<_>>(),
        "repository": repository,
    })
}

/// An entity from its type to its closing brace.
fn entity_rule(entity: &'static Entity) -> Value {
    let names = iter::once(entity.name).chain(entity.aliases.iter().copied());
    let attributes = entity.attributes().map(attribute_rule);
    let rest = ["any-number", "quoted-word", "bare-word"].map(include);
    within(&one_of(names), Some(TYPE), attributes.chain(rest).collect())
}

/// An entity whose type matches `begin`, with these rules between its braces.
fn within(begin: &str, scope: Option<&str>, mut inside: Vec<Value>) -> Value {
    inside.insert(0, include("comment-line"));
    let body = json!({ "begin": r"\{", "end": r"\}", "patterns": inside });
    let name = json!({ "name": NAME, "match": format!("{QUOTED}|{BARE}") });
    let mut rule = json!({
        "begin": format!("({begin}){END}"),
        // Right after the body.
        "end": r"(?<=\})",
        "patterns": [include("comment-line"), name, body],
    });
    if let Some(scope) = scope {
        rule["beginCaptures"] = json!({ "1": { "name": scope } });
    }
    rule
}

/// An attribute. Numbers are known by themselves; any other value may look like anything, even like an attribute.
fn attribute_rule(attribute: &'static dyn Attribute) -> Value {
    let names = iter::once(attribute.name()).chain(attribute.aliases().iter().copied());
    let begin = format!("({}){END}", one_of(names));
    let value = match attribute.value_type() {
        Type::Whole | Type::Number => return json!({ "name": ATTRIBUTE, "match": begin }),
        Type::Name(_) => json!({
            "end": format!("({QUOTED}|{BARE})|(?=[{{}}])"),
            "endCaptures": { "1": { "name": REFERENCE } },
        }),
        Type::Word | Type::Formula => json!({
            "end": format!("({QUOTED})|({BARE})|(?=[{{}}])"),
            "endCaptures": { "1": { "name": IN_QUOTES }, "2": { "name": WORD } },
        }),
        Type::Choice(choices) => {
            let known = one_of(choices.all().iter().map(|choice| choice.name));
            json!({
                "end": format!("({QUOTED})|({NUMBER}){END}|({known}){END}|({BARE})|(?=[{{}}])"),
                "endCaptures": {
                    "1": { "name": IN_QUOTES },
                    "2": { "name": NUMERIC },
                    "3": { "name": CHOICE },
                    "4": { "name": WORD },
                },
            })
        }
    };
    let mut rule = json!({
        "begin": begin,
        "beginCaptures": { "1": { "name": ATTRIBUTE } },
        "patterns": [include("comment-line")],
    });
    if let (Some(rule), Value::Object(value)) = (rule.as_object_mut(), value) {
        rule.extend(value);
    }
    rule
}

fn include(rule: &str) -> Value {
    json!({ "include": format!("#{rule}") })
}

/// A pattern of these names, which are letters, digits and `_`.
fn one_of<'n>(names: impl Iterator<Item = &'n str>) -> String {
    names.collect::<Vec<_>>().join("|")
}
