//! Watches the files that a scene is read from.

use crate::process::failure::Failure;
use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind};
use notify::{ErrorKind, Event, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tabray_core::text;

/// Watches files by their folders, because many editors replace a file by a new one.
pub struct Files {
    watcher: RecommendedWatcher,
    filter: Arc<Mutex<WatchFilter>>,
    /// The files of each scene, by its number.
    of: BTreeMap<usize, BTreeSet<PathBuf>>,
    folders: BTreeSet<PathBuf>,
}

/// The files whose changes are of interest.
#[derive(Default)]
struct WatchFilter {
    files: BTreeSet<PathBuf>,
    /// The folders in which all scenes are of interest.
    folders: BTreeSet<PathBuf>,
}

impl WatchFilter {
    fn has(&self, path: &Path) -> bool {
        let is_in_folder = || path.parent().is_some_and(|folder| self.folders.contains(folder));
        self.files.contains(path) || (is_scene(path) && is_in_folder())
    }
}

/// Tells whether a file in a folder is a scene, by its name.
pub fn is_scene(path: &Path) -> bool {
    let is_hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
    let extension = path.extension().and_then(OsStr::to_str).unwrap_or_default();
    !is_hidden && ["ray", "toml"].iter().any(|known| extension.eq_ignore_ascii_case(known))
}

impl Files {
    /// Makes a watcher without files. `changed` is called, on another thread, whenever a file may have changed.
    ///
    /// # Errors
    /// If the system cannot watch files.
    pub fn new(changed: impl Fn() + Send + 'static) -> Result<Self, Failure> {
        let filter = Arc::<Mutex<WatchFilter>>::default();
        let known = filter.clone();
        let see = move |event: notify::Result<Event>| {
            let concerns = |event: &Event| {
                let known = known.lock().unwrap_or_else(PoisonError::into_inner);
                is_change(event.kind) && event.paths.iter().any(|path| known.has(path))
            };
            // If events were lost, they may have been about any file.
            if event.is_ok_and(|event| event.need_rescan() || concerns(&event)) {
                changed();
            }
        };
        let watcher = notify::recommended_watcher(see)
            .map_err(|error| Failure::Failed(format!("cannot watch files: {}", reason(&error))))?;
        Ok(Self { watcher, filter, of: BTreeMap::new(), folders: BTreeSet::new() })
    }

    /// Watches these files of a scene, whether they exist or not, and no others of it.
    ///
    /// # Errors
    /// If the system cannot watch one of their folders.
    pub fn watch<'f>(
        &mut self,
        scene: usize,
        files: impl IntoIterator<Item = &'f PathBuf>,
    ) -> Result<(), Failure> {
        let files = files.into_iter().flat_map(|file| places(file)).collect();
        if self.of.get(&scene) == Some(&files) {
            return Ok(());
        }
        self.of.insert(scene, files);
        self.filter().files = self.of.values().flatten().cloned().collect();
        self.apply()
    }

    /// Watches all scenes in these folders, including those that are added later.
    ///
    /// # Errors
    /// If the system cannot watch one of the folders.
    pub fn watch_folders(&mut self, folders: &[PathBuf]) -> Result<(), Failure> {
        self.filter().folders = folders.iter().filter_map(|folder| folder.canonicalize().ok()).collect();
        self.apply()
    }

    fn filter(&self) -> MutexGuard<'_, WatchFilter> {
        self.filter.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn apply(&mut self) -> Result<(), Failure> {
        let folders: BTreeSet<_> = {
            let filter = self.filter();
            let around = filter.files.iter().filter_map(|file| file.parent()).map(Path::to_owned);
            around.chain(filter.folders.iter().cloned()).collect()
        };
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
        ErrorKind::MaxFilesWatch => "the system watches as many files as it allows".to_owned(),
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
