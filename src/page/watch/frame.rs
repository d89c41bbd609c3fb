//! A valid scene, as it was when it was read.

use crate::Shown;
use std::io;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use tabray_core::scene::model::Model;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::reader::{self, Places, ReadOptions, Report};
use tabray_lang::registry::Registry;

/// A valid scene, its text and the state of its image.
pub struct Frame {
    /// The version of the scene, from 1.
    pub version: u64,
    /// The name of the scene in messages.
    pub name: String,
    /// The text of the scene.
    pub text: String,
    /// The warnings about the scene.
    pub warnings: String,
    /// The model of the scene.
    pub model: Model,
    /// The place of each entity in the text.
    pub places: Places,
    /// The folder from which the scene names its files.
    pub folder: PathBuf,
    /// The values that are set beside the text.
    pub sets: Vec<String>,
    /// The accuracy that overrides the scene's own.
    pub accuracy: Option<Accuracy>,
    /// The state of its chart.
    pub charting: ChartState,
    /// Whether a newer scene has replaced this one.
    pub stale: AtomicBool,
}

impl Frame {
    /// Makes the model again, with another accuracy if one is given, and by the same rules of light.
    ///
    /// # Errors
    /// The faults of the scene with that accuracy.
    pub fn load(&self, registry: &Registry, accuracy: Option<Accuracy>) -> io::Result<Model> {
        let chosen = ReadOptions {
            above_all: accuracy.or(self.accuracy),
            rules: Some(self.model.camera.value.rules),
            sets: &self.sets,
            ..ReadOptions::default()
        };
        let loaded = reader::read_by(registry, &self.name, &self.folder, self.text.as_bytes(), chosen);
        let faults = |report: Report| io::Error::new(io::ErrorKind::InvalidData, report.to_string());
        loaded.map(|loaded| loaded.model).map_err(faults)
    }

    /// Breaks if the scene has been replaced.
    pub fn check(&self) -> ControlFlow<()> {
        if self.stale.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Returns what a page asks for.
    pub fn shown(&self) -> Shown<'_> {
        Shown { model: &self.model, name: &self.name, text: &self.text, sets: &self.sets }
    }
}

/// The state of the chart of a scene.
#[derive(Default)]
pub struct ChartState {
    /// Whether it is being measured.
    pub is_busy: AtomicBool,
    /// The units of work that are done, and all units.
    pub units: [AtomicUsize; 2],
}

impl ChartState {
    /// Returns the units of work that are done, and all units.
    pub fn units(&self) -> [usize; 2] {
        self.units.each_ref().map(|units| units.load(Ordering::Relaxed))
    }
}
