//! Measures the cost and the error of each choice in a scene: speed charted against accuracy.
//!
//! The choices are those that a scene has: methods of finding the hits of its shapes, and numbers of samples per pixel.
//! Errors are measured against the truth (proven hits, with distances to 30 digits; images of a thousand samples), and
//! depend on the scene alone. The choices are timed by turns, in CPU time of the one thread that does the work.

#![allow(clippy::disallowed_methods, reason = "charts are of measured times and errors")]

mod axis;
mod betting;
mod bright;
mod candidate;
mod canvas;
mod clock;
mod colours;
mod confirm;
mod cost;
mod data;
mod draw;
mod estimate;
mod files;
mod front;
mod goal;
mod hits;
mod judgement;
mod labels;
mod machine;
mod needed;
mod packets;
mod pictures;
mod progress;
mod right;
mod sampled;
mod small;
mod study;
mod times;
mod timings;
mod verdict;

pub use candidate::Load;
pub use colours::{Difference, difference};
pub use cost::Estimated;
pub use data::{Chart, Family, Panel, Point, Subject, WrongHits, WrongHitsOf};
pub use draw::{png, svg};
pub use estimate::estimates;
pub use files::{csv, json};
pub use goal::{Estimate, Estimates, Goal, Small};
pub use machine::Machine;
pub use progress::Progress;
pub use times::Times;
pub use timings::Cost;
pub use verdict::words;

use std::io;
use std::ops::ControlFlow;
use study::Study;
use tabray_core::render::plan::Plan;
use tabray_tools::unchecked;

/// Measures the cost and the error of a scene's choices. If `progress` breaks off a panel, the others are kept.
///
/// # Errors
/// Returns the errors of `load` and of starting threads.
pub fn measure(scene: &str, load: Load, progress: &mut dyn Progress) -> io::Result<Chart> {
    let mut study = Study::new(load)?;
    let mut chart = Chart::empty(scene);
    chart.unchecked = unchecked::of(&Plan::new(&study.candidates[study.default].model));
    chart.is_whole = study.run(load, &mut chart.panels, progress);
    Ok(chart)
}

/// Counts the wrong hits of a scene's methods alone, on sets of about these numbers of pairs of a ray and an object:
/// camera rays and grazing rays. If `progress` breaks off a set, those before it are kept.
///
/// # Errors
/// Returns the errors of [`measure`].
pub fn wrong_hits(
    load: Load,
    pairs: [usize; 2],
    progress: &mut dyn Progress,
) -> io::Result<Vec<WrongHitsOf>> {
    let study = Study::new(load)?;
    let sets = hits::sets(&study.candidates[study.strict].model, &hits::scans(&study), pairs);
    let counts = sets.iter().map_while(|set| hits::wrong(&study, set, progress).continue_value());
    Ok(counts.collect())
}

impl Chart {
    /// Makes the chart of a scene without any measurement.
    pub fn empty(scene: &str) -> Self {
        Self {
            scene: scene.to_owned(),
            machine: Machine::here(),
            panels: Vec::new(),
            unchecked: Vec::new(),
            is_whole: false,
        }
    }
}

/// The measurement of one panel.
type Part<'p> = Box<dyn FnOnce(&mut dyn Progress) -> ControlFlow<(), Option<Panel>> + 'p>;

/// The parts of the usual work that are done: first a coarse chart, and then each of its panels again.
const EFFORTS: [f64; 2] = [0.1, 1.0];

impl Study {
    /// Measures all panels, coarsely at first. Returns whether there is one of each.
    fn run(&mut self, load: Load, panels: &mut Vec<Panel>, progress: &mut dyn Progress) -> bool {
        let scans = hits::scans(self);
        let mut is_whole = false;
        for effort in EFFORTS {
            self.effort = effort;
            is_whole |= self.measure(&scans, load, panels, progress);
            if !is_whole {
                break;
            }
        }
        is_whole
    }

    /// Measures each panel, in place of one that was measured more coarsely. Returns whether all were measured.
    fn measure(
        &self,
        scans: &[hits::Scan],
        load: Load,
        panels: &mut Vec<Panel>,
        progress: &mut dyn Progress,
    ) -> bool {
        let sets =
            hits::sets(&self.candidates[self.strict].model, scans, hits::PAIRS.map(|pairs| self.part(pairs)));
        let candidates = self.candidates.len();
        let works = sets.iter().map(|set| hits::work(set, candidates)).sum::<usize>();
        progress.more(works + pictures::work(self));
        let of = |set| -> Part { Box::new(move |progress| hits::panel(self, set, progress)) };
        let mut parts: Vec<Part> = sets.iter().map(of).collect();
        parts.push(Box::new(|progress| ControlFlow::Continue(Some(pictures::methods(self, progress)?))));
        let model = &self.candidates[self.default].model;
        if pictures::goes_on(model) {
            parts.push(Box::new(|progress| pictures::depths(self, progress)));
        }
        parts.push(Box::new(|progress| pictures::samples(self, pictures::SampledEffect::Picture, progress)));
        if pictures::has_size(model) {
            parts.push(Box::new(|progress| {
                pictures::samples(self, pictures::SampledEffect::Shadows, progress)
            }));
        }
        parts.push(Box::new(|progress| match estimate::panel(load, self.effort, progress) {
            Ok(panel) => ControlFlow::Continue(Some(panel)),
            Err(_) => ControlFlow::Break(()),
        }));
        let (mut left, mut is_whole) = (parts.len(), true);
        for part in parts {
            progress.share(left);
            left -= 1;
            match part(progress) {
                ControlFlow::Continue(Some(panel)) => {
                    match panels.iter_mut().find(|coarse| coarse.title == panel.title) {
                        Some(coarse) => *coarse = panel,
                        None => panels.push(panel),
                    }
                }
                ControlFlow::Continue(None) => {}
                ControlFlow::Break(()) => is_whole = false,
            }
            progress.kept(panels);
            progress.share(left);
            if left > 0 && progress.done(0).is_break() {
                return false;
            }
        }
        is_whole
    }
}
