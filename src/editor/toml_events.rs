//! The events of toml_parser in a text, and syntax errors.

use std::ops::Range;
use tabray_lang::reader::{Fault, LINE, long_line};
use toml_parser::parser::{Event, EventKind, RecursionGuard, parse_document};
use toml_parser::{ParseError, Source, Span};

/// The maximum depth of nested arrays and tables.
const DEEPEST: u32 = 64;

/// Returns the events of a text, and its syntax errors.
pub fn events(text: &str) -> (Vec<Event>, Vec<Fault>) {
    let tokens = Source::new(text).lex().into_vec();
    let (mut events, mut errors) = (Vec::new(), Vec::<ParseError>::new());
    {
        let mut receiver = |event: Event| events.push(event);
        let mut guard = RecursionGuard::new(&mut receiver, DEEPEST);
        parse_document(&tokens, &mut guard, &mut errors);
    }
    (events, errors.iter().map(fault).collect())
}

/// Returns an error within a key, a value, a comment or a line end, which the events do not show.
pub fn wrong_word(text: &str, events: &[Event]) -> Option<Fault> {
    if let Some(line) = long_line(text) {
        return Some(Fault::error(Some(line), format!("this line is longer than {LINE} bytes")));
    }
    let source = Source::new(text);
    events.iter().find_map(|event| {
        let (word, mut first) = (source.get(event)?, None);
        let mut note = |error: ParseError| {
            let _ = first.get_or_insert(error);
        };
        match event.kind() {
            EventKind::SimpleKey => word.decode_key(&mut (), &mut note),
            EventKind::Scalar => drop(word.decode_scalar(&mut (), &mut note)),
            EventKind::Comment => word.decode_comment(&mut note),
            EventKind::Newline => word.decode_newline(&mut note),
            _ => {}
        }
        first.map(|error| fault(&error))
    })
}

fn fault(error: &ParseError) -> Fault {
    let place = error.unexpected().or(error.context()).map_or(0..0, range);
    Fault::error(Some(place), error.description())
}

fn range(span: Span) -> Range<usize> {
    span.start()..span.end().max(span.start())
}
