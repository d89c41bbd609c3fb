//! Parses scenes in TOML: long ones in parallel parts, and those with syntax errors in pieces.

use super::fault::{Fault, Place, Severity};
use super::report::Report;
use super::statement::Statement;
use super::toml_document::Reader;
use super::toml_faults::{LINE, is_duplicate, is_title, long_line, parts, pieces};
use crate::registry::Registry;
use crate::syntax::Syntax;
use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;
use std::sync::OnceLock;
use tabray_core::parallel;
use toml::de::DeTable;

/// Parses a text from `start` to its end, and reports syntax errors. Parsing continues after an error, so that one run
/// finds further errors.
pub fn parse<'a>(
    registry: &Registry,
    text: &'a str,
    start: usize,
    report: &mut Report<'_>,
) -> Vec<Statement<'a>> {
    let text = &text[start..];
    let placed = |place: Range<usize>| start + place.start..start + place.end;
    if let Some(place) = long_line(text) {
        let message = format!("this line is {} bytes long", place.len());
        let help = format!("a line of a scene in TOML is at most {LINE} bytes long");
        report.add(Fault::error(Some(placed(place)), message).help(help));
        return Vec::new();
    }
    let outcome = in_parts(text, start);
    if let Outcome::Statements(statements) = outcome {
        return statements;
    }
    let mut parsed = Vec::new();
    if matches!(outcome, Outcome::OfOne) {
        let (document, errors) = DeTable::parse_recoverable(text);
        if document.get_ref().is_empty()
            && let Some(first) = errors.first()
        {
            let place = placed(first.span().unwrap_or(0..0));
            let fault = Fault::error(Some(place), "this is not a scene in TOML");
            report.add(fault.help(registry.first_steps(Syntax::Toml)));
            return Vec::new();
        }
        if errors.iter().all(is_duplicate) {
            Reader::new((text, start), &errors, report, &mut parsed).read(document);
            parsed.sort_by_key(Statement::start);
            return parsed;
        }
    }
    // After an unclosed bracket, nothing can be parsed. Parsing starts again at the next title.
    for piece in pieces(text) {
        if report.has_enough() {
            break;
        }
        let at = start + piece.start;
        let text = &text[piece];
        let (document, errors) = DeTable::parse_recoverable(text);
        Reader::new((text, at), &errors, report, &mut parsed).read(document);
    }
    parsed.sort_by_key(Statement::start);
    parsed
}

/// The result of parsing a text in parts.
enum Outcome<'a> {
    /// The statements of a text without syntax errors and with independent parts.
    Statements(Vec<Statement<'a>>),
    /// The text must be parsed as a whole: it is short, or its parts may depend on each other.
    OfOne,
    /// A part has syntax errors.
    Broken,
}

/// Parses a text that begins at `start`, if it is long enough to have parts.
fn in_parts(text: &str, start: usize) -> Outcome<'_> {
    let parts = parts(text);
    if parts.len() == 1 {
        return Outcome::OfOne;
    }
    let parsed: Vec<_> = parts.iter().map(|_| OnceLock::new()).collect();
    let is_broken = |index: usize| {
        let outcome = one(text, parts[index].clone(), start);
        let is_broken = matches!(outcome, Outcome::Broken);
        let _ = parsed[index].set(outcome);
        is_broken
    };
    if parallel::find_first(parts.len(), is_broken).is_some() {
        return Outcome::Broken;
    }
    let mut all = Vec::with_capacity(parsed.len());
    for outcome in parsed {
        match outcome.into_inner() {
            Some(Outcome::Statements(statements)) => all.push(statements),
            _ => return Outcome::OfOne,
        }
    }
    if depend_on_each_other(&all) {
        Outcome::OfOne
    } else {
        Outcome::Statements(all.into_iter().flatten().collect())
    }
}

/// The parts of a long text that can be parsed independently.
pub struct IndependentParts {
    /// The ranges of the parts in the text, in bytes.
    pub ranges: Vec<Range<usize>>,
    /// The numbers that the parts define, with their places.
    pub numbers: HashMap<String, Place>,
}

/// Finds the parts of a text, if it is long, and all parts are valid and independent of each other.
pub fn independent_parts(text: &str) -> Option<IndependentParts> {
    let ranges = if long_line(text).is_none() { parts(text) } else { Vec::new() };
    if ranges.len() <= 1 {
        return None;
    }
    // Equal hashes count as equal names. A coincidence costs memory, and nothing else.
    let named = |part: usize| {
        let Outcome::Statements(statements) = one(text, ranges[part].clone(), 0) else { return None };
        let numbers: Vec<_> = statements.iter().filter_map(Statement::number).collect();
        let hashes = statements.iter().filter_map(name).map(|name| {
            let mut hasher = DefaultHasher::new();
            name.hash(&mut hasher);
            hasher.finish()
        });
        Some((hashes.collect::<HashSet<u64>>(), numbers))
    };
    let found: Vec<_> = parallel::map(ranges.len(), named).into_iter().collect::<Option<_>>()?;
    let (mut known, mut numbers) = (HashSet::new(), HashMap::new());
    for (hashes, of_part) in found {
        if hashes.into_iter().any(|hash| !known.insert(hash)) {
            return None;
        }
        numbers.extend(of_part);
    }
    Some(IndependentParts { ranges, numbers })
}

/// Parses an independent part of a text.
pub fn part(text: &str, part: Range<usize>) -> Vec<Statement<'_>> {
    match one(text, part, 0) {
        Outcome::Statements(statements) => statements,
        _ => Vec::new(),
    }
}

/// Returns the type and the name of a statement that other parts may also have. Named numbers and `include` come before
/// the first title.
fn name<'s>(statement: &'s Statement<'_>) -> Option<(&'s str, &'s str)> {
    match statement {
        Statement::Entity(entity) => Some((entity.kind.text.as_ref(), entity.name.text.as_ref())),
        Statement::Repeat { name, .. } => Some(("repeat", name.text.as_ref())),
        Statement::Let { .. } | Statement::Include { .. } => None,
    }
}

/// Parses one part of a text.
fn one(text: &str, part: Range<usize>, start: usize) -> Outcome<'_> {
    let (at, text) = (part.start, &text[part]);
    let (document, errors) = DeTable::parse_recoverable(text);
    if !errors.iter().all(is_duplicate) {
        return Outcome::Broken;
    }
    // A part continues the one before, unless it begins with a title. Titles of one word may be repeated in other
    // parts.
    let has_own_title = at == 0 || text.lines().next().is_some_and(is_title);
    let is_whole = |line: &str| !line.trim_start().starts_with('[') || is_title(line);
    if !errors.is_empty() || !has_own_title || !text.lines().all(is_whole) {
        return Outcome::OfOne;
    }
    let (mut report, mut statements) = (Report::default(), Vec::new());
    Reader::new((text, start + at), &[], &mut report, &mut statements).read(document);
    if report.count(Severity::Error) + report.count(Severity::Warning) > 0 {
        return Outcome::OfOne;
    }
    statements.sort_by_key(Statement::start);
    Outcome::Statements(statements)
}

/// Tells whether two parts use the same name, either for several entities or as a duplicate.
fn depend_on_each_other(parts: &[Vec<Statement<'_>>]) -> bool {
    let mut known = HashMap::new();
    for (index, part) in parts.iter().enumerate() {
        for name in part.iter().filter_map(name) {
            if *known.entry(name).or_insert(index) != index {
                return true;
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a scene of about 2,500 spheres, in several parts, between a beginning and an end.
    fn long(first: &str, last: &str) -> String {
        let ball = |index| {
            format!("[sphere.ball_{index}] # a title\ncenter = [{index}, 0.5, -4]\n# radius\nradius = 2\n\n")
        };
        let text = format!("{first}\n{}{last}\n", (0..2500).map(ball).collect::<String>());
        assert!(parts(&text).len() > 1);
        text
    }

    fn told(statements: &[Statement<'_>]) -> Vec<String> {
        let told = |statement: &Statement<'_>| match statement {
            Statement::Entity(entity) => format!("{entity:?}"),
            Statement::Let { name, value } => format!("let {name:?} {value:?}"),
            Statement::Include { file } => format!("include {file:?}"),
            Statement::Repeat { name, count, body, .. } => {
                format!("repeat {name:?} {count:?} {:?}", told(body))
            }
        };
        statements.iter().map(told).collect()
    }

    fn at_once(text: &str) -> Vec<String> {
        let (mut report, mut statements) = (Report::default(), Vec::new());
        let (document, errors) = DeTable::parse_recoverable(text);
        Reader::new((text, 0), &errors, &mut report, &mut statements).read(document);
        statements.sort_by_key(Statement::start);
        told(&statements)
    }

    #[test]
    fn parts_say_what_the_whole_says() {
        for (first, last) in [
            ("", ""),
            (
                "include = [\"a.toml\"]\nlet.height = 2\nsphere.own = { radius = 1 }\n",
                "[[light.lamp]]\nlocation = [0, 1, 2]\n",
            ),
            ("\u{feff}", "[repeat.i]\ncount = 3\n[repeat.i.sphere.again]\nradius = \"i\"\n"),
        ] {
            let text = long(first, last);
            let Outcome::Statements(statements) = in_parts(&text, 0) else {
                panic!("{first} {last}: no parts")
            };
            assert_eq!(told(&statements), at_once(&text));
        }
    }

    #[test]
    fn parts_that_depend_on_each_other_are_parsed_as_one() {
        for (first, last) in [
            // Several entities share a name, and there are duplicates of various forms.
            ("[[light.lamp]]\nlocation = [0, 1, 2]", "[[light.lamp]]\nlocation = [0, 1, 3]"),
            ("[sphere.one]\nradius = 1", "[sphere.one]\nradius = 1"),
            ("sphere.one.radius = 1", "[sphere.one]\nradius = 1"),
            ("[sphere]\none = { radius = 1 }", "[sphere]\ntwo = { radius = 1 }"),
            ("let.height = 1", "[let]\nwidth = 1"),
            ("[repeat.i]\ncount = 3", "[repeat.i.sphere.again]\nradius = 1"),
            // Reading these parts finds an error.
            ("heart = 1", ""),
            ("", "[sphere.x]\nradius = 1979-05-27"),
        ] {
            assert!(matches!(in_parts(&long(first, last), 0), Outcome::OfOne), "{first} {last}");
        }
        let text = long("[sphere.broken]\nradius = ", "");
        assert!(matches!(in_parts(&text, 0), Outcome::Broken));
        assert!(matches!(in_parts("[sphere.short]", 0), Outcome::OfOne));
    }
}
