//! Parses the command line. If that fails, the message says what the user probably meant.

use crate::process::failure::Failure;
use crate::process::{color, help, program};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgMatches, Command};
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::Path;
use std::process;
use tabray_core::text::{is_unseen, nearest, quoted, visible_lines};
use tabray_lang::syntax::Syntax;

/// Parses the program's arguments. What is wrong with them is printed, and ends the program; so do `--help` and
/// `--version`.
pub fn matches(command: Command) -> Result<ArgMatches, Failure> {
    let words: Vec<_> = wild::args_os().collect();
    let is_first_help = words.len() == 2 && ["help", "-h"].iter().any(|word| words[1] == *word);
    let command = if is_first_help { help::on_one_screen(command) } else { command };
    // It is never freed: to free all that it says of each option takes a tenth of the start of the program.
    let command = Box::leak(Box::new(command));
    let words = joined(command, words);
    color::choose_early(&words);
    let mut error = match command.try_get_matches_from_mut(&words) {
        Ok(matches) => return Ok(matches),
        Err(error) => error,
    };
    let given = |kind| match error.get(kind) {
        Some(ContextValue::String(word)) => Some(word.clone()),
        _ => None,
    };
    let without_command = chosen(command, &words).get_name() == command.get_name();
    let scene = match error.kind() {
        ErrorKind::InvalidSubcommand => given(ContextKind::InvalidSubcommand),
        // An option of `render`, before the scene.
        ErrorKind::UnknownArgument if without_command => words
            .iter()
            .skip(1)
            .filter_map(|word| word.to_str())
            .find(|word| is_scene(word))
            .map(str::to_owned),
        _ => None,
    };
    if let Some(scene) = scene.filter(|word| is_scene(word)) {
        let line = format!("{} render {}", program::name(), quoted(scene.as_ref()));
        let message = format!("`{scene}` is a scene, not a command");
        return Err(Failure::usage(message).help(format!("`{line}` renders it")));
    }
    let near = given(ContextKind::InvalidArg).filter(|_| error.kind() == ErrorKind::UnknownArgument);
    let near = near.and_then(|option| {
        let name = option.strip_prefix("--")?.split('=').next()?;
        // Of options that are equally near, the first in the help is taken.
        let known = chosen(command, &words).get_arguments().filter_map(Arg::get_long);
        nearest(name, known).map(|near| format!("--{near}"))
    });
    if let Some(near) = near {
        error.insert(ContextKind::SuggestedArg, ContextValue::String(near));
        // It shows the option that clap would guess.
        error.remove(ContextKind::Usage);
    }
    if !error.use_stderr() {
        // clap does not report a failure to write to standard output.
        match error.print().and_then(|()| io::stdout().flush()) {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                return Err(Failure::cannot_write(Path::new("-"), &error));
            }
            _ => process::exit(error.exit_code()),
        }
    }
    let plain = error.render().to_string();
    if plain.contains(|letter| letter != '\n' && is_unseen(letter)) {
        let _ = write!(io::stderr(), "{}", visible_lines(&plain));
        process::exit(error.exit_code());
    }
    error.exit()
}

/// Joins an option and a value that begins with a minus and a digit, as in `--samples -1`, to one word: otherwise clap
/// takes the value for an option, and does not say what would be right. So are options that can do without a value, as in
/// `--stats json`: by themselves they take none, so that in `--stats ball.ray` the scene is one.
fn joined(command: &Command, words: Vec<OsString>) -> Vec<OsString> {
    let chosen = chosen(command, &words);
    let named = |word: &OsString| {
        let name = word.to_str()?.strip_prefix("--")?;
        // Those of all commands are at the top.
        let all = chosen.get_arguments().chain(command.get_arguments());
        let mut known = all.filter(|arg| arg.get_action().takes_values());
        known.find(|arg| arg.get_long() == Some(name))
    };
    let is_optional = |arg: &Arg, word: &OsString| {
        let mut values = arg.get_possible_values().into_iter();
        arg.is_require_equals_set() && values.any(|value| word.to_str() == Some(value.get_name()))
    };
    let is_negative = |word: &OsString| {
        let bytes = word.as_encoded_bytes();
        bytes.first() == Some(&b'-') && bytes.get(1).is_some_and(u8::is_ascii_digit)
    };
    let mut joined: Vec<OsString> = Vec::new();
    for word in words {
        match joined.last_mut() {
            Some(option)
                if named(option).is_some_and(|arg| is_negative(&word) || is_optional(arg, &word)) =>
            {
                option.push("=");
                option.push(word);
            }
            _ => joined.push(word),
        }
    }
    joined
}

/// Tells whether a word in the place of a command names a scene.
fn is_scene(word: &str) -> bool {
    let extension = Path::new(word).extension().and_then(|extension| extension.to_str());
    extension
        .is_some_and(|extension| ["ray", "toml"].iter().any(|known| extension.eq_ignore_ascii_case(known)))
        || Syntax::of_name(word).is_some() && Path::new(word).is_file()
}

/// Returns the command that the words choose.
fn chosen<'c>(command: &'c Command, words: &[OsString]) -> &'c Command {
    let mut chosen = command;
    for word in words.iter().skip(1).filter_map(|word| word.to_str()) {
        chosen = chosen.find_subcommand(word).unwrap_or(chosen);
    }
    chosen
}
