//! The tile loop: renders a model's pixels, on the threads of the caller.

use crate::bytes::{to_bytes, to_bytes_with_alpha};
use crate::flaws::Flaws;
use crate::observer::TraceObserver;
use crate::plan::Plan;
use crate::tiles::{self, BAND, Band, Strip, TILE, locked};
use crate::trace::{Scratch, Tracer};
use rayon::ThreadPool;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};
use tabray_world::material::Rgb;
use tabray_world::parallel;
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::View;

/// A thread's stack size in bytes, enough for the deepest chain of reflections that the ray budget allows. The system
/// commits only the memory that is used.
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
/// By default, the threads are those of the rayon pool that the caller is in, or rayon's own threads, or the calling
/// thread where there are none. The deepest chains of reflections may take a stack of [`STACK`] bytes.
///
/// ```
/// use tabray_render::{Renderer, renderer::STACK};
///
/// let pool = rayon::ThreadPoolBuilder::new().num_threads(2).stack_size(STACK).build()?;
/// let renderer = Renderer::on_threads(pool);
/// assert_eq!(renderer.run(rayon::current_num_threads), 2);
/// # Ok::<(), rayon::ThreadPoolBuildError>(())
/// ```
pub struct Renderer {
    pool: Option<ThreadPool>,
    cpu: Cpu,
    /// Whether threads of the pool may still be at work on tiles that nobody waits for.
    is_left: AtomicBool,
}

impl Default for Renderer {
    fn default() -> Self {
        Self { pool: None, cpu: Cpu::best(), is_left: AtomicBool::new(false) }
    }
}

impl Renderer {
    /// Makes a renderer that runs on the threads of this pool.
    pub fn on_threads(pool: ThreadPool) -> Self {
        Self { pool: Some(pool), ..Self::default() }
    }

    /// Uses this instruction set instead of the best one of this machine. The image is the same.
    pub fn on(mut self, cpu: Cpu) -> Self {
        self.cpu = cpu;
        self
    }

    /// Renders a part of the image from the top, some rows at a time. `columns` count from the left and `rows` from the
    /// top, and neither is empty. The pixels depend only on the plan, not on the threads.
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
            let band = Band::blank(columns.clone(), rows, plan.camera.alpha);
            self.fill(plan, &band, RenderCallbacks { stops: &|| false, row: &|| () }, watched);
            band
        })
    }

    /// Renders the whole image: red, green and blue of each pixel, with alpha if the plan's camera has that, in rows from
    /// the top, each from the left.
    pub fn picture(&self, plan: &Plan) -> Vec<u8> {
        let [width, height] = plan.camera.pixels;
        let band = Band::blank(0..width, 0..height, plan.camera.alpha);
        self.fill(plan, &band, RenderCallbacks { stops: &|| false, row: &|| () }, &|_: Flaws| {});
        band.bytes(usize::MAX).concat()
    }

    /// Renders the tiles of a band that are not rendered yet, until the overseer stops it. Observers are passed to
    /// `watched` as in [`bands`](Self::bands).
    pub fn fill<W: TraceObserver + Default>(
        &self,
        plan: &Plan,
        band: &Band,
        overseer: RenderCallbacks,
        watched: &(dyn Fn(W) + Sync),
    ) {
        self.fill_by(plan, band, overseer.row, &|scratch, tiles, sink| {
            watched(trace::<W>(plan, self.cpu, scratch, tiles, overseer.stops, sink).0);
        });
    }

    /// Renders the tiles of a band with a function for those of one strip. This code is compiled in this crate, once
    /// for all observers.
    fn fill_by(
        &self,
        plan: &Plan,
        band: &Band,
        row: &(dyn Fn() + Sync),
        trace: &(dyn Fn(&mut Scratch, &StripTiles, &mut TileSink) + Sync),
    ) {
        let ([_, height], display) = (plan.camera.pixels, plan.camera.display());
        let (left, width) = (band.columns.start, band.columns.len());
        let strip = |scratch: &mut Scratch, index: usize| {
            let top = band.rows.start + TILE * index;
            let rows = top..band.rows.end.min(top + TILE);
            let strip = &band.strips[index];
            let is_done = locked(strip).tiles.clone();
            let open = (0..is_done.len()).filter(|tile| !is_done[*tile]).collect();
            let (mut bytes, mut alphas) = ([[0; 3]; TILE * TILE], [0; TILE * TILE]);
            let mut add = |tile: usize, pixels: &[[usize; 2]], colours: View, alpha: &[f64]| {
                let (bytes, alphas) = (&mut bytes[..pixels.len()], &mut alphas[..pixels.len()]);
                match band.has_alpha {
                    true => to_bytes_with_alpha(&display, (colours, alpha), bytes, alphas),
                    false => to_bytes(self.cpu, &display, colours, bytes),
                }
                let (mut strip, mut rest, mut rest_of_alpha) = (locked(strip), &bytes[..], &alphas[..]);
                let from = left + TILE * tile;
                let columns = from..band.columns.end.min(from + TILE);
                let Strip { pixels, alpha, .. } = &mut *strip;
                tiles::for_each_run(columns, height - rows.end..height - top, |run, y| {
                    let (bytes, others) = rest.split_at(run.len());
                    let at = (height - 1 - y - top) * width + run.start - left;
                    if band.has_alpha {
                        let (alphas, others) = rest_of_alpha.split_at(run.len());
                        alpha[at..at + run.len()].copy_from_slice(alphas);
                        rest_of_alpha = others;
                    }
                    let row = &mut pixels[at..];
                    match (row.first_chunk_mut::<{ tiles::SIDE }>(), bytes.first_chunk()) {
                        (Some(row), Some(bytes)) => *row = *bytes,
                        _ => row[..run.len()].copy_from_slice(bytes),
                    }
                    rest = others;
                });
                strip.tiles[tile] = true;
            };
            trace(scratch, &StripTiles { columns: &band.columns, rows: &rows, indices: open }, &mut add);
            rows.for_each(|_| row());
        };
        // With strips assigned beforehand, threads would wait for the slowest one.
        self.run(|| parallel::for_each_in_order(band.strips.len(), &strip));
    }

    /// Renders a part of the image without clamping or rounding its light. Returns the values that `of` makes from
    /// the light and the alpha of each pixel, in rows from the top, each from the left, or `None` if the overseer stops it.
    /// Light is premultiplied; where the plan's camera has no alpha, it is 1.
    /// Observers are passed to `watched` as in [`bands`](Self::bands).
    pub fn light<W: TraceObserver + Default, T: Clone + Default + Send>(
        &self,
        plan: &Plan,
        [columns, rows]: [&Range<usize>; 2],
        overseer: RenderCallbacks,
        watched: &(dyn Fn(W) + Sync),
        of: &(dyn Fn(Rgb, f64) -> T + Sync),
    ) -> Option<Vec<T>> {
        let [_, height] = plan.camera.pixels;
        let (left, width) = (columns.start, columns.len());
        let mut all = vec![T::default(); width * rows.len()];
        let strip = |index: usize, strip: &mut [T]| {
            let top = rows.start + TILE * index;
            let rows = top..top + strip.len() / width;
            let mut add = |_: usize, pixels: &[[usize; 2]], colours: View, alpha: &[f64]| {
                for (index, [x, y]) in pixels.iter().enumerate() {
                    let alpha = alpha.get(index).copied().unwrap_or(1.0);
                    strip[(height - 1 - y - top) * width + x - left] = of(colours.get(index), alpha);
                }
            };
            let indices = (0..width.div_ceil(TILE)).collect();
            let tiles = StripTiles { columns, rows: &rows, indices };
            let mut scratch = Scratch::default();
            let (observer, flow) = trace::<W>(plan, self.cpu, &mut scratch, &tiles, overseer.stops, &mut add);
            watched(observer);
            rows.for_each(|_| (overseer.row)());
            flow
        };
        let finished = self.run(|| parallel::chunks(&mut all, width * TILE, strip));
        finished.is_continue().then_some(all)
    }

    /// Renders a part of the image as [`light`](Self::light) does, with the values of files of full range: red, green
    /// and blue of each pixel, premultiplied and with alpha if the plan's camera has that.
    pub fn colours<W: TraceObserver + Default>(
        &self,
        plan: &Plan,
        part: [&Range<usize>; 2],
        overseer: RenderCallbacks,
        watched: &(dyn Fn(W) + Sync),
    ) -> Option<Vec<f32>> {
        let display = plan.camera.display();
        let of = |light: Rgb, _: f64| display.full_range(light).as_vec3().to_array();
        let with_alpha =
            |light: Rgb, alpha: f64| display.full_range(light).as_vec3().extend(alpha as f32).to_array();
        match plan.camera.alpha {
            true => self.light(plan, part, overseer, watched, &with_alpha).map(Vec::into_flattened),
            false => self.light(plan, part, overseer, watched, &of).map(Vec::into_flattened),
        }
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

    /// Runs other work on the renderer's threads, or on the caller's once the renderer's own have been
    /// [left](Self::leave_threads).
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) if !self.is_left.load(Ordering::Relaxed) => parallel::run_on(pool, work),
            _ => work(),
        }
    }

    /// Leaves the threads to abandoned tiles, which may take hours. No other work waits for them.
    pub fn leave_threads(&self) {
        self.is_left.store(true, Ordering::Relaxed);
    }
}

/// Tiles of one strip of an image.
pub struct StripTiles<'s> {
    /// The columns of the strip, counted from the left of the image.
    columns: &'s Range<usize>,
    /// The rows of the strip, counted from the top of the image.
    rows: &'s Range<usize>,
    /// The indices of the tiles, from the left.
    indices: Vec<usize>,
}

/// Takes the colours of a tile: its index in the strip, its pixels by column and row from the bottom, and a colour for
/// each, with alpha if there is any.
type TileSink<'s> = dyn FnMut(usize, &[[usize; 2]], View, &[f64]) + 's;

/// Computes the colours of tiles with a new observer. Returns the observer, and `Break` if `stops` returned true.
fn trace<W: TraceObserver + Default>(
    plan: &Plan,
    cpu: Cpu,
    scratch: &mut Scratch,
    StripTiles { columns, rows, indices }: &StripTiles,
    stops: &dyn Fn() -> bool,
    sink: &mut TileSink,
) -> (W, ControlFlow<()>) {
    let mut observer = W::default();
    let mut tracer = Tracer::new(plan, cpu, scratch, &mut observer);
    let [_, height] = plan.camera.pixels;
    let (rows, mut pixels, mut flow) =
        (height - rows.end..height - rows.start, Vec::new(), ControlFlow::Continue(()));
    for together in indices.chunks(tracer.tiles_together()) {
        if stops() {
            flow = ControlFlow::Break(());
            break;
        }
        pixels.clear();
        let end = |index: &usize| {
            let left = columns.start + TILE * index;
            tiles::list(left..columns.end.min(left + TILE), rows.clone(), &mut pixels);
            pixels.len()
        };
        let ends: Vec<usize> = together.iter().map(end).collect();
        let ((colours, alpha), mut start) = (tracer.pixels_with_alpha(&pixels), 0);
        for (index, end) in together.iter().zip(ends) {
            let alpha = if alpha.is_empty() { alpha } else { &alpha[start..end] };
            sink(*index, &pixels[start..end], colours.part(start..end), alpha);
            start = end;
        }
    }
    (observer, flow)
}
