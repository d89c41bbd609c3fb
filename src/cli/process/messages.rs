//! Messages on standard error, in the form that was asked for.

use annotate_snippets::{Group, Level, Renderer};
use anstream::AutoStream;
use std::io::{self, Write};
use std::sync::OnceLock;
use tabray_core::text;
use tabray_lang::reader::{Message, Report};
use tabray_tools::diagnosis::Remark;

/// The form of messages.
#[derive(Clone, Copy, Default, PartialEq, clap::ValueEnum)]
pub enum Form {
    /// For people: with the lines of the scene that they are about
    #[default]
    Human,
    /// For editors: one message per line, `FILE:LINE:COLUMN: error: MESSAGE`
    Short,
    /// For programs: one JSON object per line
    Json,
}

/// Which messages are printed.
#[derive(Clone, Copy, Default, PartialEq)]
pub enum Verbosity {
    /// All of them.
    #[default]
    All,
    /// Errors and warnings.
    ErrorsAndWarnings,
    /// Errors alone.
    Errors,
}

/// The form of messages, and which of them are printed.
static CHOSEN: OnceLock<(Form, Verbosity)> = OnceLock::new();

/// Sets the form of all later messages, and which of them are printed.
pub fn choose(form: Form, verbosity: Verbosity) {
    CHOSEN.get_or_init(|| (form, verbosity));
}

fn verbosity() -> Verbosity {
    CHOSEN.get().copied().unwrap_or_default().1
}

fn form() -> Form {
    CHOSEN.get().copied().unwrap_or_default().0
}

/// Tells whether at most errors and warnings are printed.
pub fn is_quiet() -> bool {
    verbosity() != Verbosity::All
}

/// Prints the warnings about a scene that has no errors.
pub fn warnings(warnings: &Report) {
    if verbosity() != Verbosity::Errors {
        report(warnings);
    }
}

/// Prints the faults of a scene.
pub fn report(report: &Report) {
    say(&match form() {
        Form::Human => report.styled(),
        Form::Short => report.short(),
        Form::Json => report.json(),
    });
}

/// Prints an error that is no fault of a scene, with a cure where there is one.
pub fn error(message: &str, help: Option<&str>) {
    titled("error", Level::ERROR, message, help);
}

/// Prints a warning about an image, and what the user can do about it.
pub fn warning(message: &str, help: Option<&str>) {
    if verbosity() != Verbosity::Errors {
        titled("warning", Level::WARNING, message, help);
    }
}

/// Prints the remarks on an image, if there are any.
pub fn remark(remark: Option<Remark>) {
    if let Some(Remark { message, help }) = remark.filter(|_| !is_quiet()) {
        warning(&message, Some(&help));
    }
}

fn titled(word: &str, level: Level, message: &str, help: Option<&str>) {
    let (message, help) = (&*text::visible_lines(message), help.map(text::visible_lines));
    let help = help.as_deref();
    let rendered = |renderer: Renderer| {
        let help = help.map(|help| Level::HELP.message(help));
        renderer.render(&[Group::with_title(level.clone().primary_title(message)).elements(help)])
    };
    say(&match form() {
        Form::Human => rendered(Renderer::styled()) + "\n",
        Form::Short => format!("{word}: {message}\n"),
        Form::Json => json(word, message, help, &rendered(Renderer::plain())),
    });
}

/// Prints a note: that something went well, or how it ended.
pub fn note(message: &str) {
    if is_quiet() {
        return;
    }
    let message = &*text::visible_lines(message);
    say(&match form() {
        Form::Human | Form::Short => format!("{message}\n"),
        Form::Json => json("note", message, None, message),
    });
}

fn json(level: &str, message: &str, help: Option<&str>, rendered: &str) -> String {
    Message { help, level, message, rendered, spans: Vec::new() }.line()
}

/// Writes a message in one piece, whatever else is written there. If standard error is closed, no one can be told.
fn say(text: &str) {
    let stderr = io::stderr();
    let mut said = AutoStream::new(Vec::new(), AutoStream::choice(&stderr));
    let _ = said.write_all(text.as_bytes()).and_then(|()| stderr.lock().write_all(&said.into_inner()));
}
