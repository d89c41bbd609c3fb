//! The tile loop: renders a model's pixels, on the threads of the caller.

use crate::parallel;
use crate::render::bytes::to_bytes;
use crate::render::flaws::Flaws;
use crate::render::observer::TraceObserver;
use crate::render::plan::Plan;
use crate::render::ray_stats::RayStats;
use crate::render::tiles::{self, BAND, Band, Strip, TILE, locked};
use crate::render::trace::{Scratch, Tracer};
use crate::simd::cpu::Cpu;
use rayon::ThreadPool;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;

/// The stack size of a thread in bytes that is enough for the deepest chain of reflections that the ray budget allows. The
/// system commits only what is used.
pub const STACK: usize = 128 << 20;

/// Callbacks that stop a renderer and report its progress.
#[derive(Clone, Copy)]
pub struct RenderCallbacks<'o> {
    /// Called before each tile, on any thread: returns whether this tile and all further ones are skipped. Once it has
    /// returned true, it must keep doing so.
    pub stops: &'o (dyn Fn() -> bool + Sync),
    /// Called for each row on which no work is left, on any thread and in no particular order.
    pub row: &'o (dyn Fn() + Sync),
}

/// Renders on threads of the caller.
///
/// By default these are those of the rayon pool that the caller is in, or rayon's own, or the calling thread where there
/// are none. The deepest chains of reflections may take a stack of [`STACK`] bytes.
///
/// ```
/// use tabray_core::render::{Renderer, renderer::STACK};
///
/// let pool = rayon::ThreadPoolBuilder::new().num_threads(2).stack_size(STACK).build()?;
/// let renderer = Renderer::on_threads(pool);
/// assert_eq!(renderer.run(rayon::current_num_threads), 2);
/// # Ok::<(), rayon::ThreadPoolBuildError>(())
/// ```
pub struct Renderer {
    pool: Option<ThreadPool>,
    cpu: Cpu,
}

impl Default for Renderer {
    fn default() -> Self {
        Self { pool: None, cpu: Cpu::best() }
    }
}

impl Renderer {
    /// Makes a renderer that runs on the threads of this pool.
    pub fn on_threads(pool: ThreadPool) -> Self {
        Self { pool: Some(pool), ..Self::default() }
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
    pub fn bands<'r, W: ImageObserver>(
        &'r self,
        plan: &'r Plan,
        columns: Range<usize>,
        rows: Range<usize>,
        watched: &'r (dyn Fn(W) + Sync),
    ) -> impl Iterator<Item = Band> + 'r {
        Band::split(&columns, &rows, BAND).map(move |rows| {
            let band = Band::blank(columns.clone(), rows);
            self.fill(plan, &band, RenderCallbacks { stops: &|| false, row: &|| () }, watched);
            band
        })
    }

    /// Renders the whole image: red, green and blue of each pixel, in rows from the top, each from the left.
    pub fn picture(&self, plan: &Plan) -> Vec<u8> {
        let [width, height] = plan.camera.pixels;
        let band = Band::blank(0..width, 0..height);
        self.fill(plan, &band, RenderCallbacks { stops: &|| false, row: &|| () }, &|_: Flaws| {});
        band.bytes(usize::MAX).concat()
    }

    /// Renders the tiles of a band that are not rendered yet, until the overseer stops it. Observers are passed to
    /// `watched` as in [`bands`](Self::bands).
    pub fn fill<W: ImageObserver>(
        &self,
        plan: &Plan,
        band: &Band,
        overseer: RenderCallbacks,
        watched: &(dyn Fn(W) + Sync),
    ) {
        W::fill(self, plan, band, overseer, watched);
    }

    fn fill_watched<W: TraceObserver + Default>(
        &self,
        plan: &Plan,
        band: &Band,
        overseer: RenderCallbacks,
        watched: &(dyn Fn(W) + Sync),
    ) {
        let strip = |scratch: &mut Scratch, index: usize| {
            let mut observer = W::default();
            let from_top = band.rows.start + TILE * index;
            let rows = from_top..band.rows.end.min(from_top + TILE);
            let tracer = Tracer::new(plan, self.cpu, scratch, &mut observer);
            self.strip(tracer, &band.strips[index], [&band.columns, &rows], overseer);
            watched(observer);
            rows.for_each(|_| (overseer.row)());
        };
        // With strips assigned beforehand, threads would wait for the slowest one.
        self.run(|| parallel::for_each_in_order(band.strips.len(), &strip));
    }

    /// Renders the tiles of one strip. `rows` count from the top.
    fn strip<W: TraceObserver>(
        &self,
        mut tracer: Tracer<W>,
        strip: &Mutex<Strip>,
        [columns, rows]: [&Range<usize>; 2],
        overseer: RenderCallbacks,
    ) {
        let (width, height) = (columns.len(), tracer.height());
        let (top, below) = (height - 1 - rows.start, height - rows.end);
        let (mut pixels, mut bytes) = (Vec::new(), [[0; 3]; TILE * TILE]);
        let display = tracer.display();
        let wide = |index: usize| {
            let left = columns.start + TILE * index;
            left..columns.end.min(left + TILE)
        };
        let left: Vec<_> = (0..width.div_ceil(TILE)).filter(|index| !locked(strip).tiles[*index]).collect();
        for indices in left.chunks(tracer.tiles_together()) {
            if (overseer.stops)() {
                break;
            }
            let rows = below..top + 1;
            pixels.clear();
            indices.iter().for_each(|index| tiles::list(wide(*index), rows.clone(), &mut pixels));
            let (colours, mut from) = (tracer.pixels(&pixels), 0);
            for index in indices {
                let count = wide(*index).len() * rows.len();
                to_bytes(self.cpu, &display, colours.part(from..from + count), &mut bytes[..count]);
                from += count;
                let mut rest = &bytes[..];
                let mut strip = locked(strip);
                for (run, y) in tiles::runs(wide(*index), rows.clone()) {
                    let (bytes, others) = rest.split_at(run.len());
                    strip.pixels[(top - y) * width + run.start - columns.start..][..run.len()]
                        .copy_from_slice(bytes);
                    rest = others;
                }
                strip.tiles[*index] = true;
            }
        }
    }

    /// Renders a part of the image with its colours before they are clamped and rounded: red, green and blue of each pixel, in rows from
    /// the top, each from the left. Returns `None` if the overseer stops it. Observers are passed to `watched` as in
    /// [`bands`](Self::bands).
    pub fn colours<W: ImageObserver>(
        &self,
        plan: &Plan,
        part: [&Range<usize>; 2],
        overseer: RenderCallbacks,
        watched: &(dyn Fn(W) + Sync),
    ) -> Option<Vec<f32>> {
        W::colours(self, plan, part, overseer, watched)
    }

    fn colours_watched<W: TraceObserver + Default>(
        &self,
        plan: &Plan,
        [columns, rows]: [&Range<usize>; 2],
        overseer: RenderCallbacks,
        watched: &(dyn Fn(W) + Sync),
    ) -> Option<Vec<f32>> {
        let (width, end, display) = (columns.len(), plan.camera.pixels[1], plan.camera.display());
        let mut all = vec![0.0; 3 * width * rows.len()];
        let strip = |index: usize, strip: &mut [f32]| {
            let mut observer = W::default();
            let (top, mut pixels, mut scratch) = (rows.start + TILE * index, Vec::new(), Scratch::default());
            let tall = strip.len() / (3 * width);
            let mut tracer = Tracer::new(plan, self.cpu, &mut scratch, &mut observer);
            let side = TILE * tracer.tiles_together();
            for left in columns.clone().step_by(side) {
                if (overseer.stops)() {
                    return ControlFlow::Break(());
                }
                let right = columns.end.min(left + side);
                pixels.clear();
                tiles::list(left..right, end - top - tall..end - top, &mut pixels);
                let colours = tracer.pixels(&pixels);
                for (index, [x, y]) in pixels.iter().enumerate() {
                    let at = 3 * ((end - 1 - y - top) * width + x - columns.start);
                    strip[at..at + 3]
                        .copy_from_slice(&display.full_range(colours.get(index)).as_vec3().to_array());
                }
            }
            watched(observer);
            (0..tall).for_each(|_| (overseer.row)());
            ControlFlow::Continue(())
        };
        let finished = self.run(|| parallel::chunks(&mut all, 3 * width * TILE, strip));
        finished.is_continue().then_some(all)
    }

    /// Computes a value for each pixel, in rows counted from the top, each from the left. Returns `None` if `done`,
    /// called after each row, breaks.
    pub fn pixels<T: Clone + Default + Send>(
        &self,
        plan: &Plan,
        rows: Range<usize>,
        done: &(dyn Fn() -> ControlFlow<()> + Sync),
        pixel: impl Fn(usize, usize) -> T + Sync,
    ) -> Option<Vec<T>> {
        let [width, height] = plan.camera.pixels;
        let mut pixels = vec![T::default(); width * rows.len()];
        let row = |index: usize, row: &mut [T]| {
            let y = height - 1 - rows.start - index;
            for (x, place) in row.iter_mut().enumerate() {
                *place = pixel(x, y);
            }
            done()
        };
        let finished = self.run(|| parallel::chunks(&mut pixels, width, row));
        finished.is_continue().then_some(pixels)
    }

    /// Runs other work on the threads.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => parallel::run_on(pool, work),
            None => work(),
        }
    }
}

/// An observer with which images are rendered. What traces rays for it is compiled in this crate, and not again in each that
/// renders.
pub trait ImageObserver: TraceObserver + Default {
    /// Does what [`Renderer::fill`] does.
    fn fill(
        renderer: &Renderer,
        plan: &Plan,
        band: &Band,
        overseer: RenderCallbacks,
        watched: &(dyn Fn(Self) + Sync),
    );
    /// Does what [`Renderer::colours`] does.
    fn colours(
        renderer: &Renderer,
        plan: &Plan,
        part: [&Range<usize>; 2],
        overseer: RenderCallbacks,
        watched: &(dyn Fn(Self) + Sync),
    ) -> Option<Vec<f32>>;
}

macro_rules! image_observers {
    ($($Observer:ty),*) => {$(
        impl ImageObserver for $Observer {
            fn fill(
                renderer: &Renderer,
                plan: &Plan,
                band: &Band,
                overseer: RenderCallbacks,
                watched: &(dyn Fn(Self) + Sync),
            ) {
                renderer.fill_watched(plan, band, overseer, watched);
            }

            fn colours(
                renderer: &Renderer,
                plan: &Plan,
                part: [&Range<usize>; 2],
                overseer: RenderCallbacks,
                watched: &(dyn Fn(Self) + Sync),
            ) -> Option<Vec<f32>> {
                renderer.colours_watched(plan, part, overseer, watched)
            }
        }
    )*};
}

image_observers!(Flaws, RayStats);
