//! Division of an image's tiles into parts of about equal work, which several machines may render.
//!
//! The work is estimated by a quick look: rays and tests are counted at some pixels, and no clock is read. So every
//! machine divides the image of the same plan in the same way.

use crate::observer::{Count, RayKind, TraceObserver};
use crate::plan::Plan;
use crate::renderer::Renderer;
use crate::tiles::TILE;
use crate::trace;
use std::iter;
use std::ops::Range;
use tabray_world::parallel;

/// The tiles of an image or of a part of one, in rows from the top, each from the left.
#[derive(Clone, Copy)]
pub struct Grid {
    /// The width and the height in pixels.
    pub size: [usize; 2],
}

impl Grid {
    /// Returns the number of tiles in a row.
    pub fn across(self) -> usize {
        self.size[0].div_ceil(TILE)
    }

    /// Returns the number of all tiles.
    pub fn count(self) -> usize {
        self.across() * self.size[1].div_ceil(TILE)
    }

    /// Returns the columns and the rows of a tile, from 0 at the upper left.
    pub fn tile(self, index: usize) -> [Range<usize>; 2] {
        let range = |at: usize, side: usize| TILE * at..side.min(TILE * (at + 1));
        [range(index % self.across(), self.size[0]), range(index / self.across(), self.size[1])]
    }

    /// Returns the number of pixels of a tile.
    pub fn pixels(self, index: usize) -> usize {
        let [columns, rows] = self.tile(index);
        columns.len() * rows.len()
    }

    /// Returns the number of pixels of some tiles.
    pub fn pixels_of(self, tiles: Range<usize>) -> usize {
        tiles.map(|index| self.pixels(index)).sum()
    }

    /// Divides tiles into runs that are rectangles of up to `most` rows of tiles: the rest of a row, whole rows, and
    /// the beginning of a row.
    pub fn rectangles(self, tiles: &Range<usize>, most: usize) -> impl Iterator<Item = Range<usize>> + use<> {
        let (mut next, end, across) = (tiles.start, tiles.end, self.across());
        iter::from_fn(move || {
            let start = next;
            let row_end = (start / across + 1) * across;
            next = if !start.is_multiple_of(across) || row_end > end {
                row_end.min(end)
            } else {
                (start + most.max(1) * across).min(end / across * across)
            };
            (start < end).then_some(start..next)
        })
    }

    /// Returns the rows of pixels that some tiles cover. There must be at least one tile.
    pub fn rows(self, tiles: &Range<usize>) -> Range<usize> {
        self.tile(tiles.start)[1].start..self.tile(tiles.end - 1)[1].end
    }
}

/// The minimum and the maximum number of pixels that are looked at.
const LOOKED_AT: [usize; 2] = [256, 1 << 14];

/// The number of samples of a part for each pixel that is looked at. Looking traces rays one by one, which takes
/// several times as long as rendering them, and should take about a hundredth of the time of a part.
const SAMPLES_PER_LOOK: usize = 500;

/// The work of a sample beside its rays, of a primary or shadow ray, of a ray reflected by a mirror or transmitted by
/// glass, and of the test of an object for one ray. With these weights, the times of 16 parts of the gallery's scenes
/// spread by 9 to 25 %; weighted by the number of rays alone, by 12 to 38 % (the standard deviation of their
/// logarithms).
const BESIDE: u64 = 1;
const RAY: u64 = 2;
const RAY_ONWARD: u64 = 4;
const TEST: u64 = 1;

/// Divides an image, or a part of one, into `parts` runs of tiles, and returns the ends of all runs, beginning with 0.
/// Each run has at least one tile, so there must be at least `parts` tiles. `columns` count from the left and `rows`
/// from the top.
pub fn divide(
    renderer: &Renderer,
    plan: &Plan,
    [columns, rows]: [&Range<usize>; 2],
    parts: usize,
) -> Vec<usize> {
    let grid = Grid { size: [columns.len(), rows.len()] };
    let look = WorkSamples::new(renderer, plan, [columns, rows], parts);
    let all: u128 = (0..grid.count()).map(|index| u128::from(look.work(grid, index))).sum();
    let (mut ends, mut done) = (vec![0], 0);
    for index in 0..grid.count() {
        done += u128::from(look.work(grid, index));
        let (next, ended) = (index + 1, ends.len());
        // The parts that are left must have a tile each.
        let must = grid.count() - next == parts - ended;
        if ended < parts && (must || done * parts as u128 >= all * ended as u128) {
            ends.push(next);
        }
    }
    ends.push(grid.count());
    ends
}

/// The work of an image, as counted at the middle of each cell of a coarse grid.
struct WorkSamples {
    /// The numbers of cells across and down.
    cells: [usize; 2],
    /// The work of one pixel of each cell, in rows from the top.
    work: Vec<u64>,
}

impl WorkSamples {
    fn new(renderer: &Renderer, plan: &Plan, [columns, rows]: [&Range<usize>; 2], parts: usize) -> Self {
        let size = [columns.len(), rows.len()];
        let pixels = size[0] * size[1];
        // Where pixels differ in their numbers of samples, counting those of a pixel takes all of them.
        let samples = if plan.camera.adaptive.is_some() { 1 } else { plan.camera.samples as usize };
        let [least, most] = LOOKED_AT;
        let count = (pixels.saturating_mul(samples) / parts / SAMPLES_PER_LOOK).clamp(least, most);
        let wide = (count as f64 * size[0] as f64 / size[1] as f64).sqrt().ceil() as usize;
        let across = wide.clamp(1, count).min(size[0]);
        let cells = [across, (count / across).clamp(1, size[1])];
        let work = |index: usize| {
            let middle = |side: usize, cell: usize| (2 * cell + 1) * size[side] / (2 * cells[side]);
            let (x, from_top) = (middle(0, index % cells[0]), middle(1, index / cells[0]));
            work(plan, columns.start + x, plan.camera.pixels[1] - 1 - rows.start - from_top)
        };
        Self { cells, work: renderer.run(|| parallel::map(cells[0] * cells[1], work)) }
    }

    /// Estimates the work of a tile: the work of the pixel looked at in the cell of the tile's middle, times the
    /// number of the tile's pixels.
    fn work(&self, grid: Grid, tile: usize) -> u64 {
        let [columns, rows] = grid.tile(tile);
        let cell = |side: usize, range: &Range<usize>| {
            let middle = range.start + range.len() / 2;
            middle * self.cells[side] / grid.size[side]
        };
        let at = cell(1, &rows) * self.cells[0] + cell(0, &columns);
        (columns.len() * rows.len()) as u64 * self.work[at]
    }
}

/// Counts the work of a pixel.
fn work(plan: &Plan, x: usize, y: usize) -> u64 {
    let mut work = Work(BESIDE);
    trace::observe_colour(plan, &plan.camera.sight(x as f64, y as f64), None, &mut work);
    u64::from(trace::samples(plan, x, y).0.max(1)) * work.0
}

struct Work(u64);

impl TraceObserver for Work {
    fn count(&mut self, count: Count) {
        self.0 += match count {
            Count::Rays(RayKind::Primary | RayKind::Shadow, rays) => RAY * rays as u64,
            Count::Rays(_, rays) => RAY_ONWARD * rays as u64,
            Count::Tested(_, tests) => TEST * tests as u64,
            _ => 0,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_of_a_grid_cover_each_pixel_once() {
        for size in [[1, 1], [16, 16], [37, 50], [320, 17]] {
            let grid = Grid { size };
            let mut seen = vec![0; size[0] * size[1]];
            for [columns, rows] in (0..grid.count()).map(|index| grid.tile(index)) {
                rows.for_each(|row| columns.clone().for_each(|column| seen[row * size[0] + column] += 1));
            }
            assert!(seen.iter().all(|count| *count == 1));
            assert_eq!(grid.pixels_of(0..grid.count()), size[0] * size[1]);
            for tiles in (0..grid.count()).flat_map(|from| (from + 1..=grid.count()).map(move |to| from..to))
            {
                let mut next = tiles.start;
                for run in grid.rectangles(&tiles, 2) {
                    let [first, last] = [grid.tile(run.start), grid.tile(run.end - 1)];
                    let pixels = (last[0].end - first[0].start) * (last[1].end - first[1].start);
                    assert_eq!((run.start, grid.pixels_of(run.clone())), (next, pixels));
                    next = run.end;
                }
                assert_eq!(next, tiles.end);
            }
        }
    }
}
