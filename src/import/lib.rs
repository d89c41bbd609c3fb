//! Imports surfaces from files of other programs: SURFER's `.jsurf`, and the scripts of surf 1.0.6. Such a file becomes
//! a scene in the notes' syntax: the unchanged formula with its parameters, seen from the same side, cut by the same
//! body, and in the same colours.

mod expression;
mod jsurf;
mod notes;
mod picture;
mod surf;
#[cfg(test)]
mod tests;

use notes::Notes;
use picture::Picture;
use std::collections::BTreeSet;
use tabray_lang::Syntax;
use tabray_lang::import::{Imported, Program};
use tabray_lang::reader::Report;

inventory::submit! {
    Program {
        what: SURFER,
        cure: CURE,
        extensions: &["jsurf"],
        has_written: |text| has(text, "surface_equation"),
        read: |name, text| read(SURFER, jsurf::read, name, text),
    }
}

inventory::submit! {
    Program {
        what: SURF,
        cure: CURE,
        extensions: &["surf", "pic"],
        has_written: |text| has(text, "draw_surface") && text.contains(';') && !has(text, "surface_equation"),
        read: |name, text| read(SURF, surf::read, name, text),
    }
}

const SURFER: &str = "a surface of SURFER";
const SURF: &str = "a script of surf";
const CURE: &str = "`tabray convert` writes it as one: give it this file, and a name that ends in .ray";

/// Links these programs. For most systems, `use tabray_import as _;` does that alone; for WebAssembly, a program calls
/// this.
#[inline(never)]
pub fn link() {}

/// Returns whether a line begins with a word.
fn has(text: &str, word: &str) -> bool {
    text.lines().any(|line| line.trim_start().starts_with(word))
}

fn read(
    what: &str,
    picture: fn(&str, &mut Notes) -> Option<Picture>,
    name: &str,
    text: &str,
) -> Result<Imported, Report> {
    let mut notes = Notes { report: Report::new(name, text.to_owned(), Syntax::Notes), left: Vec::new() };
    let read = picture(text, &mut notes);
    let Notes { report, left } = notes;
    let picture = match read {
        Some(picture) if !report.is_fatal() => picture,
        _ => return Err(report),
    };
    let (mut lines, mut known) = (Vec::new(), BTreeSet::new());
    let ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    for (word, at) in left {
        if known.insert(word.clone()) {
            lines.push((word, 1 + ends.partition_point(|end| *end < at)));
        }
    }
    let mut head = format!("# Written by `tabray convert` from {what}.\n");
    if !lines.is_empty() {
        let words: Vec<_> = lines.iter().map(|(word, line)| format!("{word} (line {line})")).collect();
        head += &format!("# Left out: {}.\n", words.join(", "));
    }
    Ok(Imported { text: head + &picture.scene(), warnings: report, left: lines })
}

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
