//! Opens files that a scene or a command names; the path may lead to something else than a file.

use std::fs::{self, File};
use std::io::{self, BufRead, Seek};
use std::path::{Component, Path, PathBuf};

/// The bytes of an image's file. Decoders are given a `&mut dyn` of it, so that each is compiled once.
pub trait ImageBytes: BufRead + Seek {}

impl<B: BufRead + Seek> ImageBytes for B {}

/// Opens a file to read it. Refuses a pipe, at which opening might wait for ever, and a device, which might have no
/// end.
///
/// # Errors
/// Those of the system, and an error where the path does not lead to a file.
pub fn open(path: &Path) -> io::Result<File> {
    let kind = fs::metadata(path)?;
    if kind.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !kind.is_file() {
        return Err(io::Error::other("it is a pipe or a device, not a file"));
    }
    File::open(path)
}

/// Returns a path without `..` where the folder before it is named.
pub fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if matches!(plain.components().next_back(), Some(Component::Normal(_))) => {
                plain.pop();
            }
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}
