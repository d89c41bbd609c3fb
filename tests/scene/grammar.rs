//! The TextMate grammar: it classifies each word of a scene as the reader does.

use crate::common::{registry, root, scenes};
use fancy_regex::Regex;
use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use tabray::scene::{self, Syntax, dump, grammar};

/// Applies a grammar as editors do: line by line, with the rule that matches first at each position.
struct Highlighter {
    grammar: Value,
    patterns: HashMap<String, Regex>,
}

/// A piece of text, and its scope.
type Scoped = (String, String);

impl Highlighter {
    fn new() -> Self {
        let grammar = serde_json::to_value(grammar::of(registry())).expect("JSON");
        let mut highlighter = Self { grammar: grammar.clone(), patterns: HashMap::new() };
        highlighter.compile(&grammar);
        highlighter
    }

    /// Compiles every pattern of the grammar.
    fn compile(&mut self, value: &Value) {
        match value {
            Value::Object(fields) => {
                for (name, value) in fields {
                    if let (true, Some(text)) =
                        (["match", "begin", "end"].contains(&name.as_str()), value.as_str())
                    {
                        let pattern = Regex::new(text).unwrap_or_else(|error| panic!("{text}: {error}"));
                        self.patterns.insert(text.to_owned(), pattern);
                    }
                    self.compile(value);
                }
            }
            Value::Array(values) => values.iter().for_each(|value| self.compile(value)),
            _ => {}
        }
    }

    /// Returns the rules of a list, with included rules in their places.
    fn rules<'g>(&'g self, rule: &'g Value) -> Vec<&'g Value> {
        let patterns = rule["patterns"].as_array().map(Vec::as_slice).unwrap_or_default();
        let included = |rule: &'g Value| match rule["include"].as_str() {
            Some(name) => {
                let found = self.grammar["repository"].get(name.trim_start_matches('#'));
                found.unwrap_or_else(|| panic!("the repository has {name}"))
            }
            None => rule,
        };
        patterns.iter().map(included).collect()
    }

    fn scopes(&self, text: &str) -> Vec<Scoped> {
        let mut scoped = Vec::new();
        let mut open: Vec<&Value> = vec![&self.grammar];
        for line in text.lines() {
            let mut at = 0;
            loop {
                let top = open[open.len() - 1];
                let end = top["end"].as_str().map(|end| (end, top, true));
                let rules = self.rules(top).into_iter().filter_map(|rule| {
                    Some((rule["match"].as_str().or_else(|| rule["begin"].as_str())?, rule, false))
                });
                let matches = end.into_iter().chain(rules).filter_map(|(pattern, rule, ends)| {
                    let captures =
                        self.patterns[pattern].captures_from_pos(line, at).expect("a pattern that ends")?;
                    Some((captures.get(0)?.range(), captures, rule, ends))
                });
                // Of several rules that match at the same position, the first counts.
                let Some((whole, captures, rule, ends)) = matches.min_by_key(|(whole, ..)| whole.start)
                else {
                    break;
                };
                let field = if ends { "endCaptures" } else { "beginCaptures" };
                if let Some(name) = rule["name"].as_str() {
                    scoped.push((name.to_owned(), line[whole.clone()].to_owned()));
                }
                for group in 1..captures.len() {
                    let name = rule[field][group.to_string()]["name"].as_str();
                    if let (Some(name), Some(part)) = (name, captures.get(group)) {
                        scoped.push((name.to_owned(), part.as_str().to_owned()));
                    }
                }
                assert!(ends || rule.get("begin").is_some() || whole.end > at, "{line}: no way on from {at}");
                at = whole.end;
                if ends {
                    open.pop();
                } else if rule.get("begin").is_some() {
                    open.push(rule);
                }
            }
        }
        assert_eq!(open.len(), 1, "every entity ends");
        scoped
    }
}

/// Returns a scene in the other syntax, made from the scopes of a text; it shows how each word was classified.
fn scene_of(scoped: &[Scoped]) -> String {
    let mut text = String::new();
    let mut values: Vec<String> = Vec::new();
    let end = |text: &mut String, values: &mut Vec<String>| {
        if !values.is_empty() {
            text.push_str(&format!("[{}]\n", values.join(", ")));
            values.clear();
        }
    };
    for (scope, word) in scoped {
        let word = word.as_str();
        let quoted = || if word.starts_with('"') { word.to_owned() } else { format!("{word:?}") };
        match scope.trim_end_matches(".tabray") {
            "comment.line.number-sign" => {}
            "storage.type" => {
                end(&mut text, &mut values);
                text += &format!("[[{word}.");
            }
            "entity.name.type" => text += &format!("{}]]\n", quoted()),
            "support.type.property-name" => {
                end(&mut text, &mut values);
                text += &format!("{word} = ");
            }
            "constant.numeric" => values.push(match word.parse::<i64>() {
                Ok(whole) => whole.to_string(),
                Err(_) => format!("{:?}", word.parse::<f64>().expect("a number")),
            }),
            "constant.language" | "variable.other" | "string.unquoted" | "string.quoted.double" => {
                values.push(quoted());
            }
            other => panic!("`{word}` is {other}"),
        }
    }
    end(&mut text, &mut values);
    text
}

/// Returns a scene, written again from what the reader understood.
fn read(path: &Path, name: &str, text: &str) -> String {
    let folder = path.parent().expect("a folder");
    match scene::read(registry(), name, folder, text.as_bytes(), None) {
        Ok(loaded) => dump::scene(&loaded.model, Syntax::Notes),
        Err(report) => panic!("{}: {report}\n{text}", path.display()),
    }
}

#[test]
fn a_scene_read_by_its_colours_is_the_same_scene() {
    let highlighter = Highlighter::new();
    let in_notes = scenes().into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "ray"));
    for path in in_notes.chain([root().join("src/cli/new/templates/scene.ray")]) {
        let text = fs::read_to_string(&path).expect("a scene");
        let scoped = highlighter.scopes(&text);
        // What is computed has no entities to be compared word by word, and a word on several lines is in several pieces.
        if scoped.iter().any(|(scope, _)| scope.starts_with("keyword.")) || text.contains("\\\n") {
            continue;
        }
        let understood = scene_of(&scoped);
        assert_eq!(
            read(&path, "scene.toml", &understood),
            read(&path, "scene.ray", &text),
            "{}",
            path.display()
        );
    }
}

#[test]
fn words_are_what_they_are_wherever_they_stand() {
    let text = "material material{ambient +.5 1. 1e-3# dim\n}sphere \"a # b\"#c\n{ radius # 7\n 2material\n material}";
    let scoped = Highlighter::new().scopes(text);
    let shown: Vec<_> =
        scoped.iter().map(|(scope, word)| format!("{word} {}", &scope[..scope.len() - 7])).collect();
    assert_eq!(
        shown,
        [
            "material storage.type",
            "material entity.name.type",
            "ambient support.type.property-name",
            "+.5 constant.numeric",
            "1. constant.numeric",
            "sphere storage.type",
            "\"a # b\" entity.name.type",
            "#c comment.line.number-sign",
            "radius support.type.property-name",
            "# 7 comment.line.number-sign",
            "material support.type.property-name",
        ]
    );
}

#[test]
fn what_is_computed_has_its_colours_and_entities_in_it_have_theirs() {
    let text = "let r \"2*pi\" # two\nlet n 3\ninclude a.inc include \"b c\"\n\
                repeat i \"n\" {\n repeat j 2 { sphere s { radius \"r\" } }\n gem g { } }\nsphere t { }";
    let scoped = Highlighter::new().scopes(text);
    let shown: Vec<_> = scoped.iter().map(|(scope, word)| format!("{word} {}", &scope[..7])).collect();
    assert_eq!(
        shown,
        [
            "let keyword",
            "r entity.",
            "\"2*pi\" string.",
            "# two comment",
            "let keyword",
            "n entity.",
            "3 constan",
            "include keyword",
            "a.inc string.",
            "include keyword",
            "\"b c\" string.",
            "repeat keyword",
            "i entity.",
            "\"n\" string.",
            "repeat keyword",
            "j entity.",
            "2 constan",
            "sphere storage",
            "s entity.",
            "radius support",
            "\"r\" string.",
            "g entity.",
            "sphere storage",
            "t entity.",
        ]
    );
}

#[test]
fn a_formula_on_several_lines_ends_where_its_quote_does() {
    let text = "implicit egg { formula \"x^2 \\\n + y \\\n - 1\" box -1 -1 -1 1 1 1 }\nlet r \"2 \\\n*pi\" sphere s { }";
    let scoped = Highlighter::new().scopes(text);
    let shown: Vec<_> = scoped.iter().map(|(scope, word)| format!("{word} {}", &scope[..6])).collect();
    let numbers = ["-1 consta"; 3].into_iter().chain(["1 consta"; 3]);
    let before = ["implicit storag", "egg entity", "formula suppor", "\" string", "\" string", "box suppor"];
    let after = ["let keywor", "r entity", "\" string", "\" string", "sphere storag", "s entity"];
    assert_eq!(shown, before.into_iter().chain(numbers).chain(after).collect::<Vec<_>>());
}

#[test]
fn a_type_that_came_later_leaves_the_rest_as_it_is() {
    let scoped = Highlighter::new().scopes("gem it { size 2 material red } light lamp { }");
    let shown: Vec<_> = scoped.iter().map(|(_, word)| word.as_str()).collect();
    assert_eq!(shown, ["it", "2", "light", "lamp"]);
}
