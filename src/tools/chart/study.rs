//! All choices of a scene, ready to be measured.

use super::candidate::{self, Candidate, Load};
use crate::render::renderer::Renderer;
use crate::world::accuracy::Accuracy;
use std::io;

/// What measuring needs.
pub(super) struct Study {
    pub candidates: Vec<Candidate>,
    /// The one in the scene's own accuracy.
    pub default: usize,
    /// The one whose pictures count as true.
    pub strict: usize,
    /// All cores, for what is not timed.
    pub threads: Renderer,
    /// One thread, for what is.
    pub thread: Renderer,
}

impl Study {
    /// The choices of a scene, each loaded.
    pub fn new(load: Load) -> io::Result<Self> {
        let candidates = candidate::all(load)?;
        let position = |wanted: &dyn Fn(&Candidate) -> bool| candidates.iter().position(wanted).unwrap_or(0);
        let default = position(&|candidate| candidate.is_default);
        let strict = position(&|candidate| candidate.accuracy == Some(Accuracy::Strict));
        Ok(Self { default, strict, candidates, threads: Renderer::new(0)?, thread: Renderer::new(1)? })
    }
}
