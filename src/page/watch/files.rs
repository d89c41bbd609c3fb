//! Watches the files that a scene is read from.

use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind};
use notify::{ErrorKind, Event, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
#[cfg(unix)]
use std::os::unix::fs::MetadataExt;
use std::path::{self, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;
use tabray_cli::files::folders::is_scene;
use tabray_core::text;

/// Watches files by their folders, because many editors replace a file by a new one. Where a folder does not exist, the
/// nearest one above it is watched.
///
/// The system does not tell of every change: not of those on other machines, nor of a mount. So whoever has files watched
/// [looks](Self::poll) at them once in a while.
pub struct Files {
    watcher: notify::Result<RecommendedWatcher>,
    filter: Arc<Mutex<WatchFilter>>,
    /// The files of each scene, by its number, and the folders in which all scenes are of interest, as they are named.
    of: BTreeMap<usize, BTreeSet<PathBuf>>,
    folders: Vec<PathBuf>,
    /// The stamps of all these when they were looked at last.
    stamps: BTreeMap<PathBuf, Option<Stamp>>,
    /// The folders that the system watches, each as it was then.
    armed: BTreeMap<PathBuf, Identity>,
    /// The first folder that the system refuses to watch, and why.
    refused: Option<String>,
}

/// The files whose changes are of interest, as the system names them.
#[derive(Default)]
struct WatchFilter {
    files: BTreeSet<PathBuf>,
    /// The folders in which all scenes are of interest.
    folders: BTreeSet<PathBuf>,
}

impl WatchFilter {
    fn has(&self, path: &Path) -> bool {
        let is_in_folder = || path.parent().is_some_and(|folder| self.folders.contains(folder));
        // A folder may come or go with all that is in it.
        let leads_to_one = || self.files.iter().chain(&self.folders).any(|one| one.starts_with(path));
        leads_to_one() || (is_scene(path) && is_in_folder())
    }
}

/// What changes when a file changes: its times, its length in bytes and, where the system has one, its number.
#[derive(Clone, PartialEq)]
pub struct Stamp(Option<SystemTime>, u64, [i64; 3]);

/// Returns the stamp of a file or a folder; `None` if it cannot be found.
pub fn stamp(path: &Path) -> Option<Stamp> {
    let meta = fs::metadata(path).ok()?;
    #[cfg(unix)]
    let more = [meta.ctime(), meta.ctime_nsec(), meta.ino() as i64];
    #[cfg(not(unix))]
    let more = [0; 3];
    Some(Stamp(meta.modified().ok(), meta.len(), more))
}

/// What distinguishes a folder from another one that has its name later: when it was made and, where the system has them,
/// its device and its number there.
type Identity = (Option<SystemTime>, [u64; 2]);

fn identity(folder: &Path) -> Option<Identity> {
    let meta = fs::metadata(folder).ok().filter(fs::Metadata::is_dir)?;
    #[cfg(unix)]
    let more = [meta.dev(), meta.ino()];
    #[cfg(not(unix))]
    let more = [0; 2];
    Some((meta.created().ok(), more))
}

impl Files {
    /// Makes a watcher without files. `changed` is called, on another thread, whenever the system tells that a file may have
    /// changed.
    pub fn new(changed: impl Fn() + Send + 'static) -> Self {
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
        Self::of(notify::recommended_watcher(see), filter)
    }

    fn of(watcher: notify::Result<RecommendedWatcher>, filter: Arc<Mutex<WatchFilter>>) -> Self {
        let (of, folders, stamps, armed) = Default::default();
        Self { watcher, filter, of, folders, stamps, armed, refused: None }
    }

    /// Watches these files of a scene, whether they exist or not, and no others of it.
    pub fn watch<'f>(&mut self, scene: usize, files: impl IntoIterator<Item = &'f PathBuf>) {
        let files = files.into_iter().cloned().collect();
        if self.of.get(&scene) != Some(&files) {
            self.of.insert(scene, files);
            self.arm();
        }
    }

    /// Watches all scenes in these folders, including those that are added later.
    pub fn watch_folders(&mut self, folders: &[PathBuf]) {
        self.folders = folders.to_vec();
        self.arm();
    }

    /// Looks at all files and folders, watches new ones, and tells whether one has changed since
    /// the last call.
    pub fn poll(&mut self) -> bool {
        let mut is_other = false;
        for (path, known) in &mut self.stamps {
            let now = stamp(path);
            is_other |= *known != now;
            *known = now;
        }
        self.arm();
        is_other
    }

    /// Says why the system does not tell of changes; `None` if it does.
    pub fn refused(&self) -> Option<&str> {
        self.refused.as_deref()
    }

    fn filter(&self) -> MutexGuard<'_, WatchFilter> {
        self.filter.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets the system watch all folders that are there.
    fn arm(&mut self) {
        let named: BTreeSet<_> = self.of.values().flatten().chain(&self.folders).collect();
        self.stamps.retain(|path, _| named.contains(path));
        for path in named {
            self.stamps.entry(path.clone()).or_insert_with(|| stamp(path));
        }
        let wanted: BTreeMap<_, _> = {
            let mut filter = self.filter();
            filter.files = self.of.values().flatten().flat_map(|file| places(file)).collect();
            filter.folders = self.folders.iter().map(|folder| real(folder)).collect();
            let around = filter.files.iter().filter_map(|file| file.parent());
            let all = around.chain(filter.folders.iter().map(PathBuf::as_path));
            all.filter_map(|folder| folder.ancestors().find_map(|at| Some((at.to_owned(), identity(at)?))))
                .collect()
        };
        self.refused = None;
        let watcher = match &mut self.watcher {
            Ok(watcher) => watcher,
            Err(error) => {
                self.refused = Some(format!("cannot watch files: {}", reason(error)));
                return;
            }
        };
        // A folder that has been removed is no longer watched.
        self.armed.retain(|folder, known| {
            let stays = wanted.get(folder) == Some(known);
            if !stays {
                let _ = watcher.unwatch(folder);
            }
            stays
        });
        for (folder, identity) in wanted {
            if self.armed.contains_key(&folder) {
                continue;
            }
            match watcher.watch(&folder, RecursiveMode::NonRecursive) {
                Ok(()) => drop(self.armed.insert(folder, identity)),
                // It went a moment ago.
                Err(_) if !folder.exists() => {}
                Err(error) => {
                    let words =
                        || format!("cannot watch the folder `{}`: {}", text::shown(&folder), reason(&error));
                    self.refused.get_or_insert_with(words);
                }
            }
        }
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

/// Returns a path as the system names it, up to where it no longer exists.
fn real(path: &Path) -> PathBuf {
    let path = path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let there = |at: &Path| Some(at.canonicalize().ok()?.join(path.strip_prefix(at).ok()?));
    path.ancestors().find_map(there).unwrap_or_else(|| path.clone())
}

/// Returns the path of a file and, if it is a link, that of its target, as the system names them.
fn places(file: &Path) -> impl Iterator<Item = PathBuf> {
    let folder = match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let itself = file.file_name().map(|name| real(folder).join(name));
    itself.into_iter().chain([real(file)])
}

/// Tells whether a file may have changed its contents. Reading a file is an event too.
fn is_change(kind: EventKind) -> bool {
    match kind {
        EventKind::Access(access) => access == AccessKind::Close(AccessMode::Write),
        EventKind::Modify(ModifyKind::Metadata(_)) => false,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    /// Makes a folder, and a watcher to which the system tells nothing.
    fn deaf() -> (TempDir, Files) {
        let error = notify::Error::new(ErrorKind::MaxFilesWatch);
        (TempDir::new().expect("a folder"), Files::of(Err(error), Arc::default()))
    }

    #[test]
    fn a_change_of_which_the_system_does_not_tell_is_seen_by_looking() {
        let (folder, mut files) = deaf();
        let [inner, scene, other] =
            ["inner", "inner/scene.ray", "other.ray"].map(|name| folder.path().join(name));
        files.watch(0, [&scene]);
        assert_eq!(
            files.refused(),
            Some("cannot watch files: the system watches as many files as it allows")
        );
        assert!(!files.poll(), "it is not there yet");
        fs::create_dir(&inner).expect("a folder");
        fs::write(&scene, "1").expect("a file");
        assert!(files.poll() && !files.poll());
        // A file of the same length and time.
        let modified = fs::metadata(&scene).and_then(|meta| meta.modified()).expect("a time");
        fs::write(&other, "2").expect("a file");
        fs::File::options()
            .write(true)
            .open(&other)
            .and_then(|file| file.set_modified(modified))
            .expect("a time");
        fs::rename(&other, &scene).expect("in its place");
        assert!(!cfg!(unix) || files.poll());
        fs::remove_dir_all(&inner).expect("it was there");
        assert!(files.poll() && !files.poll());
    }

    #[test]
    fn the_nearest_folder_that_is_there_is_watched() {
        let folder = TempDir::new().expect("a folder");
        let at = folder.path().canonicalize().expect("it is there");
        let mut files = Files::new(|| {});
        let armed = |files: &Files| files.armed.keys().cloned().collect::<Vec<_>>();
        files.watch(0, [&folder.path().join("a/b/scene.ray")]);
        assert_eq!(armed(&files), std::slice::from_ref(&at));
        fs::create_dir_all(at.join("a/b")).expect("folders");
        files.poll();
        assert_eq!(armed(&files), [at.join("a/b")]);
        fs::rename(at.join("a"), at.join("c")).expect("another name");
        fs::create_dir(at.join("a")).expect("a folder");
        files.poll();
        assert_eq!(armed(&files), [at.join("a")]);
    }
}
