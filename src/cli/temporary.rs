//! Files that get their names when they are whole.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::NamedTempFile;

/// The files that have hidden names, or had.
static HIDDEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Removes all files that have hidden names, as the program ends before what made them does.
pub fn remove_all() {
    for path in std::mem::take(&mut *HIDDEN.lock().unwrap_or_else(PoisonError::into_inner)) {
        let _ = fs::remove_file(path);
    }
}

/// A file in a folder, written before anybody sees it.
pub enum Temporary {
    /// Without a name: it goes with the program, however that ends.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// Hidden, where the system has no files without names. It goes when it is dropped.
    Named(NamedTempFile),
}

impl Temporary {
    /// A new one, with the permissions that any new file gets.
    pub fn new(folder: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Some(file) = unnamed::open(folder) {
            return Ok(Self::Unnamed(file));
        }
        hidden(folder, |path| OpenOptions::new().read(true).write(true).create_new(true).open(path))
            .map(Self::Named)
    }

    /// To be written, and read again.
    pub fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file,
            Self::Named(file) => file.as_file(),
        }
    }

    /// Gives it a name, in the folder that it is in, and takes the name from the file that has it, if one has.
    ///
    /// There is no single step to this for a file without a name: for a moment the file, which is whole, has a hidden one.
    ///
    /// What it contains is on the disk before it has the name, and the name is when this returns.
    pub fn persist(self, target: &Path) -> io::Result<()> {
        self.file().sync_all()?;
        self.name(target)?;
        sync_folder(target)
    }

    fn name(self, target: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => match unnamed::link(&file, target) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    let folder = target.parent().unwrap_or(target);
                    Ok(hidden(folder, |path| unnamed::link(&file, path))?.persist(target)?)
                }
                linked => linked,
            },
            Self::Named(file) => Ok(file.persist(target).map(drop)?),
        }
    }

    /// As [`persist`](Self::persist), but for a name that another file has already.
    pub fn persist_new(self, target: &Path) -> io::Result<()> {
        self.file().sync_all()?;
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => unnamed::link(&file, target)?,
            Self::Named(file) => drop(file.persist_noclobber(target)?),
        }
        sync_folder(target)
    }
}

/// What `make` makes at a hidden place in a folder where nothing is yet.
fn hidden<T>(folder: &Path, make: impl FnMut(&Path) -> io::Result<T>) -> io::Result<NamedTempFile<T>> {
    let file = tempfile::Builder::new().prefix(".tabray-").make_in(folder, make)?;
    HIDDEN.lock().unwrap_or_else(PoisonError::into_inner).insert(file.path().to_owned());
    Ok(file)
}

/// Has the names in the folder of a file written to the disk, where the system can be asked to: some file systems cannot.
fn sync_folder(target: &Path) -> io::Result<()> {
    let folder = target.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let cannot = [io::ErrorKind::InvalidInput, io::ErrorKind::PermissionDenied, io::ErrorKind::Unsupported];
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if !cannot.contains(&error.kind()) => Err(error),
        _ => Ok(()),
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

    /// The name that the system has for an open file.
    fn path(file: &File) -> PathBuf {
        format!("/proc/self/fd/{}", file.as_raw_fd()).into()
    }

    /// A file that can be given a name later, unless the file system or the machine has none such.
    pub fn open(folder: &Path) -> Option<File> {
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).custom_flags(OFlag::O_TMPFILE.bits()).open(folder).ok()?;
        path(&file).symlink_metadata().is_ok().then_some(file)
    }

    /// Gives a file a name that no other one has.
    pub fn link(file: &File, target: &Path) -> io::Result<()> {
        Ok(linkat(AT_FDCWD, &path(file), AT_FDCWD, target, AtFlags::AT_SYMLINK_FOLLOW)?)
    }
}
