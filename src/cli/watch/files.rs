//! Watches the files that a scene is read from.

use crate::cli::process::failure::Failure;
use crate::text;
use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind};
use notify::{ErrorKind, Event, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Watches files by their folders, because many editors replace a file by a new one.
pub struct Files {
    watcher: RecommendedWatcher,
    files: Arc<Mutex<BTreeSet<PathBuf>>>,
    folders: BTreeSet<PathBuf>,
}

impl Files {
    /// Makes a watcher without files. `changed` is called, on another thread, whenever a file may have changed.
    ///
    /// # Errors
    /// If the system cannot watch files.
    pub fn new(changed: impl Fn() + Send + 'static) -> Result<Self, Failure> {
        let files = Arc::<Mutex<BTreeSet<PathBuf>>>::default();
        let wanted = files.clone();
        let see = move |event: notify::Result<Event>| {
            let concerns = |event: &Event| {
                let wanted = wanted.lock().unwrap_or_else(PoisonError::into_inner);
                is_change(event.kind) && event.paths.iter().any(|path| wanted.contains(path))
            };
            // If events were lost, they may have been about any file.
            if event.is_ok_and(|event| event.need_rescan() || concerns(&event)) {
                changed();
            }
        };
        let watcher = notify::recommended_watcher(see)
            .map_err(|error| Failure::Failed(format!("cannot watch files: {}", reason(&error))))?;
        Ok(Self { watcher, files, folders: BTreeSet::new() })
    }

    /// Watches these files, whether they exist or not, and no others.
    ///
    /// # Errors
    /// If the system cannot watch one of their folders.
    pub fn watch<'f>(&mut self, files: impl IntoIterator<Item = &'f PathBuf>) -> Result<(), Failure> {
        let files: BTreeSet<_> = files.into_iter().flat_map(|file| places(file)).collect();
        let folders: BTreeSet<_> =
            files.iter().filter_map(|file| file.parent()).map(Path::to_owned).collect();
        *self.files.lock().unwrap_or_else(PoisonError::into_inner) = files;
        for folder in folders.difference(&self.folders) {
            self.watcher.watch(folder, RecursiveMode::NonRecursive).map_err(|error| {
                Failure::Failed(format!("cannot watch the folder `{}`: {}", folder.display(), reason(&error)))
            })?;
        }
        for folder in self.folders.difference(&folders) {
            // A folder that has been removed is no longer watched.
            let _ = self.watcher.unwatch(folder);
        }
        self.folders = folders;
        Ok(())
    }
}

/// Returns why the system cannot watch a file.
fn reason(error: &notify::Error) -> String {
    match &error.kind {
        ErrorKind::Io(error) => text::reason(error),
        ErrorKind::MaxFilesWatch => "the system already watches as many files as it may".to_owned(),
        _ => text::reason(&io::Error::other(error.to_string())),
    }
}

/// Returns the path of a file and, if it is a link, that of its target, as the system names them. A folder that does
/// not exist cannot be watched.
fn places(file: &Path) -> impl Iterator<Item = PathBuf> {
    let folder = match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let itself = folder.canonicalize().ok().zip(file.file_name()).map(|(folder, name)| folder.join(name));
    itself.into_iter().chain(file.canonicalize())
}

/// Tells whether a file may have changed its contents. Reading a file is an event too.
fn is_change(kind: EventKind) -> bool {
    match kind {
        EventKind::Access(access) => access == AccessKind::Close(AccessMode::Write),
        EventKind::Modify(ModifyKind::Metadata(_)) => false,
        _ => true,
    }
}
