//! `--color`: whether messages have colours.

use anstream::ColorChoice;
use std::ffi::OsString;

/// The rule by which messages have colours.
#[derive(Clone, Copy, Default, PartialEq, clap::ValueEnum)]
pub enum Color {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    /// Always, also in a file or a pipe
    Always,
    /// Never
    Never,
}

/// Sets whether all later messages have colours.
pub fn choose(color: Color) {
    match color {
        Color::Auto => ColorChoice::Auto,
        Color::Always => ColorChoice::Always,
        Color::Never => ColorChoice::Never,
    }
    .write_global();
}

/// Sets it as the words of a command line ask for, for messages about them.
pub fn choose_early(words: &[OsString]) {
    let words: Vec<_> = words.iter().filter_map(|word| word.to_str()).collect();
    let has = |choice: &str| {
        words.contains(&format!("--color={choice}").as_str())
            || words.windows(2).any(|pair| pair == ["--color", choice])
    };
    if has("never") {
        choose(Color::Never);
    } else if has("always") {
        choose(Color::Always);
    }
}
