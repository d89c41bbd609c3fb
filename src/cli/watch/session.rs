//! What the page of a scene shows, and what it may change: the values that it tries out, and the scene's text.

use super::feed::EventFeed;
use super::trial_values::TrialValues;
use crate::files::output;
use crate::process::failure::Failure;
use crate::serve::{self, Body};
use hyper::{Response, StatusCode};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tabray_core::text;
use tabray_lang::registry::Registry;

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
    pub fn new(registry: &'static Registry, path: PathBuf, changed: ChangeListener) -> Self {
        let (feed, trial_values) = (EventFeed::new(), TrialValues::default());
        Self { feed, trial_values, registry, path, changed, viewers: Arc::default() }
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

    /// Tries out other values of an attribute.
    pub fn try_out(&self, body: &[u8]) -> Response<Body> {
        match self.trial_values.set(body) {
            Some(()) => self.done("tried\n"),
            None => serve::text(StatusCode::BAD_REQUEST, "these are not numbers\n"),
        }
    }

    /// Returns to the values of the text.
    pub fn discard(&self) -> Response<Body> {
        self.trial_values.clear();
        self.done("discarded\n")
    }

    /// Writes the values that are tried out into the scene's file, unless the file is another than the page shows.
    pub fn write(&self) -> Response<Body> {
        let file = text::shown(&self.path);
        let written = |text: &str| {
            let written = self.trial_values.written(self.registry, &file, text);
            written.map_err(|name| format!("`{name}` has no place of its own in the text: change the text"))
        };
        match self.edit(written) {
            Ok(()) => {
                self.trial_values.clear();
                self.done("written\n")
            }
            Err(reason) => refusal(&reason),
        }
    }

    /// Edits the scene's file, unless it is another than the page shows.
    ///
    /// # Errors
    /// Why it stays as it is.
    pub fn edit(&self, edited: impl FnOnce(&str) -> Result<String, String>) -> Result<(), String> {
        let text = match fs::read(&self.path).map(String::from_utf8) {
            Ok(Ok(text)) => text,
            Ok(Err(_)) => return Err("the scene is not in UTF-8: change it in an editor".to_owned()),
            Err(error) => {
                return Err(format!("the scene cannot be read: {}", tabray_core::text::reason(&error)));
            }
        };
        let shown = self.feed.text();
        if shown.as_deref() != Some(text.strip_prefix('\u{feff}').unwrap_or(&text)) {
            return Err("the scene has changed meanwhile: try again".to_owned());
        }
        match output::replace(&self.path, edited(&text)?.as_bytes()) {
            Ok(()) => Ok(()),
            Err(Failure::Failed(reason)) => Err(reason),
            Err(_) => Err("the scene cannot be written".to_owned()),
        }
    }

    /// Tells the program that the values have changed, and the page that it was done.
    pub fn done(&self, what: &str) -> Response<Body> {
        (self.changed)();
        serve::text(StatusCode::OK, what)
    }
}

/// Says why something is not done.
pub fn refusal(reason: &str) -> Response<Body> {
    serve::text(StatusCode::CONFLICT, &format!("{reason}\n"))
}
