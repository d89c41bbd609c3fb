//! Files that get their names only when they are complete.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::thread;
use tabray_core::files::{held_folder, in_held_folder};
use tempfile::NamedTempFile;

/// The paths of all files with hidden names, including files that no longer exist.
static HIDDEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Removes all files with hidden names, because the program ends without dropping their owners.
pub fn remove_all() {
    // The lock is held for a moment, but perhaps by this very thread: it may end where its memory is refused.
    let hidden = (0..100).find_map(|_| match HIDDEN.try_lock() {
        Ok(mut hidden) => Some(mem::take(&mut *hidden)),
        Err(_) => {
            thread::yield_now();
            None
        }
    });
    for path in hidden.into_iter().flatten() {
        let _ = fs::remove_file(path);
    }
}

/// A file in a folder that is not visible under its final name before it is complete.
pub enum Temporary {
    /// A file without a name, which disappears with the program, however that ends.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// A file with a hidden name, where the system has no files without names. It is removed when it is dropped.
    Named(NamedTempFile),
}

impl Temporary {
    /// Makes a temporary file, with the permissions of any new file. What killed programs have left in the folder is removed.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let folder = &held_folder(folder)?;
        #[cfg(unix)]
        left::remove(folder);
        #[cfg(target_os = "linux")]
        if let Some(file) = unnamed::open(folder) {
            return Ok(Self::Unnamed(file));
        }
        let make = |path: &Path| {
            let file = OpenOptions::new().read(true).write(true).create_new(true).open(path)?;
            #[cfg(unix)]
            left::keep(&file, path)?;
            Ok(file)
        };
        hidden(folder, make).map(Self::Named)
    }

    /// Returns the file, to write it and read it again.
    pub fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file,
            Self::Named(file) => file.as_file(),
        }
    }

    /// Gives the file this name in its folder, replacing an existing file.
    ///
    /// A file without a name cannot replace another in a single step: for a moment the complete file has a hidden name. If
    /// the program is killed in this moment, the next one that writes into the folder removes the file.
    ///
    /// The contents are on the disk before the file gets its name, and the name is on the disk when this returns.
    pub fn persist(self, target: &Path) -> io::Result<()> {
        self.file().sync_all()?;
        let target = &in_held_folder(target)?;
        self.name(target)?;
        sync_folder(target)
    }

    fn name(self, target: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => match unnamed::link(&file, target) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    let folder = target.parent().unwrap_or(target);
                    // Before it has a name by which another program would find it.
                    let _ = file.try_lock();
                    Ok(hidden(folder, |path| unnamed::link(&file, path))?.persist(target)?)
                }
                linked => linked,
            },
            Self::Named(file) => Ok(file.persist(target).map(drop)?),
        }
    }

    /// Gives the file a name as [`persist`](Self::persist) does, but fails if a file has that name already.
    pub fn persist_new(self, target: &Path) -> io::Result<()> {
        self.file().sync_all()?;
        let target = &in_held_folder(target)?;
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => unnamed::link(&file, target)?,
            Self::Named(file) => drop(file.persist_noclobber(target)?),
        }
        sync_folder(target)
    }
}

/// The beginning of all hidden names, which is followed by six letters and digits.
const PREFIX: &str = ".tabray-";

/// Calls `make` with a hidden, unused name in a folder, and returns its result.
fn hidden<T>(folder: &Path, make: impl FnMut(&Path) -> io::Result<T>) -> io::Result<NamedTempFile<T>> {
    let file = tempfile::Builder::new().prefix(PREFIX).make_in(folder, make)?;
    HIDDEN.lock().unwrap_or_else(PoisonError::into_inner).insert(file.path().to_owned());
    Ok(file)
}

/// Writes a folder's entry for a file to the disk, where the system supports that: some file systems do not.
fn sync_folder(target: &Path) -> io::Result<()> {
    let folder = target.parent().unwrap_or(Path::new("."));
    let cannot = [io::ErrorKind::InvalidInput, io::ErrorKind::PermissionDenied, io::ErrorKind::Unsupported];
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if !cannot.contains(&error.kind()) => Err(error),
        _ => Ok(()),
    }
}

/// Hidden files that killed programs have left. Those of running programs are locked.
#[cfg(unix)]
mod left {
    use super::{BTreeSet, File, Mutex, PREFIX, Path, PathBuf, PoisonError, fs, io};
    use std::fs::{DirEntry, TryLockError};

    /// Removes those in a folder, the first time that it is called.
    pub fn remove(folder: &Path) {
        static DONE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
        if !DONE.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
            return;
        }
        let is_hidden = |entry: &DirEntry| {
            let (name, kind) = (entry.file_name(), entry.file_type());
            let rest = name.to_str().and_then(|name| name.strip_prefix(PREFIX));
            let is_ours = rest
                .is_some_and(|rest| rest.len() == 6 && rest.bytes().all(|byte| byte.is_ascii_alphanumeric()));
            is_ours && kind.is_ok_and(|kind| kind.is_file())
        };
        for entry in fs::read_dir(folder).into_iter().flatten().flatten().filter(is_hidden) {
            let Ok(file) = File::open(entry.path()) else { continue };
            if file.try_lock().is_ok() {
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    /// Locks a new file; fails as if the name were taken where another program has removed it, or is about to.
    pub fn keep(file: &File, path: &Path) -> io::Result<()> {
        let is_free = !matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        if is_free && path.exists() { Ok(()) } else { Err(io::ErrorKind::AlreadyExists.into()) }
    }
}

#[cfg(target_os = "linux")]
mod unnamed {
    use super::{File, OpenOptions, Path, io};
    use nix::fcntl::{AT_FDCWD, AtFlags, OFlag};
    use nix::unistd::linkat;
    use std::os::fd::AsRawFd;
    use std::os::unix::fs::OpenOptionsExt;
    use std::path::PathBuf;

    /// Returns the path by which the system names an open file.
    fn path(file: &File) -> PathBuf {
        format!("/proc/self/fd/{}", file.as_raw_fd()).into()
    }

    /// Makes a file that can be given a name later; `None` if the file system or the machine does not support that.
    pub fn open(folder: &Path) -> Option<File> {
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).custom_flags(OFlag::O_TMPFILE.bits()).open(folder).ok()?;
        path(&file).symlink_metadata().is_ok().then_some(file)
    }

    /// Gives a file a name; fails if another file has it.
    pub fn link(file: &File, target: &Path) -> io::Result<()> {
        Ok(linkat(AT_FDCWD, &path(file), AT_FDCWD, target, AtFlags::AT_SYMLINK_FOLLOW)?)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use tempfile::TempDir;

    #[test]
    fn what_killed_programs_have_left_is_removed_and_nothing_else() {
        let folder = TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let others = [".tabray-abcde", ".tabray-abcde.x", "tabray-abcdef", ".tabray-held12"];
        for name in others.into_iter().chain([".tabray-left12"]) {
            fs::write(at(name), "").expect("a file");
        }
        let held = File::open(at(".tabray-held12")).expect("a file");
        held.try_lock().expect("nobody else has it");
        let new = Temporary::new(folder.path()).expect("a file");
        assert!(!at(".tabray-left12").exists());
        assert!(others.iter().all(|name| at(name).exists()));
        new.persist(&at("tabray-abcdef")).expect("it is written");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), others.len());
    }
}
