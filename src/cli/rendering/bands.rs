//! Renders tiles: band by band as bytes, or as colours of full range. Does not wait for the last tile when it stops:
//! one packet of rays may take minutes.

use crate::options::max_error::LEVELS;
use crate::options::size::Region;
use crate::options::stop::Stop;
use crate::process::failure::{self, Failure};
use crate::process::progress::Progress;
use crate::process::{memory, messages};
use crate::rendering::flaws::{report_proofs, warn_of};
use crate::rendering::resume::ResumedImage;
use crate::rendering::stats::{Stats, Sum};
use std::mem::replace;
use std::ops::Range;
use std::panic;
use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread::{self, Builder, Scope};
use std::time::{Duration, Instant};
use tabray_core::render::division::Grid;
use tabray_core::render::flaws::Flaws;
use tabray_core::render::observer::TraceObserver;
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::RayStats;
use tabray_core::render::renderer::{RenderCallbacks, Renderer};
use tabray_core::render::tiles::{Band, TILE, with_alpha};
use tabray_tools::pixels::take_tile;

/// The memory for a pixel of full range, in bytes: its colour, with alpha, and its encoding.
pub const PIXEL: usize = 16 * 4;

/// The time between two questions whether rendering is to stop, while no tile is finished that would ask.
const ASK: Duration = Duration::from_millis(20);

/// The time that unfinished tiles may take when rendering stops.
const GRACE: Duration = Duration::from_millis(100);

/// Tiles of an image that are to be rendered, and how.
pub struct TileRender<'a> {
    pub plan: &'a Plan<'a>,
    /// The part of the camera's image that is the image.
    pub region: &'a Region,
    /// The tiles, by their indices in the region.
    pub tiles: Range<usize>,
    pub renderer: &'a Renderer,
    /// The maximum number of pixels in memory at one time.
    pub at_once: usize,
    pub stop: &'a Stop,
    pub stats: &'a Stats,
    /// Whether rays are counted.
    pub counts: bool,
}

impl TileRender<'_> {
    pub fn grid(&self) -> Grid {
        Grid { size: self.region.size() }
    }

    /// Returns the rows that have some of the tiles, counted from the top of the whole image.
    pub fn rows(&self) -> Range<usize> {
        let (rows, first) = (self.grid().rows(&self.tiles), self.region.rows.start);
        first + rows.start..first + rows.end
    }

    /// Lists those of the tiles that lie in a band, each with whether it is rendered.
    pub fn of_band(&self, band: &Band) -> Vec<(usize, bool)> {
        let first = self.strip(band) * self.grid().across();
        let all = (0..band.strips.len()).flat_map(|strip| band.strip(strip).tiles.clone());
        (first..).zip(all).filter(|(tile, _)| self.tiles.contains(tile)).collect()
    }

    /// Copies the pixels of a tile of a band.
    pub fn take(&self, band: &Band, tile: usize, bytes: &mut Vec<u8>) {
        let ([columns, rows], index) = (self.grid().tile(tile), tile / self.grid().across());
        let strip = band.strip(index - self.strip(band));
        let (place, width) = ([columns, 0..rows.len()], band.columns.len());
        take_tile(strip.pixels.as_flattened(), 3 * width, place.clone(), 3, bytes);
        if band.has_alpha {
            let mut alpha = Vec::new();
            take_tile(&strip.alpha, width, place, 1, &mut alpha);
            *bytes = with_alpha(bytes.as_chunks().0, &alpha);
        }
    }

    /// Returns the index of a band's first row of tiles.
    fn strip(&self, band: &Band) -> usize {
        (band.rows.start - self.region.rows.start) / TILE
    }

    /// Renders the tiles that a checkpoint does not have as bytes, and passes bands of them on, from the top. When
    /// rendering is to stop, the last band is unfinished, or there are fewer. If `take` fails then, the program ends
    /// with that, because threads may still be at work.
    pub fn bands<T>(
        &self,
        begun: &mut Option<ResumedImage>,
        take: impl FnOnce(&mut dyn Iterator<Item = Result<Band, Failure>>) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let progress = Progress::new(self.rows().len());
        let tally = &self.stats.tally;
        let row = || step(&progress, tally);
        let callbacks = RenderCallbacks { stops: &|| self.stop.is_due(), row: &row };
        let add_flaws = |flaws: Flaws| tally.add_flaws(&flaws);
        let add = |stats: RayStats| tally.add(&stats);
        thread::scope(|scope| {
            let mut told = false;
            let mut tell = || {
                if !replace(&mut told, true) {
                    progress.end();
                    self.stop.report();
                }
            };
            let mut render = |rows| {
                if self.stop.is_due() && begun.as_ref().is_none_or(ResumedImage::is_over) {
                    tell();
                    return None;
                }
                Some(self.begin(rows, begun.as_mut()).map(|mut band| {
                    self.stats.timed(|| match self.counts || self.plan.camera.certain {
                        true => self.fill(scope, &mut band, callbacks, &add),
                        false => self.fill(scope, &mut band, callbacks, &add_flaws),
                    });
                    if !band.is_whole() {
                        tell();
                    }
                    band
                }))
            };
            let rows = Band::split(&self.region.columns, &self.rows(), self.at_once);
            let outcome = take(&mut rows.map_while(&mut render).fuse());
            progress.end();
            self.report();
            match outcome {
                Err(failure) if self.stop.is_due() => failure::end(&failure),
                outcome => outcome,
            }
        })
    }

    /// Makes a band in which only those of the tiles are to be rendered that a checkpoint does not have.
    fn begin(&self, rows: Range<usize>, begun: Option<&mut ResumedImage>) -> Result<Band, Failure> {
        let columns = self.region.columns.clone();
        let has_alpha = self.plan.camera.alpha;
        memory::refuse_too_large(if has_alpha { 4 } else { 3 } * rows.len() * columns.len(), "the image")?;
        let band = Band::blank(columns, rows, has_alpha);
        let (first, across) = (self.strip(&band), self.grid().across());
        begun.map_or(Ok(()), |begun| begun.fill(&band, first))?;
        for strip in 0..band.strips.len() {
            let from = (first + strip) * across;
            for (tile, is_done) in (from..).zip(&mut band.strip(strip).tiles) {
                *is_done |= !self.tiles.contains(&tile);
            }
        }
        Ok(band)
    }

    /// Renders as [`Renderer::fill`] does, until rendering has stopped for a moment: then threads may be left that are at
    /// work on tiles, which the band does not get any more. The scope ends when they are done, so that whoever does not
    /// want to wait ends the program before.
    fn fill<'s, W: TraceObserver + Default>(
        &'s self,
        scope: &'s Scope<'s, '_>,
        band: &mut Band,
        callbacks: RenderCallbacks<'s>,
        watched: &'s (dyn Fn(W) + Sync),
    ) {
        let (renderer, plan) = (self.renderer, self.plan);
        if (callbacks.stops)() {
            return;
        }
        let (done, is_done) = mpsc::channel();
        let theirs = Band {
            columns: band.columns.clone(),
            rows: band.rows.clone(),
            strips: Arc::clone(&band.strips),
            has_alpha: band.has_alpha,
        };
        let work = move || {
            renderer.fill(plan, &theirs, callbacks, watched);
            let _ = done.send(());
        };
        if Builder::new().spawn_scoped(scope, work).is_err() {
            // Without one more thread, the last tiles are waited for.
            return renderer.fill(plan, band, callbacks, watched);
        }
        let mut stopped = None;
        loop {
            match is_done.recv_timeout(ASK) {
                Err(RecvTimeoutError::Timeout) => {}
                Ok(()) => return,
                // A thread panicked, and has said so.
                Err(RecvTimeoutError::Disconnected) => panic::resume_unwind(Box::new(())),
            }
            if (callbacks.stops)() && stopped.get_or_insert_with(Instant::now).elapsed() >= GRACE {
                renderer.leave_threads();
                *band = band.copied();
                return;
            }
        }
    }

    /// Renders the tiles in full range, and passes on the numbers of each rectangle of them, with its tiles, and its
    /// columns and rows in the region. Nothing is kept if rendering is stopped, which is then told with `unkept`.
    pub fn colours(
        &self,
        unkept: &'static str,
        mut take: impl FnMut(Range<usize>, [Range<usize>; 2], Vec<f32>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let (grid, Region { columns, rows }) = (self.grid(), self.region);
        let progress = Progress::new(self.rows().len());
        let tally = &self.stats.tally;
        let row = || step(&progress, tally);
        let callbacks = RenderCallbacks { stops: &|| self.stop.is_due(), row: &row };
        let add = |stats: RayStats| tally.add(&stats);
        self.stop.begin_unkept(unkept);
        let within = |all: &Range<usize>, part: &Range<usize>| all.start + part.start..all.start + part.end;
        for run in grid.rectangles(&self.tiles, self.at_once / (TILE * columns.len())) {
            let [first, last] = [grid.tile(run.start), grid.tile(run.end - 1)];
            let (wide, tall) = (first[0].start..last[0].end, first[1].start..last[1].end);
            memory::refuse_too_large(PIXEL * wide.len() * tall.len(), "the image")?;
            let whole = [&within(columns, &wide), &within(rows, &tall)];
            let mut colours = None;
            self.stats.timed(|| colours = self.renderer.colours(self.plan, whole, callbacks, &add));
            let Some(colours) = colours else {
                progress.end();
                self.report();
                self.stop.report();
                messages::note(unkept);
                return Err(Failure::Stopped);
            };
            take(run, [wide, tall], colours)?;
        }
        progress.end();
        self.report();
        Ok(())
    }

    /// Tells what is wrong with pixels, and what is proven of them.
    fn report(&self) {
        warn_of(&self.stats.tally.flaws(), self.plan.model);
        report_proofs(self.stats.tally.proofs(), self.plan);
    }
}

/// Counts a row as done, and shows the noise of what is done.
fn step(progress: &Progress, tally: &Sum) {
    tally.noise().into_iter().for_each(|noise| progress.set_noise(LEVELS * noise));
    progress.step();
}
