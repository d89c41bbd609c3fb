//! Files that a scene names: on disk, or held in memory by a program without a file system, as in a browser.

use super::{open, plain};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError, RwLock};

/// The files that are held.
static ALL: RwLock<BTreeMap<PathBuf, Arc<[u8]>>> = RwLock::new(BTreeMap::new());

/// Holds a file in memory, which replaces a file of the system at this path.
pub fn hold(path: &Path, bytes: Vec<u8>) {
    let mut all = ALL.write().unwrap_or_else(PoisonError::into_inner);
    all.insert(plain(path), bytes.into());
}

/// Returns the path at which the file for a path is held: the path itself, or else its name alone. A file that is
/// held without a folder stands for a file of that name in any folder.
pub fn place(path: &Path) -> Option<PathBuf> {
    let all = ALL.read().unwrap_or_else(PoisonError::into_inner);
    if all.is_empty() {
        return None;
    }
    let places = [Some(plain(path)), path.file_name().map(PathBuf::from)];
    places.into_iter().flatten().find(|place| all.contains_key(place))
}

/// Finds a file that is held.
fn find(path: &Path) -> Option<Arc<[u8]>> {
    let place = place(path)?;
    ALL.read().unwrap_or_else(PoisonError::into_inner).get(&place).cloned()
}

/// A file that a scene names, opened to be read.
pub enum SceneFile {
    /// A file of the system.
    Stored(File),
    /// A file that is held.
    Held(Cursor<Arc<[u8]>>),
}

impl SceneFile {
    /// Opens the file at a path.
    ///
    /// # Errors
    /// Returns the errors of [`open`].
    pub fn open(path: &Path) -> io::Result<Self> {
        match find(path) {
            Some(bytes) => Ok(Self::Held(Cursor::new(bytes))),
            None => open(path).map(Self::Stored),
        }
    }

    /// Returns the length in bytes.
    ///
    /// # Errors
    /// Returns the errors of the system.
    pub fn length(&self) -> io::Result<u64> {
        match self {
            Self::Stored(file) => Ok(file.metadata()?.len()),
            Self::Held(bytes) => Ok(bytes.get_ref().len() as u64),
        }
    }
}

impl Read for SceneFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Stored(file) => file.read(buffer),
            Self::Held(bytes) => bytes.read(buffer),
        }
    }
}

impl Seek for SceneFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Self::Stored(file) => file.seek(to),
            Self::Held(bytes) => bytes.seek(to),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_file_is_found_at_its_path_and_one_without_a_folder_by_its_name() {
        for (path, bytes) in [("held/a/wood.test", "a"), ("held/b/wood.test", "b"), ("grass.test", "c")] {
            hold(Path::new(path), bytes.into());
        }
        for (path, found) in [
            ("held/b/wood.test", Some("b")),
            ("held/x/../b/./wood.test", Some("b")),
            ("held/c/grass.test", Some("c")),
            ("held/c/wood.test", None),
            ("wood.test", None),
            ("held/other.test", None),
        ] {
            let text = SceneFile::open(Path::new(path)).and_then(io::read_to_string).ok();
            assert_eq!(text.as_deref(), found, "{path}");
            assert_eq!(place(Path::new(path)).is_some(), found.is_some(), "{path}");
        }
        let file = SceneFile::open(Path::new("held/a/wood.test")).expect("it is held");
        assert_eq!(file.length().expect("a length"), 1);
    }
}
