//! The name of the program, and its command line under that name.

use clap::Command;
use clap::builder::{PossibleValue, PossibleValuesParser};
use std::env::{self, consts};
use std::path::Path;
use std::sync::LazyLock;
use tabray_lang::registry::Registry;

/// The name of the library, and of the program with no plugins but those of the library.
const LIBRARY: &str = "tabray";

static NAME: LazyLock<String> = LazyLock::new(|| {
    let started = env::args_os().next().unwrap_or_default();
    let file = Path::new(&started).file_name().map(|name| name.to_string_lossy().into_owned());
    let file = file.unwrap_or_else(|| LIBRARY.to_owned());
    file.strip_suffix(consts::EXE_SUFFIX).unwrap_or(&file).to_owned()
});

/// Returns the name of the running file: `tabray`, or that of a program with more plugins.
pub fn name() -> &'static str {
    &NAME
}

/// Gives a command line the program's name. The version of a program of another name includes that of the library.
pub fn named(command: Command) -> Command {
    if name() == LIBRARY {
        return command;
    }
    let version = concat!("(tabray ", env!("CARGO_PKG_VERSION"), ")");
    with_named_examples(command).name(name()).version(version)
}

/// Gives the examples of a command and of its subcommands the program's name.
fn with_named_examples(command: Command) -> Command {
    let help = command.get_after_long_help().map(ToString::to_string);
    let command = command.mut_subcommands(with_named_examples);
    match help {
        Some(help) => command.after_long_help(help.replace("tabray ", &format!("{} ", name()))),
        None => command,
    }
}

/// Returns the command line for shells and manuals, with the entity types as possible values. The program itself
/// accepts any word, and says which type was probably meant.
pub fn described(command: Command, registry: &Registry) -> Command {
    let types = registry.iter().map(|entity| PossibleValue::new(entity.name).help(entity.meaning));
    let types = PossibleValuesParser::new(types);
    command.mut_subcommand("list", |list| list.mut_arg("entity", |entity| entity.value_parser(types)))
}
