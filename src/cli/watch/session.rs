//! What the page of a scene shows, and what it may change: the values that it tries out, and the scene's text.

use super::feed::EventFeed;
use super::tries::Tries;
use crate::cli::files::output;
use crate::cli::process::failure::Failure;
use crate::cli::serve::{self, Body};
use crate::scene::registry::Registry;
use hyper::{Response, StatusCode};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The state of a watched scene that the program and its pages share.
pub struct Session {
    /// The events that the pages show.
    pub feed: EventFeed,
    /// The values that a page tries out.
    pub tries: Tries,
    /// The entity types.
    pub registry: &'static Registry,
    /// The file of the scene.
    pub path: PathBuf,
    /// Tells the program that the values have changed, or the number of pages that look.
    pub changed: Changed,
    /// The number of pages that look at the scene.
    pub looks: Arc<AtomicUsize>,
}

/// Tells the program that it has something to do.
pub type Changed = Arc<dyn Fn() + Send + Sync>;

/// A page that looks at a scene, until it is dropped. It does not keep the scene.
pub struct Look {
    looks: Arc<AtomicUsize>,
    changed: Changed,
}

impl Drop for Look {
    fn drop(&mut self) {
        self.looks.fetch_sub(1, Ordering::Relaxed);
        (self.changed)();
    }
}

impl Session {
    /// Makes the session of a scene that has not been read yet.
    pub fn new(registry: &'static Registry, path: PathBuf, changed: Changed) -> Self {
        let (feed, tries) = (EventFeed::new(), Tries::default());
        Self { feed, tries, registry, path, changed, looks: Arc::default() }
    }

    /// Begins to look at the scene.
    pub fn look(&self) -> Look {
        self.looks.fetch_add(1, Ordering::Relaxed);
        (self.changed)();
        Look { looks: self.looks.clone(), changed: self.changed.clone() }
    }

    /// Tells whether a page looks at the scene.
    pub fn is_looked_at(&self) -> bool {
        self.looks.load(Ordering::Relaxed) > 0
    }

    /// Tries out other values of an attribute.
    pub fn try_out(&self, body: &[u8]) -> Response<Body> {
        match self.tries.set(body) {
            Some(()) => self.done("tried\n"),
            None => serve::text(StatusCode::BAD_REQUEST, "these are not numbers\n"),
        }
    }

    /// Returns to the values of the text.
    pub fn discard(&self) -> Response<Body> {
        self.tries.clear();
        self.done("discarded\n")
    }

    /// Writes the values that are tried out into the scene's file, unless the file is another than the page shows.
    pub fn write(&self) -> Response<Body> {
        let refuse = |reason: String| serve::text(StatusCode::CONFLICT, &reason);
        let text = match fs::read(&self.path).map(String::from_utf8) {
            Ok(Ok(text)) => text,
            Ok(Err(_)) => return refuse("the scene is not in UTF-8: change it in an editor\n".to_owned()),
            Err(error) => {
                return refuse(format!("the scene cannot be read: {}\n", crate::text::reason(&error)));
            }
        };
        let shown = self.feed.text();
        if shown.as_deref() != Some(text.strip_prefix('\u{feff}').unwrap_or(&text)) {
            return refuse("the scene has changed meanwhile: try again\n".to_owned());
        }
        let file = self.path.display().to_string();
        let written = match self.tries.written(self.registry, &file, &text) {
            Ok(written) => written,
            Err(name) => {
                return refuse(format!("`{name}` has no place of its own in the text: change the text\n"));
            }
        };
        match output::replace(&self.path, written.as_bytes()) {
            Ok(()) => {}
            Err(Failure::Failed(reason)) => return refuse(format!("{reason}\n")),
            Err(_) => return refuse("the scene cannot be written\n".to_owned()),
        }
        self.tries.clear();
        self.done("written\n")
    }

    /// Tells the program that the values have changed, and the page that it was done.
    pub fn done(&self, what: &str) -> Response<Body> {
        (self.changed)();
        serve::text(StatusCode::OK, what)
    }
}
