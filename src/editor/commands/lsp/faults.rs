//! The faults of the open scenes: each is read on a thread of its own whenever its text changes.

use super::documents;
use super::protocol::{self, span, uri};
use crate::{Diagnosis, diagnose};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tabray_cli::process::crash;
use tabray_core::text;
use tabray_lang::reader::Severity;
use tabray_lang::registry::Registry;

/// The longest time for which a text must have been left alone before it is read. A scene that is read in less is left
/// alone for as long as that takes.
const SETTLED: Duration = Duration::from_millis(300);

/// A scene that is read in this time is read at once: somebody who types does not wait for its faults.
const AT_ONCE: Duration = Duration::from_millis(200);

/// A scene to be read.
struct Job {
    uri: String,
    version: i64,
    /// What it says; `None` where the scene is no longer open.
    scene: Option<documents::Scene>,
}

/// The faults of a scene.
#[derive(Default)]
struct Scene {
    uri: String,
    version: i64,
    faults: Vec<Diagnosis>,
}

#[derive(Default)]
struct State {
    jobs: BTreeMap<PathBuf, Job>,
    scenes: BTreeMap<PathBuf, Scene>,
    is_over: bool,
}

/// The faults of the open scenes, and the scenes that are to be read.
#[derive(Default)]
pub struct Faults {
    state: Mutex<State>,
    changed: Condvar,
}

impl Faults {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Has a scene read, in place of an older text of it that is waiting.
    pub fn read(&self, path: &Path, uri: &str, version: i64, scene: Option<documents::Scene>) {
        self.state().jobs.insert(path.to_owned(), Job { uri: uri.to_owned(), version, scene });
        self.changed.notify_all();
    }

    /// Ends the thread that reads.
    pub fn end(&self) {
        self.state().is_over = true;
        self.changed.notify_all();
    }

    /// Returns the faults in a file, those of all scenes that include it.
    pub fn in_file(&self, path: &Path) -> Vec<Diagnosis> {
        self.state()
            .scenes
            .values()
            .flat_map(|scene| &scene.faults)
            .filter(|fault| fault.path == path)
            .cloned()
            .collect()
    }

    /// Reads scenes and tells the editor their faults until there is no more to do.
    pub fn work(&self, registry: &Registry, tell: &dyn Fn(String) -> bool) {
        let mut took = Duration::ZERO;
        // The files with faults that are scenes. Finding that out takes as long as finding the faults.
        let mut scenes = BTreeSet::new();
        loop {
            let mut state = self.state();
            while state.jobs.is_empty() && !state.is_over {
                state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
            // While somebody types on, only the last text is read.
            let wait = if took <= AT_ONCE { Duration::ZERO } else { took.min(SETTLED) };
            let until = Instant::now() + wait;
            while !state.is_over
                && let Some(left) =
                    until.checked_duration_since(Instant::now()).filter(|left| !left.is_zero())
            {
                state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
            }
            let next = state.jobs.pop_first();
            let is_over = state.is_over;
            drop(state);
            let Some((path, job)) = next.filter(|_| !is_over) else {
                if is_over {
                    return;
                }
                continue;
            };
            let start = Instant::now();
            let read = |scene: &documents::Scene| {
                crash::set_scene(&text::shown(&path));
                let faults = || {
                    let faults = diagnose(registry, &path, scene.text.as_str(), &scene.open);
                    let is_scene =
                        faults.is_empty() || scenes.contains(&path) || scene.is_scene(registry, &path);
                    is_scene.then_some(faults)
                };
                // A scene that ends in an internal error has no faults that could be told.
                crash::catch(faults).ok().flatten()
            };
            let faults = job.scene.as_ref().and_then(read);
            if faults.as_ref().is_some_and(|faults| !faults.is_empty()) {
                scenes.insert(path.clone());
            }
            let faults = faults.unwrap_or_default();
            took = start.elapsed();
            if !self.keep(path, job, faults).into_iter().all(tell) {
                return;
            }
        }
    }

    /// Keeps the faults of a scene, and returns what the editor is to be told.
    fn keep(&self, path: PathBuf, job: Job, faults: Vec<Diagnosis>) -> Vec<String> {
        let mut state = self.state();
        let is_open = job.scene.is_some();
        let scene = Scene { uri: job.uri, version: job.version, faults };
        let mut touched: BTreeSet<PathBuf> = scene.faults.iter().map(|fault| fault.path.clone()).collect();
        let mut addresses = BTreeMap::from([(path.clone(), (scene.uri.clone(), scene.version))]);
        touched.insert(path.clone());
        let before = match is_open {
            true => state.scenes.insert(path, scene),
            false => state.scenes.remove(&path),
        };
        touched.extend(before.into_iter().flat_map(|scene| scene.faults).map(|fault| fault.path));
        addresses.extend(
            state.scenes.iter().map(|(path, scene)| (path.clone(), (scene.uri.clone(), scene.version))),
        );
        let all: Vec<_> = state.scenes.values().flat_map(|scene| &scene.faults).collect();
        touched
            .into_iter()
            .map(|path| {
                let here = all.iter().filter(|fault| fault.path == path);
                let told: Vec<_> = here.map(|fault| diagnostic(fault)).collect();
                let parameters = match addresses.get(&path) {
                    Some((uri, version)) => json!({ "uri": uri, "version": version, "diagnostics": told }),
                    None => json!({ "uri": uri(&path), "diagnostics": told }),
                };
                protocol::notification("textDocument/publishDiagnostics", &parameters)
            })
            .collect()
    }
}

/// Writes a fault.
pub fn diagnostic(fault: &Diagnosis) -> Value {
    let severity = match fault.severity {
        Severity::Error => 1,
        Severity::Warning => 2,
    };
    let also: Vec<_> = fault
        .also
        .iter()
        .map(|also| json!({ "location": { "uri": uri(&also.path), "range": span(also.range) }, "message": also.text }))
        .collect();
    json!({
        "range": span(fault.range),
        "severity": severity,
        "source": "tabray",
        "message": fault.message,
        "relatedInformation": also,
    })
}
