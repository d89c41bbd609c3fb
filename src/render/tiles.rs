//! The tiles of an image, and which of them are rendered.

use std::array;
use std::mem::take;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The width and height of a tile in pixels. The rays of a tile are traced together. Tiles at the right and lower
/// edges may be smaller.
pub const TILE: usize = 16;

/// The number of tiles that are traced together where pixels differ in their numbers of samples. Few pixels of a tile
/// may take more samples, and packets should be full.
pub const TOGETHER: usize = 8;

/// The width and height of a block, in pixels.
pub(crate) const SIDE: usize = 8;

/// Calls a function for each run of up to eight pixels of a tile, with its columns and its row. The runs go through
/// blocks of 8 x 8 pixels, so consecutive pixels are close together.
#[inline]
pub(crate) fn for_each_run(
    columns: Range<usize>,
    rows: Range<usize>,
    mut each: impl FnMut(Range<usize>, usize),
) {
    for low in rows.clone().step_by(SIDE) {
        for left in columns.clone().step_by(SIDE) {
            let run = left..columns.end.min(left + SIDE);
            (low..rows.end.min(low + SIDE)).for_each(|y| each(run.clone(), y));
        }
    }
}

/// Adds the pixels of a tile to `pixels`, by column and row.
pub fn list(columns: Range<usize>, rows: Range<usize>, pixels: &mut Vec<[usize; 2]>) {
    for_each_run(columns, rows, |columns, y| match columns.len() {
        SIDE => pixels.extend_from_slice(&array::from_fn::<_, SIDE, _>(|x| [columns.start + x, y])),
        _ => pixels.extend(columns.map(|x| [x, y])),
    });
}

/// The maximum number of pixels that are in memory at one time, unless one row of tiles has more.
pub const BAND: usize = 1 << 22;

/// A row of tiles of an image.
pub struct Strip {
    /// Red, green and blue of each pixel, in rows from the top, each from the left; black where nothing is rendered.
    pub pixels: Vec<[u8; 3]>,
    /// The alpha of each pixel; empty where the image has none.
    pub alpha: Vec<u8>,
    /// Whether each tile is rendered, from the left.
    pub tiles: Vec<bool>,
}

impl Strip {
    /// Takes the bytes of the pixels: three or, with alpha, four of each.
    fn take_bytes(&mut self) -> Vec<u8> {
        let (pixels, alpha) = (take(&mut self.pixels), take(&mut self.alpha));
        if alpha.is_empty() { pixels.into_flattened() } else { with_alpha(&pixels, &alpha) }
    }
}

/// Joins the colours of pixels and their alpha.
pub fn with_alpha(pixels: &[[u8; 3]], alpha: &[u8]) -> Vec<u8> {
    let joined = pixels.iter().zip(alpha).map(|([red, green, blue], alpha)| [*red, *green, *blue, *alpha]);
    joined.collect::<Vec<_>>().into_flattened()
}

/// Some rows of an image, or of a part of one.
pub struct Band {
    /// The columns, counted from the left of the whole image.
    pub columns: Range<usize>,
    /// The rows, counted from the top of the whole image.
    pub rows: Range<usize>,
    /// The rows of tiles, from the top. A rendering thread locks a row only while it adds a tile.
    pub strips: Arc<[Mutex<Strip>]>,
    /// Whether the pixels have alpha.
    pub has_alpha: bool,
}

impl Band {
    /// Makes a band without rendered pixels. With alpha, they are transparent.
    pub fn blank(columns: Range<usize>, rows: Range<usize>, has_alpha: bool) -> Self {
        let width = columns.len();
        let strip = |from: usize| {
            let pixels = vec![[0; 3]; width * TILE.min(rows.end - from)];
            let alpha = vec![0; if has_alpha { pixels.len() } else { 0 }];
            Mutex::new(Strip { pixels, alpha, tiles: vec![false; width.div_ceil(TILE)] })
        };
        let strips = rows.clone().step_by(TILE).map(strip).collect();
        Self { columns, rows, strips, has_alpha }
    }

    /// Returns the number of bytes of a pixel.
    pub fn pixel(&self) -> usize {
        if self.has_alpha { 4 } else { 3 }
    }

    /// Locks a row of tiles, by its index from the top.
    pub fn strip(&self, index: usize) -> MutexGuard<'_, Strip> {
        locked(&self.strips[index])
    }

    /// Tells whether all tiles are rendered.
    pub fn is_whole(&self) -> bool {
        self.strips.iter().all(|strip| locked(strip).tiles.iter().all(|is_done| *is_done))
    }

    /// Copies the rendered tiles of the band. Threads that are still at work on the band add nothing to the copy.
    pub fn copied(&self) -> Self {
        let copy = |strip: &Mutex<Strip>| {
            let Strip { pixels, alpha, tiles } = &*locked(strip);
            Mutex::new(Strip { pixels: pixels.clone(), alpha: alpha.clone(), tiles: tiles.clone() })
        };
        let (columns, rows, has_alpha) = (self.columns.clone(), self.rows.clone(), self.has_alpha);
        Self { columns, rows, strips: self.strips.iter().map(copy).collect(), has_alpha }
    }

    /// Takes the bytes of the pixels, in rows from the top: in one piece if they are at most `at_once`, or else in
    /// one piece for each row of tiles.
    pub fn bytes(&self, at_once: usize) -> Vec<Vec<u8>> {
        let taken = self.strips.iter().map(|strip| locked(strip).take_bytes());
        let len = self.pixel() * self.columns.len() * self.rows.len();
        if len <= at_once {
            let mut all = Vec::with_capacity(len);
            taken.for_each(|bytes| all.extend_from_slice(&bytes));
            vec![all]
        } else {
            taken.collect()
        }
    }

    /// Splits an image into bands and returns the rows of each, from the top. A band is at least one row of tiles high,
    /// and otherwise has at most `pixels` pixels.
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

/// Locks a strip. A thread that panicked has added a whole tile or none.
pub(crate) fn locked(strip: &Mutex<Strip>) -> MutexGuard<'_, Strip> {
    strip.lock().unwrap_or_else(PoisonError::into_inner)
}
