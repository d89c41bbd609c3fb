//! What each choice costs in a scene and how wrong it is: speed charted against accuracy.
//!
//! The choices are those that a scene has: ways to find the hits of its shapes, and samples for each pixel. Their
//! errors are counted against the truth (proven hits, distances to 30 digits; pictures of a thousand samples), and
//! depend on the scene alone. Their times are taken by turns, in CPU time of the one thread that does the work.

mod axis;
mod candidate;
mod canvas;
mod clock;
mod colours;
mod data;
mod draw;
mod estimate;
mod files;
mod front;
mod hits;
mod labels;
mod machine;
mod packets;
mod pictures;
mod places;
mod progress;
mod study;
mod verdict;

pub use candidate::Load;
pub use clock::Times;
pub use data::{Chart, Family, Panel, Point, Subject, Wrong};
pub use draw::{png, svg};
pub use estimate::{Estimate, estimates};
pub use files::{csv, json};
pub use machine::Machine;
pub use progress::Progress;
pub use verdict::words;

use std::io;
use std::ops::ControlFlow;
use study::Study;

/// Measures what a scene's choices cost and how wrong they are. Where `progress` breaks off, what is measured by then
/// is kept.
///
/// # Errors
/// Those of `load`, and of threads that are not to be had.
pub fn measure(scene: &str, load: Load, progress: &mut dyn Progress) -> io::Result<Chart> {
    let study = Study::new(load)?;
    let mut chart =
        Chart { scene: scene.to_owned(), machine: Machine::here(), panels: Vec::new(), is_whole: false };
    chart.is_whole = study.run(&mut chart.panels, progress).is_continue();
    Ok(chart)
}

impl Study {
    fn run(&self, panels: &mut Vec<Panel>, progress: &mut dyn Progress) -> ControlFlow<()> {
        let sets = hits::sets(&self.candidates[self.strict].model);
        let candidates = self.candidates.len();
        let works = sets.iter().map(|set| hits::work(set, candidates)).sum::<usize>();
        progress.more(works + pictures::work(self));
        for set in &sets {
            panels.extend(hits::panel(self, set, progress)?);
            progress.kept();
        }
        panels.push(pictures::methods(self, progress)?);
        progress.kept();
        panels.extend(pictures::samples(self, pictures::Seen::Picture, progress)?);
        if self.candidates[self.default].model.lights.iter().any(|light| light.value.size() > 0.0) {
            panels.extend(pictures::samples(self, pictures::Seen::Shadows, progress)?);
        }
        ControlFlow::Continue(())
    }
}
