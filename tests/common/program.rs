//! Runs the program as users do.

use super::root;
use assert_cmd::Command;
use assert_cmd::cargo::cargo_bin_cmd;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Returns a command that runs the program in this working directory.
pub fn tabray(folder: &TempDir) -> Command {
    let mut command = cargo_bin_cmd!("tabray");
    command.current_dir(folder.path());
    command
}

/// Returns the path of a scene in `scenes/`.
pub fn scene(name: &str) -> PathBuf {
    root().join("scenes").join(name)
}

/// Makes a new working directory.
pub fn folder() -> TempDir {
    TempDir::new().expect("a folder")
}

/// Returns the names of a folder's entries, sorted.
pub fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Runs a command; returns its exit status, standard output and standard error.
pub fn outcome(command: &mut Command) -> (i32, Vec<u8>, String) {
    let output = command.output().expect("the program runs");
    (output.status.code().unwrap_or(-1), output.stdout, String::from_utf8_lossy(&output.stderr).into_owned())
}
