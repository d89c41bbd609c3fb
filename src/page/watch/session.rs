//! What the page of a scene shows, and what it can change: values that are tried out, and the scene's text.

use super::events;
use super::feed::{EventFeed, News};
use crate::trial_values::{TrialValues, Which};
use hyper::{Response, StatusCode};
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tabray_cli::files::output;
use tabray_cli::process::crash;
use tabray_cli::process::failure::Failure;
use tabray_core::{files, text};
use tabray_editor::{self as editor, Text};
use tabray_lang::reader::{self, ReadOptions};
use tabray_lang::registry::Registry;
use tabray_serve::{self as serve, Body};

/// The state of a watched scene that the program and its pages share.
pub struct Session {
    /// The events that the pages show.
    pub feed: EventFeed,
    /// The values that a page tries out.
    pub trial_values: TrialValues,
    /// The entity types.
    pub registry: &'static Registry,
    /// The file of the scene.
    pub path: PathBuf,
    /// The values that the command sets beside the text.
    pub sets: Vec<String>,
    /// Tells the program that the values have changed, or the number of pages that look.
    pub changed: ChangeListener,
    /// The number of pages that look at the scene.
    pub viewers: Arc<AtomicUsize>,
}

/// Tells the program that it has something to do.
pub type ChangeListener = Arc<dyn Fn() + Send + Sync>;

/// A page that looks at a scene, until it is dropped. It does not keep the scene.
pub struct Viewer {
    viewers: Arc<AtomicUsize>,
    changed: ChangeListener,
}

impl Drop for Viewer {
    fn drop(&mut self) {
        self.viewers.fetch_sub(1, Ordering::Relaxed);
        (self.changed)();
    }
}

impl Session {
    /// Makes the session of a scene that has not been read yet.
    pub fn new(
        registry: &'static Registry,
        path: PathBuf,
        sets: Vec<String>,
        changed: ChangeListener,
    ) -> Self {
        let (feed, trial_values) = (EventFeed::new(), TrialValues::default());
        Self { feed, trial_values, registry, path, sets, changed, viewers: Arc::default() }
    }

    /// Begins to look at the scene.
    pub fn add_viewer(&self) -> Viewer {
        self.viewers.fetch_add(1, Ordering::Relaxed);
        (self.changed)();
        Viewer { viewers: self.viewers.clone(), changed: self.changed.clone() }
    }

    /// Tells whether a page looks at the scene.
    pub fn has_viewers(&self) -> bool {
        self.viewers.load(Ordering::Relaxed) > 0
    }

    /// Tells the pages which values differ from those in the scene's file, if any do or did.
    pub fn tell_differences(&self, name: &str, bytes: &[u8]) {
        let is_known = self.feed.has(News::Tried);
        if self.trial_values.is_empty() && !is_known {
            return;
        }
        let text = String::from_utf8_lossy(bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let view = editor::read(self.registry, name, Text::new(text));
        let differences = self.trial_values.differences(&view);
        if is_known || !differences.is_empty() {
            self.feed.tell(News::Tried, Some(events::tried(&differences)));
        }
    }

    /// Tries out other values of an attribute.
    pub fn try_out(&self, body: &[u8]) -> Response<Body> {
        match self.trial_values.set(body) {
            Some(()) => self.done("tried\n"),
            None => serve::text(StatusCode::BAD_REQUEST, "these are not numbers\n"),
        }
    }

    /// Returns to the values of the text, in one attribute if the page names one.
    pub fn discard(&self, body: &[u8]) -> Response<Body> {
        let Ok(which) = which(body) else { return nothing_such() };
        self.trial_values.discard(which.as_ref());
        self.done("discarded\n")
    }

    /// Writes the values that are tried out, or those of the attribute that the page names, into the scene's file, unless
    /// the file is another than the page shows.
    pub fn write(&self, body: &[u8]) -> Response<Body> {
        let Ok(which) = which(body) else { return nothing_such() };
        let file = text::shown(&self.path);
        let written = |text: &str| {
            let written = self.trial_values.written(self.registry, &file, text, which.as_ref());
            written.map_err(|name| format!("`{name}` has no place of its own in the text: change the text"))
        };
        match self.edit(written) {
            Ok(()) => {
                self.trial_values.discard(which.as_ref());
                self.done("written\n")
            }
            Err(reason) => refusal(&reason),
        }
    }

    /// Writes a text that was edited on a page, unless the scene's file has another hash than the text had before.
    pub fn save(&self, hash: &str, body: &[u8]) -> Response<Body> {
        let Ok(new) = str::from_utf8(body) else { return nothing_such() };
        let edited = |old: &str| {
            // A page has line feeds alone.
            let has_returns = old.contains("\r\n") && !old.replace("\r\n", "").contains('\n');
            Ok(if has_returns { new.replace("\r\n", "\n").replace('\n', "\r\n") } else { new.to_owned() })
        };
        match self.edit_if(|shown| text::sha256(&Sha256::digest(shown)) == format!("sha256:{hash}"), edited) {
            Ok(()) => self.done("saved\n"),
            Err(reason) => refusal(&reason),
        }
    }

    /// Edits the scene's file, unless it is another than the page shows.
    ///
    /// # Errors
    /// Why it stays as it is.
    pub fn edit(&self, edited: impl FnOnce(&str) -> Result<String, String>) -> Result<(), String> {
        let shown = self.feed.text();
        self.edit_if(|text| shown.as_deref() == Some(text), edited)
    }

    /// Edits the scene's file, if its text is the expected one and the scene has no errors then.
    fn edit_if(
        &self,
        is_expected: impl FnOnce(&str) -> bool,
        edited: impl FnOnce(&str) -> Result<String, String>,
    ) -> Result<(), String> {
        let bytes = files::open(&self.path).and_then(|mut file| {
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).map(|_| bytes)
        });
        let all = match bytes.map(String::from_utf8) {
            Ok(Ok(all)) => all,
            Ok(Err(_)) => return Err("the scene is not in UTF-8: change it in an editor".to_owned()),
            Err(error) => {
                return Err(format!("the scene cannot be read: {}", text::reason(&error)));
            }
        };
        let (mark, body) = match all.strip_prefix('\u{feff}') {
            Some(body) => ("\u{feff}", body),
            None => ("", &*all),
        };
        if !is_expected(body) {
            return Err("the scene has changed meanwhile: try again".to_owned());
        }
        let new = format!("{mark}{}", edited(body)?);
        self.check(&new)?;
        match output::replace(&self.path, new.as_bytes()) {
            Ok(()) => Ok(()),
            Err(Failure::Failed(reason)) => Err(reason),
            Err(_) => Err("the scene cannot be written".to_owned()),
        }
    }

    /// Checks a text as `tabray check` does.
    ///
    /// # Errors
    /// Its errors, as people read them.
    fn check(&self, text: &str) -> Result<(), String> {
        let (name, folder) = (text::shown(&self.path), self.path.parent().unwrap_or(&self.path));
        let options = ReadOptions { sets: &self.sets, ..ReadOptions::default() };
        match crash::catch(|| reader::read_by(self.registry, &name, folder, text.as_bytes(), options)) {
            Ok(Ok(_)) => Ok(()),
            Ok(Err(report)) => Err(format!("nothing is written, because of errors\n{report}")),
            Err(_) => Err("nothing is written, because of an internal error".to_owned()),
        }
    }

    /// Tells the program that the values have changed, and the page that it was done.
    pub fn done(&self, what: &str) -> Response<Body> {
        (self.changed)();
        serve::text(StatusCode::OK, what)
    }
}

/// Reads which attribute a request is about; `None` where it is about all.
fn which(body: &[u8]) -> serde_json::Result<Option<Which>> {
    if body.is_empty() { Ok(None) } else { serde_json::from_slice(body).map(Some) }
}

fn nothing_such() -> Response<Body> {
    serve::text(StatusCode::BAD_REQUEST, "this is neither a value nor a text\n")
}

/// Says why something is not done.
pub fn refusal(reason: &str) -> Response<Body> {
    serve::text(StatusCode::CONFLICT, &format!("{reason}\n"))
}
