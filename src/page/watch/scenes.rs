//! The watched scenes: those named on the command line, and those in watched folders.

use super::answer;
use super::events::{self, SceneEntry};
use super::feed::News;
use super::files::Files;
use super::session::{ChangeListener, Session};
use hyper::body::Bytes;
use hyper::{Request, Response, StatusCode};
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tabray_cli::files::{folders, input};
use tabray_cli::process::failure::Failure;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_serve::{self as serve, Body, Work};

/// The scenes that are watched.
pub struct Scenes {
    registry: &'static Registry,
    /// The paths that the command names, and whether each is a folder.
    named: Vec<(PathBuf, bool)>,
    /// The values that the command sets beside their texts.
    sets: Vec<String>,
    changed: ChangeListener,
    known: Mutex<KnownScenes>,
}

/// The scenes that are known.
#[derive(Default)]
struct KnownScenes {
    /// All scenes that there have been, by their numbers: a number never comes to mean another scene.
    sessions: Vec<Arc<Session>>,
    numbers: BTreeMap<PathBuf, usize>,
    /// The numbers of the scenes that there are, in the order of the list.
    list: Vec<usize>,
}

impl Scenes {
    /// Finds the scenes that a command names, checks that all can be read, and watches their files and folders.
    pub fn new(
        registry: &'static Registry,
        named: &[PathBuf],
        sets: Vec<String>,
        changed: ChangeListener,
        files: &mut Files,
    ) -> Result<Self, Failure> {
        let named: Vec<_> = named.iter().map(|path| (path.clone(), path.is_dir())).collect();
        let of_kind = |are_folders| {
            let some = named.iter().filter(move |(_, is_folder)| *is_folder == are_folders);
            some.map(|(path, _)| path.clone()).collect::<Vec<_>>()
        };
        let (folders, alone) = (of_kind(true), of_kind(false));
        for folder in &folders {
            folders::some_scenes(folder)?;
        }
        files.watch_folders(&folders);
        let scenes = Self { registry, named, sets, changed, known: Mutex::default() };
        scenes.find();
        for (number, session) in scenes.from(0).iter().enumerate() {
            if alone.contains(&session.path) {
                files.watch(number, [&session.path]);
                // A scene with faults has a page; a path that cannot be read has none.
                input::read(&session.path)?;
            }
        }
        Ok(scenes)
    }

    fn known(&self) -> MutexGuard<'_, KnownScenes> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the scene if it is the only one that there can be.
    fn only(&self) -> Option<&Path> {
        match &self.named[..] {
            [(scene, false)] => Some(scene),
            _ => None,
        }
    }

    /// Returns the name of the watched scenes, for messages.
    pub fn name(&self) -> String {
        let count = || text::count(self.known().list.len(), "scene");
        self.only().map_or_else(count, text::shown)
    }

    /// Finds the scenes that there are now, and tells all pages if they are others than before.
    pub fn find(&self) {
        let mut known = self.known();
        let known = &mut *known;
        let mut list = Vec::new();
        for (named, is_folder) in &self.named {
            let paths =
                if *is_folder { folders::scenes(named).unwrap_or_default() } else { vec![named.clone()] };
            for path in paths {
                let next = known.sessions.len();
                let number = *known.numbers.entry(path.clone()).or_insert(next);
                if number == next {
                    known.sessions.push(Arc::new(Session::new(
                        self.registry,
                        path,
                        self.sets.clone(),
                        self.changed.clone(),
                    )));
                }
                list.push(number);
            }
        }
        let mut listed = HashSet::new();
        list.retain(|number| listed.insert(*number));
        if list == known.list {
            return;
        }
        known.list = list;
        if self.only().is_some() {
            return;
        }
        let name = |number: &usize| {
            let name = text::shown(&known.sessions[*number].path);
            SceneEntry { number: *number, name }
        };
        let event = events::scenes(&known.list.iter().map(name).collect::<Vec<_>>());
        for session in &known.sessions {
            session.feed.tell(News::Scenes, Some(event.clone()));
        }
    }

    /// Tells all pages why the system does not tell of changes, if it does not.
    pub fn tell_of_refusal(&self, refused: Option<&str>) {
        for session in &self.known().sessions {
            session.feed.tell(News::Watching, Some(events::watching(refused)));
        }
    }

    /// Returns the scenes from a number on.
    pub fn from(&self, number: usize) -> Vec<Arc<Session>> {
        self.known().sessions[number..].to_vec()
    }

    /// Tells whether a scene is to be read and rendered: a page looks at it, or it is the only one.
    pub fn is_wanted(&self, number: usize) -> bool {
        self.only().is_some() || self.known().sessions[number].has_viewers()
    }

    /// Answers a request.
    pub async fn answer(&self, request: &Request<Bytes>, work: &Work) -> Response<Body> {
        let session = answer::split(request.uri().path())
            .and_then(|(number, _)| self.known().sessions.get(number).cloned());
        match session {
            Some(session) => answer::answer(request, &session, work).await,
            None => serve::text(StatusCode::NOT_FOUND, "there is no such scene\n"),
        }
    }
}
