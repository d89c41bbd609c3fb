//! The texts that are open in the editor, and the files beside them.

use super::protocol::{ContentChange, path};
use crate::{self as editor, Files, Text, View};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::SystemTime;
use tabray_core::files;
use tabray_lang::registry::Registry;

/// The largest text that is read, open or not, in bytes.
pub const LARGEST: u64 = 1 << 24;

/// A text that is open in the editor.
pub struct Document {
    /// Its address, as the editor writes it.
    pub uri: String,
    pub version: i64,
    pub text: Text,
    view: SharedView,
}

/// The view of a text, which is made once, by the first thread that asks.
type SharedView = Arc<OnceLock<Arc<View>>>;

/// A scene as it is in the editor, to be read by another thread.
pub struct Scene {
    /// The scene's text.
    pub text: Text,
    /// All open texts, by their paths.
    pub open: Vec<(PathBuf, Arc<str>)>,
    view: SharedView,
}

impl Scene {
    /// Tells whether the text is a scene's at all: a file in TOML may be about something else.
    pub fn is_scene(&self, registry: &Registry, path: &Path) -> bool {
        read_once(&self.view, registry, path, &self.text).is_scene()
    }
}

fn read_once(shared: &OnceLock<Arc<View>>, registry: &Registry, path: &Path, text: &Text) -> Arc<View> {
    let view = || Arc::new(editor::read(registry, &path.to_string_lossy(), text.clone()));
    shared.get_or_init(view).clone()
}

/// A file as it was read: when it was last changed, and what it says.
type CachedFile = (Option<SystemTime>, Arc<View>);

/// The texts that are open in the editor, by their paths, and the files that were read beside them.
pub struct Documents<'r> {
    registry: &'r Registry,
    open: BTreeMap<PathBuf, Document>,
    stored: RefCell<BTreeMap<PathBuf, CachedFile>>,
}

impl<'r> Documents<'r> {
    pub fn new(registry: &'r Registry) -> Self {
        Self { registry, open: BTreeMap::new(), stored: RefCell::default() }
    }

    /// Returns the registered entity types.
    pub fn registry(&self) -> &'r Registry {
        self.registry
    }

    /// Opens a text, or replaces it. One that is too large counts as not open.
    pub fn open(&mut self, uri: String, version: i64, text: String) -> PathBuf {
        let path = path(&uri);
        if text.len() as u64 > LARGEST {
            self.open.remove(&path);
            return path;
        }
        let document = Document { uri, version, text: Text::new(text), view: SharedView::default() };
        self.open.insert(path.clone(), document);
        path
    }

    /// Changes a text.
    pub fn change(&mut self, path: &Path, version: i64, changes: &[ContentChange]) {
        let Some(document) = self.open.get_mut(path) else { return };
        for ContentChange { range, text } in changes {
            document.text = match range {
                None => Text::new(text.as_str()),
                Some(range) => {
                    let place = document.text.offset(range.start)..document.text.offset(range.end);
                    document.text.edited(place, text)
                }
            };
        }
        document.version = version;
        document.view = SharedView::default();
        if document.text.as_str().len() as u64 > LARGEST {
            self.open.remove(path);
        }
    }

    pub fn close(&mut self, path: &Path) {
        self.open.remove(path);
    }

    pub fn get(&self, path: &Path) -> Option<&Document> {
        self.open.get(path)
    }

    /// Returns an open text as a scene that another thread reads.
    pub fn scene(&self, path: &Path) -> Option<Scene> {
        let document = self.open.get(path)?;
        let open = self.open.iter().map(|(path, other)| (path.clone(), other.text.shared())).collect();
        Some(Scene { text: document.text.clone(), open, view: document.view.clone() })
    }

    /// Returns the paths of the open texts.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.open.keys().cloned().collect()
    }

    /// Returns the address of a file: that of the editor, if it is open.
    pub fn uri(&self, path: &Path) -> String {
        self.open.get(path).map_or_else(|| super::protocol::uri(path), |document| document.uri.clone())
    }

    fn read(&self, path: &Path) -> Option<Arc<View>> {
        let meta = fs::metadata(path).ok().filter(|meta| meta.len() <= LARGEST)?;
        let changed = meta.modified().ok();
        if let Some((known, view)) = self.stored.borrow().get(path)
            && *known == changed
        {
            return Some(view.clone());
        }
        let mut text = String::new();
        files::open(path).ok()?.take(LARGEST).read_to_string(&mut text).ok()?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let view = Arc::new(editor::read(self.registry, &path.to_string_lossy(), Text::new(text)));
        self.stored.borrow_mut().insert(path.to_owned(), (changed, view.clone()));
        Some(view)
    }
}

impl Files for Documents<'_> {
    fn view(&self, path: &Path) -> Option<Arc<View>> {
        let Some(document) = self.open.get(path) else { return self.read(path) };
        Some(read_once(&document.view, self.registry, path, &document.text))
    }
}
