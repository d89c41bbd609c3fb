//! All choices of a scene, ready to be measured.

use super::candidate::{self, Candidate, Load};
use super::pictures;
use std::io;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::world::accuracy::Accuracy;
use tabray_tools::threads::renderer_with;

/// The inputs of a measurement.
pub(super) struct Study {
    pub candidates: Vec<Candidate>,
    /// The index of the candidate with the scene's own accuracy.
    pub default: usize,
    /// The index of the candidate whose images count as true.
    pub strict: usize,
    /// The part of the usual work that is done, at most 1.
    pub effort: f64,
    /// The mean number of object tests for one ray from the viewer and all rays that follow from it.
    pub tests: f64,
    /// A renderer on all cores, for work that is not timed.
    pub threads: Renderer,
    /// A renderer on one thread, for work that is timed.
    pub thread: Renderer,
}

impl Study {
    /// Returns the part of a usual amount of work that is done.
    pub fn part(&self, usual: usize) -> usize {
        (usual as f64 * self.effort) as usize
    }

    /// Loads all choices of a scene.
    pub fn new(load: Load) -> io::Result<Self> {
        let candidates = candidate::all(load)?;
        let position = |wanted: &dyn Fn(&Candidate) -> bool| candidates.iter().position(wanted).unwrap_or(0);
        let default = position(&|candidate| candidate.is_default);
        let strict = position(&|candidate| candidate.accuracy == Some(Accuracy::Strict));
        let (threads, thread) = (renderer_with(0)?, renderer_with(1)?);
        let tests = pictures::tests(&Plan::new(&candidates[default].model), &threads);
        Ok(Self { default, strict, candidates, effort: 1.0, tests, threads, thread })
    }
}
