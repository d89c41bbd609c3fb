//! The tile loop: a model's pixels, on all threads.

use crate::cpu::Cpu;
use crate::model::Model;
use crate::picture::to_byte;
use crate::trace::Tracer;
use crate::watch::Watch;
use rayon::prelude::*;
use std::io;
use std::ops::{ControlFlow, Range};

/// Pixels of a picture that are in memory at one time, but for a picture of one longer row.
const BAND: usize = 1 << 22;

/// Room for the deepest chain of reflections that a pixel may cost. It is taken only where it is used.
const STACK: usize = 128 << 20;

/// The width and height of a tile, whose rays go together, in pixels.
pub(crate) const TILE: usize = 8;

/// The threads that render.
pub struct Renderer {
    pool: rayon::ThreadPool,
    cpu: Cpu,
}

impl Renderer {
    /// A renderer with this many threads; 0 for one on each core.
    ///
    /// # Errors
    /// Where the system does not give the threads.
    pub fn new(threads: usize) -> io::Result<Self> {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK);
        Ok(Self { pool: builder.build().map_err(io::Error::other)?, cpu: Cpu::best() })
    }

    /// With these instructions in place of the best that this machine has. The picture is the same.
    pub fn on(mut self, cpu: Cpu) -> Self {
        self.cpu = cpu;
        self
    }

    /// A part of the picture from the top, some rows at a time: red, green and blue of each pixel from the left.
    /// `columns` count from the left and `rows` from the top, and neither is empty.
    ///
    /// `done` is told of each row finished, in no order, and may break off; then comes nothing more but an
    /// error of kind `Interrupted`. The bytes depend on the model alone.
    pub fn bands<'r>(
        &'r self,
        model: &'r Model,
        columns: Range<usize>,
        rows: Range<usize>,
        done: &'r (dyn Fn() -> ControlFlow<()> + Sync),
    ) -> impl Iterator<Item = io::Result<Vec<u8>>> + 'r {
        self.watched_bands(model, columns, rows, done, &|()| {})
    }

    /// As [`bands`](Self::bands); a new watcher watches each strip of tiles, and `watched` gets it then, on any thread
    /// and in no order.
    pub fn watched_bands<'r, W: Watch + Default>(
        &'r self,
        model: &'r Model,
        columns: Range<usize>,
        rows: Range<usize>,
        done: &'r (dyn Fn() -> ControlFlow<()> + Sync),
        watched: &'r (dyn Fn(W) + Sync),
    ) -> impl Iterator<Item = io::Result<Vec<u8>>> + 'r {
        // Whole tiles.
        let step = (BAND / columns.len()).max(1).next_multiple_of(TILE);
        rows.clone().step_by(step).map(move |from| {
            let rows = from..rows.end.min(from + step);
            let bytes = self.rows(model, columns.clone(), rows, done, watched);
            bytes.ok_or_else(|| io::ErrorKind::Interrupted.into())
        })
    }

    /// The whole picture, as [`bands`](Self::bands) gives it in parts.
    pub fn picture(&self, model: &Model) -> Vec<u8> {
        let [width, height] = model.camera.value.pixels;
        self.rows(model, 0..width, 0..height, &|| ControlFlow::Continue(()), &|()| {}).unwrap_or_default()
    }

    fn rows<W: Watch + Default>(
        &self,
        model: &Model,
        columns: Range<usize>,
        rows: Range<usize>,
        done: &(dyn Fn() -> ControlFlow<()> + Sync),
        watched: &(dyn Fn(W) + Sync),
    ) -> Option<Vec<u8>> {
        let [_, height] = model.camera.value.pixels;
        let width = columns.len();
        let mut pixels = vec![[0; 3]; width * rows.len()];
        let strips = pixels.par_chunks_mut(TILE * width).zip(rows.into_par_iter().step_by(TILE));
        let finished = self.pool.install(|| {
            strips.try_for_each(|(strip, from_top)| {
                let (tall, mut watch) = (strip.len() / width, W::default());
                let top = height - 1 - from_top;
                let mut tracer = Tracer::new(model, self.cpu, &mut watch);
                for left in columns.clone().step_by(TILE) {
                    let (mut tile, mut len) = ([[0; 2]; TILE * TILE], 0);
                    for row in 0..tall {
                        for x in left..columns.end.min(left + TILE) {
                            tile[len] = [x, top - row];
                            len += 1;
                        }
                    }
                    tracer.pixels(&tile[..len], |[x, y], colour| {
                        strip[(top - y) * width + x - columns.start] = colour.to_array().map(to_byte);
                    });
                }
                watched(watch);
                (0..tall).try_for_each(|_| done())
            })
        });
        finished.is_continue().then(|| pixels.into_flattened())
    }

    /// Something of each pixel, from the top and from the left, for some rows counted from the top; nothing
    /// where `done` broke off.
    pub(crate) fn pixels<T: Clone + Default + Send>(
        &self,
        model: &Model,
        rows: Range<usize>,
        done: &(dyn Fn() -> ControlFlow<()> + Sync),
        pixel: impl Fn(usize, usize) -> T + Sync,
    ) -> Option<Vec<T>> {
        let [width, height] = model.camera.value.pixels;
        let mut pixels = vec![T::default(); width * rows.len()];
        let row = |(row, from_top): (&mut [T], usize)| {
            let y = height - 1 - from_top;
            for (x, place) in row.iter_mut().enumerate() {
                *place = pixel(x, y);
            }
            done()
        };
        let finished = self.pool.install(|| pixels.par_chunks_mut(width).zip(rows).try_for_each(row));
        finished.is_continue().then_some(pixels)
    }

    /// Runs something else on one of the threads, which have room for deep reflections.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }
}
