//! Imports surfaces from files of other programs: SURFER's `.jsurf`, and the scripts of surf 1.0.6. [`scene`] converts
//! such a file to a scene in the notes' syntax: the unchanged formula with its parameters, seen from the same side, cut
//! by the same body, and in the same colours.

mod expression;
mod jsurf;
mod notes;
mod picture;
pub(crate) mod program;
mod surf;
#[cfg(test)]
mod tests;

use crate::reader::{Report, decode};
use crate::syntax::Syntax;
use notes::Notes;
use program::Program;
use std::path::Path;

/// The contents of another program's file.
pub struct Imported {
    /// The scene, in the notes' syntax.
    pub text: String,
    /// The differences in the scene's appearance.
    pub warnings: Report,
    /// The words that do not affect the picture, in the order of the file, each with the line of its first occurrence.
    pub left: Vec<(String, usize)>,
}

/// Converts a file of another program, recognised by its name or, unless the name is that of a scene, by its text.
/// `name` is the file's name in messages.
///
/// # Errors
/// Returns the errors of the file.
pub fn scene(name: &str, bytes: &[u8]) -> Result<Option<Imported>, Report> {
    let by_name = Program::of_name(name);
    if by_name.is_none()
        && ["ray", "toml"].iter().any(|ending| Path::new(name).extension().is_some_and(|own| own == *ending))
    {
        return Ok(None);
    }
    let text = match decode(name, bytes) {
        Ok(text) => text,
        Err(report) => return if by_name.is_some() { Err(report) } else { Ok(None) },
    };
    by_name.or_else(|| Program::of_text(text)).map(|program| read(program, name, text)).transpose()
}

fn read(program: Program, name: &str, text: &str) -> Result<Imported, Report> {
    let mut notes = Notes { report: Report::new(name, text.to_owned(), Syntax::Notes), left: Vec::new() };
    let read = match program {
        Program::Surfer => jsurf::read(text, &mut notes),
        Program::Surf => surf::read(text, &mut notes),
    };
    let Notes { report, left } = notes;
    let picture = match read {
        Some(picture) if !report.is_fatal() => picture,
        _ => return Err(report),
    };
    let mut lines: Vec<(String, usize)> = Vec::new();
    for (word, at) in left {
        if !lines.iter().any(|(known, _)| *known == word) {
            let line = 1 + text[..at].matches('\n').count();
            lines.push((word, line));
        }
    }
    let mut head = format!("# Written by `tabray convert` from {}.\n", program.what());
    if !lines.is_empty() {
        let words: Vec<_> = lines.iter().map(|(word, line)| format!("{word} (line {line})")).collect();
        head += &format!("# Left out: {}.\n", words.join(", "));
    }
    Ok(Imported { text: head + &picture.scene(), warnings: report, left: lines })
}
