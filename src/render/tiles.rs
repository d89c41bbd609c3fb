//! The tiles of a picture, and which of them are rendered.

use std::iter;
use std::mem::take;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The width and height of a tile, whose rays go together, in pixels. Those at the right and lower edges may be smaller.
pub(crate) const TILE: usize = 16;

/// The pixels of a tile, or of a part of one: up to eight side by side at a time, by their columns and their row; those
/// together that are near each other.
pub(crate) fn runs(columns: Range<usize>, rows: Range<usize>) -> impl Iterator<Item = (Range<usize>, usize)> {
    const SIDE: usize = 8;
    rows.clone().step_by(SIDE).flat_map(move |low| {
        let (columns, end) = (columns.clone(), rows.end.min(low + SIDE));
        columns.clone().step_by(SIDE).flat_map(move |left| {
            let run = left..columns.end.min(left + SIDE);
            (low..end).map(move |y| (run.clone(), y))
        })
    })
}

/// Lists the pixels of all [`runs`], by column and row.
pub(crate) fn list(columns: Range<usize>, rows: Range<usize>, pixels: &mut Vec<[usize; 2]>) {
    pixels.clear();
    for (columns, y) in runs(columns, rows) {
        pixels.extend(columns.map(|x| [x, y]));
    }
}

/// Pixels of a picture that are in memory at one time, but for a picture of one longer row of tiles.
pub const BAND: usize = 1 << 22;

/// The tiles side by side in some rows of a picture.
pub struct Strip {
    /// Red, green and blue of each pixel, from the top and from the left; black where nothing is rendered.
    pub pixels: Vec<[u8; 3]>,
    /// Whether each tile is rendered, from the left.
    pub tiles: Vec<bool>,
}

/// Some rows of a picture, or of a part of one.
pub struct Band {
    /// Which columns, from the left of the whole picture.
    pub columns: Range<usize>,
    /// Which rows, from its top.
    pub rows: Range<usize>,
    /// Its strips, from the top. A thread that renders holds one only while it adds a tile.
    pub strips: Arc<[Mutex<Strip>]>,
}

impl Band {
    /// One of which nothing is rendered.
    pub fn blank(columns: Range<usize>, rows: Range<usize>) -> Self {
        let width = columns.len();
        let strip = |from: usize| {
            let pixels = vec![[0; 3]; width * TILE.min(rows.end - from)];
            Mutex::new(Strip { pixels, tiles: vec![false; width.div_ceil(TILE)] })
        };
        let strips = rows.clone().step_by(TILE).map(strip).collect();
        Self { columns, rows, strips }
    }

    /// The strip of this index, from the top.
    pub fn strip(&self, index: usize) -> MutexGuard<'_, Strip> {
        locked(&self.strips[index])
    }

    /// Whether all of it is rendered.
    pub fn is_whole(&self) -> bool {
        self.strips.iter().all(|strip| locked(strip).tiles.iter().all(|is_done| *is_done))
    }

    /// A copy of what is rendered of it, to which nothing is added by whoever is still at work on it.
    pub fn copied(&self) -> Self {
        let copy = |strip: &Mutex<Strip>| {
            let Strip { pixels, tiles } = &*locked(strip);
            Mutex::new(Strip { pixels: pixels.clone(), tiles: tiles.clone() })
        };
        let (columns, rows) = (self.columns.clone(), self.rows.clone());
        Self { columns, rows, strips: self.strips.iter().map(copy).collect() }
    }

    /// The bytes of its pixels, from the top and from the left: all at once where they are no more than this, and by
    /// strips.
    pub fn bytes(&self, at_once: usize) -> Vec<Vec<u8>> {
        let taken = self.strips.iter().map(|strip| take(&mut locked(strip).pixels));
        if 3 * self.columns.len() * self.rows.len() <= at_once {
            let mut all = Vec::with_capacity(3 * self.columns.len() * self.rows.len());
            taken.for_each(|pixels| all.extend_from_slice(pixels.as_flattened()));
            vec![all]
        } else {
            taken.map(Vec::into_flattened).collect()
        }
    }

    /// The rows of each band of a picture, from the top: whole tiles, and where there is a choice no more than so many
    /// pixels.
    pub fn split(
        columns: &Range<usize>,
        rows: &Range<usize>,
        pixels: usize,
    ) -> impl Iterator<Item = Range<usize>> + use<> {
        let height = (pixels / columns.len() / TILE).max(1) * TILE;
        let end = rows.end;
        rows.clone().step_by(height).map(move |from| from..end.min(from + height))
    }
}

/// A strip, to be read or to be added to. Whoever panics has added a whole tile or none.
pub(crate) fn locked(strip: &Mutex<Strip>) -> MutexGuard<'_, Strip> {
    strip.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Which tiles of a picture are rendered, as it comes band by band.
pub struct Tiles {
    width: usize,
    height: usize,
    strips: Vec<Done>,
}

/// What is rendered of the tiles side by side. A picture has few strips that are neither whole nor empty, so that this
/// takes little memory for large ones.
enum Done {
    Nothing,
    Whole,
    Part(Vec<bool>),
}

impl Tiles {
    /// None of a picture of this size yet.
    pub fn none([width, height]: [usize; 2]) -> Self {
        Self { width, height, strips: Vec::new() }
    }

    /// Adds those of the next band.
    pub fn add(&mut self, band: &Band) {
        self.strips.extend(band.strips.iter().map(|strip| match &locked(strip).tiles {
            tiles if tiles.iter().all(|is_done| *is_done) => Done::Whole,
            tiles if tiles.iter().any(|is_done| *is_done) => Done::Part(tiles.clone()),
            _ => Done::Nothing,
        }));
    }

    /// Whether each pixel of a row, counted from the top, is rendered.
    pub fn row(&self, row: usize) -> impl Iterator<Item = bool> + '_ {
        let strip = self.strips.get(row / TILE).unwrap_or(&Done::Nothing);
        (0..self.width).map(move |column| match strip {
            Done::Nothing => false,
            Done::Whole => true,
            Done::Part(tiles) => tiles[column / TILE],
        })
    }

    /// How many of the picture's pixels are rendered.
    pub fn pixels(&self) -> usize {
        let lengths = |side: usize| (0..side).step_by(TILE).map(move |from| TILE.min(side - from));
        let strips = iter::zip(&self.strips, lengths(self.height));
        strips
            .map(|(strip, tall)| match strip {
                Done::Nothing => 0,
                Done::Whole => tall * self.width,
                Done::Part(tiles) => {
                    tall * iter::zip(tiles, lengths(self.width))
                        .map(|(done, wide)| usize::from(*done) * wide)
                        .sum::<usize>()
                }
            })
            .sum()
    }

    /// How many rows there are to the end of the last strip of which anything is rendered.
    pub fn begun(&self) -> usize {
        let strips = self.strips.iter().rposition(|strip| !matches!(strip, Done::Nothing));
        strips.map_or(0, |last| self.height.min((last + 1) * TILE))
    }

    /// Whether the whole picture is rendered.
    pub fn is_whole(&self) -> bool {
        self.pixels() == self.width * self.height
    }
}
