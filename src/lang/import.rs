//! Files of other programs, from which [`scene`] makes scenes. Each program registers itself.

use crate::reader::{Report, decode};
use std::path::Path;

/// A program with supported files.
pub struct Program {
    /// A description of its files, such as `a surface of SURFER`.
    pub what: &'static str,
    /// What makes a scene of such a file, for who gives it in place of one.
    pub cure: &'static str,
    /// The extensions of its files, in small letters.
    pub extensions: &'static [&'static str],
    /// Recognises a file by words in its text that neither scenes nor files of other programs have.
    pub has_written: fn(&str) -> bool,
    /// Converts a file with this name in messages and this text, or returns its errors.
    pub read: fn(&str, &str) -> Result<Imported, Report>,
}

inventory::collect!(Program);

/// The contents of another program's file.
pub struct Imported {
    /// The scene, in the notes' syntax.
    pub text: String,
    /// The differences in the scene's appearance.
    pub warnings: Report,
    /// The words that do not affect the picture, in the order of the file, each with the line of its first occurrence.
    pub left: Vec<(String, usize)>,
}

impl Program {
    /// Recognises a file by the extension of its name.
    fn of_name(name: &str) -> Option<&'static Self> {
        let ending = Path::new(name).extension()?.to_str()?;
        let is = |known: &&str| ending.eq_ignore_ascii_case(known);
        inventory::iter::<Self>().find(|program| program.extensions.iter().any(is))
    }

    /// Recognises a file by its text.
    fn of_text(text: &str) -> Option<&'static Self> {
        inventory::iter::<Self>().find(|program| (program.has_written)(text))
    }
}

/// Returns the program that a file is from, if it is one of these.
pub(crate) fn program(name: &str, text: &str) -> Option<&'static Program> {
    Program::of_name(name).or_else(|| Program::of_text(text))
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
    by_name.or_else(|| Program::of_text(text)).map(|program| (program.read)(name, text)).transpose()
}
