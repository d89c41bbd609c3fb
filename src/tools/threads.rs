//! The threads of the program.

use rayon::ThreadPoolBuilder;
use std::io;
use tabray_core::render::renderer::{Renderer, STACK};
use tabray_core::text;

/// Makes a renderer with this many threads of its own; 0 for one on each core.
///
/// # Errors
/// If the threads cannot be started.
pub fn renderer_with(threads: usize) -> io::Result<Renderer> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    let cannot = |error| {
        let reason = text::reason(&io::Error::other(error));
        io::Error::other(format!("cannot start threads to render with: {reason}"))
    };
    pool.map(Renderer::on_threads).map_err(cannot)
}
