//! Keywords: words that begin a statement other than an entity.

/// A word that begins a statement other than an entity.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Keyword {
    /// Names a number.
    Let,
    /// Repeats entities.
    Repeat,
    /// Includes a file.
    Include,
}

impl Keyword {
    /// Returns the keyword for a word.
    #[inline]
    pub fn of(word: &str) -> Option<Self> {
        match word {
            "let" => Some(Self::Let),
            "repeat" => Some(Self::Repeat),
            "include" => Some(Self::Include),
            _ => None,
        }
    }

    /// Returns the notation of the statement in the notes' syntax.
    pub fn usage(self) -> &'static str {
        match self {
            Self::Let => "write `let NAME VALUE`, where the value is a number or a formula in quotes",
            Self::Repeat => "write `repeat NAME COUNT { ENTITIES }`",
            Self::Include => "write `include FILE`",
        }
    }

    /// Returns the notation of the statement in TOML.
    pub fn usage_in_toml(self) -> &'static str {
        match self {
            Self::Let => {
                "write `[let]`, followed by `NAME = VALUE`, where the value is a number or a formula in quotes"
            }
            Self::Repeat => {
                "write `[repeat.NAME]`, followed by `count = COUNT`, and its entities as `[repeat.NAME.TYPE.NAME]`"
            }
            Self::Include => {
                "write `include = \"FILE\"` before the first table, or several files in brackets"
            }
        }
    }
}
