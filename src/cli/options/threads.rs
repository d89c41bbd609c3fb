//! `--threads`: on how many threads a command works.

use super::number::whole;
use std::io;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::tiles::TILE;
use tabray_tools::threads::renderer_with;

/// The number of threads.
#[derive(clap::Args, Clone, Copy)]
#[group(skip)]
pub struct Args {
    /// The number of threads; by default one per core
    #[arg(long, value_name = "N", value_parser = whole::<u16>(1..=1024))]
    threads: Option<u16>,
}

impl Args {
    /// Returns the number of threads, 0 for one per core.
    pub fn count(self) -> usize {
        self.threads.unwrap_or(0).into()
    }

    /// Starts the threads.
    pub fn renderer(self) -> io::Result<Renderer> {
        renderer_with(self.count())
    }

    /// Starts the threads for an image with this many rows: one for an image of one strip of tiles, which one thread renders.
    pub fn renderer_for(self, rows: usize) -> io::Result<Renderer> {
        renderer_with(if rows <= TILE { 1 } else { self.count() })
    }
}
