//! The tile loop: renders a model's pixels, on all threads.

use crate::render::bytes::to_bytes;
use crate::render::observer::TraceObserver;
use crate::render::plan::Plan;
use crate::render::tiles::{self, BAND, Band, TILE};
use crate::render::trace::{Scratch, Tracer};
use crate::simd::cpu::Cpu;
use crate::text;
use rayon::prelude::*;
use std::io;
use std::ops::{ControlFlow, Range};

/// The stack size of a thread in bytes, enough for the deepest chain of reflections that the ray budget allows. The
/// system commits only what is used.
const STACK: usize = 128 << 20;

/// Callbacks that stop a renderer and report its progress.
#[derive(Clone, Copy)]
pub struct Overseer<'o> {
    /// Called before each tile, on any thread: returns whether this tile and all further ones are skipped. Once it has
    /// returned true, it must keep doing so.
    pub stops: &'o (dyn Fn() -> bool + Sync),
    /// Called for each row on which no work is left, on any thread and in no particular order.
    pub row: &'o (dyn Fn() + Sync),
}

/// A pool of threads that render.
pub struct Renderer {
    pool: rayon::ThreadPool,
    cpu: Cpu,
}

impl Renderer {
    /// Makes a renderer with this many threads; 0 for one on each core.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn new(threads: usize) -> io::Result<Self> {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK);
        let cannot = |error| {
            let reason = text::reason(&io::Error::other(error));
            io::Error::other(format!("cannot start threads to render with: {reason}"))
        };
        Ok(Self { pool: builder.build().map_err(cannot)?, cpu: Cpu::best() })
    }

    /// Uses this instruction set in place of the best that this machine has. The image is the same.
    pub fn on(mut self, cpu: Cpu) -> Self {
        self.cpu = cpu;
        self
    }

    /// Renders a part of the image from the top, some rows at a time. `columns` count from the left and `rows` from the
    /// top, and neither is empty. The pixels depend on the plan alone, not on the threads.
    ///
    /// Each strip of tiles has a new observer, which is then passed to `watched`, on any thread and in no particular
    /// order.
    pub fn bands<'r, W: TraceObserver + Default>(
        &'r self,
        plan: &'r Plan,
        columns: Range<usize>,
        rows: Range<usize>,
        watched: &'r (dyn Fn(W) + Sync),
    ) -> impl Iterator<Item = Band> + 'r {
        Band::split(&columns, &rows, BAND).map(move |rows| {
            let mut band = Band::blank(columns.clone(), rows);
            self.fill(plan, &mut band, Overseer { stops: &|| false, row: &|| () }, watched);
            band
        })
    }

    /// Renders the whole image: red, green and blue of each pixel, in rows from the top, each from the left.
    pub fn picture(&self, plan: &Plan) -> Vec<u8> {
        let [width, height] = plan.camera.pixels;
        let mut band = Band::blank(0..width, 0..height);
        self.fill(plan, &mut band, Overseer { stops: &|| false, row: &|| () }, &|()| {});
        band.pixels.into_flattened()
    }

    /// Renders the tiles of a band that are not rendered yet, until the overseer stops it. Observers are passed to
    /// `watched` as in [`bands`](Self::bands).
    pub fn fill<W: TraceObserver + Default>(
        &self,
        plan: &Plan,
        band: &mut Band,
        overseer: Overseer,
        watched: &(dyn Fn(W) + Sync),
    ) {
        let [_, height] = plan.camera.pixels;
        let Band { columns, rows, pixels, tiles } = band;
        let width = columns.len();
        let strips = pixels.chunks_mut(TILE * width).zip(tiles.chunks_mut(width.div_ceil(TILE)));
        let strips = strips.zip(rows.clone().step_by(TILE));
        self.pool.install(|| {
            // Each thread takes the next strip when it is free: with strips assigned beforehand, threads would wait for
            // the slowest one.
            strips.par_bridge().for_each_init(Scratch::default, |scratch, ((strip, tiles), from_top)| {
                let (tall, mut observer) = (strip.len() / width, W::default());
                let top = height - 1 - from_top;
                let mut tracer = Tracer::new(plan, self.cpu, scratch, &mut observer);
                let (mut tile, mut bytes) = (Vec::new(), [[0; 3]; TILE * TILE]);
                for (left, is_done) in columns.clone().step_by(TILE).zip(tiles) {
                    if *is_done {
                        continue;
                    }
                    if (overseer.stops)() {
                        break;
                    }
                    let (wide, rows) = (left..columns.end.min(left + TILE), top + 1 - tall..top + 1);
                    tiles::list(wide.clone(), rows.clone(), &mut tile);
                    let colours = tracer.pixels(&tile);
                    to_bytes(self.cpu, colours, &mut bytes[..tile.len()]);
                    let mut rest = &bytes[..];
                    for (run, y) in tiles::runs(wide, rows) {
                        let (bytes, others) = rest.split_at(run.len());
                        strip[(top - y) * width + run.start - columns.start..][..run.len()]
                            .copy_from_slice(bytes);
                        rest = others;
                    }
                    *is_done = true;
                }
                watched(observer);
                (0..tall).for_each(|_| (overseer.row)());
            });
        });
    }

    /// Computes a value for each pixel, in rows counted from the top, each from the left. Returns `None` if `done`,
    /// called after each row, breaks.
    pub(crate) fn pixels<T: Clone + Default + Send>(
        &self,
        plan: &Plan,
        rows: Range<usize>,
        done: &(dyn Fn() -> ControlFlow<()> + Sync),
        pixel: impl Fn(usize, usize) -> T + Sync,
    ) -> Option<Vec<T>> {
        let [width, height] = plan.camera.pixels;
        let mut pixels = vec![T::default(); width * rows.len()];
        let row = |(row, from_top): (&mut [T], usize)| {
            let y = height - 1 - from_top;
            for (x, place) in row.iter_mut().enumerate() {
                *place = pixel(x, y);
            }
            done()
        };
        let finished =
            self.pool.install(|| pixels.par_chunks_mut(width).with_max_len(1).zip(rows).try_for_each(row));
        finished.is_continue().then_some(pixels)
    }

    /// Runs other work on one of the threads, whose stacks are large enough for deep reflections.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }
}
