//! What the program is called, and its command line under that name.

use crate::scene::registry::Registry;
use clap::Command;
use clap::builder::{PossibleValue, PossibleValuesParser};
use std::env::{self, consts};
use std::path::Path;
use std::sync::LazyLock;

/// The name of the library, and of the program that has no plugins but its own.
const LIBRARY: &str = env!("CARGO_PKG_NAME");

static NAME: LazyLock<String> = LazyLock::new(|| {
    let started = env::args_os().next().unwrap_or_default();
    let file = Path::new(&started).file_name().map(|name| name.to_string_lossy().into_owned());
    let file = file.unwrap_or_else(|| LIBRARY.to_owned());
    file.strip_suffix(consts::EXE_SUFFIX).unwrap_or(&file).to_owned()
});

/// The name of the file that runs: `tabray`, or that of a program with more plugins.
pub fn name() -> &'static str {
    &NAME
}

/// A command line under that name. A program of another name tells the library that it is built on by its version.
pub fn named(command: Command) -> Command {
    if name() == LIBRARY {
        return command;
    }
    command.name(name()).version(concat!("(", env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"), ")"))
}

/// The command line for shells and manuals, which want to know the entity types too. The program itself takes any word
/// and says which was meant.
pub fn described(command: Command, registry: &Registry) -> Command {
    let types = registry.iter().map(|entity| PossibleValue::new(entity.name).help(entity.meaning));
    let types = PossibleValuesParser::new(types);
    command.mut_subcommand("list", |list| list.mut_arg("entity", |entity| entity.value_parser(types)))
}
