//! The programs with supported files.

use std::path::Path;

/// A program with supported files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Program {
    /// SURFER, with files of properties.
    Surfer,
    /// surf, with scripts.
    Surf,
}

impl Program {
    /// Recognises a file by the extension of its name.
    pub fn of_name(name: &str) -> Option<Self> {
        let ending = Path::new(name).extension()?.to_str()?;
        let is = |known: &str| ending.eq_ignore_ascii_case(known);
        if is("jsurf") { Some(Self::Surfer) } else { (is("surf") || is("pic")).then_some(Self::Surf) }
    }

    /// Recognises a file by words in its text that scenes do not have.
    pub fn of_text(text: &str) -> Option<Self> {
        let has = |word: &str| text.lines().any(|line| line.trim_start().starts_with(word));
        if has("surface_equation") {
            Some(Self::Surfer)
        } else {
            (has("draw_surface") && text.contains(';')).then_some(Self::Surf)
        }
    }

    pub fn what(self) -> &'static str {
        match self {
            Self::Surfer => "a surface of SURFER",
            Self::Surf => "a script of surf",
        }
    }
}

/// Returns a description of a file, if it is from one of these programs.
pub(crate) fn what(name: &str, text: &str) -> Option<&'static str> {
    Program::of_name(name).or_else(|| Program::of_text(text)).map(Program::what)
}
