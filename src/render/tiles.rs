//! The tiles of a picture, and which of them are rendered.

use std::iter;
use std::ops::Range;

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

/// Some rows of a picture, or of a part of one.
pub struct Band {
    /// Which columns, from the left of the whole picture.
    pub columns: Range<usize>,
    /// Which rows, from its top.
    pub rows: Range<usize>,
    /// Red, green and blue of each pixel, from the top and from the left; black where nothing is rendered.
    pub pixels: Vec<[u8; 3]>,
    /// Whether each tile is rendered, from the top and from the left.
    pub tiles: Vec<bool>,
}

impl Band {
    /// One of which nothing is rendered.
    pub fn blank(columns: Range<usize>, rows: Range<usize>) -> Self {
        let (width, height) = (columns.len(), rows.len());
        let tiles = vec![false; width.div_ceil(TILE) * height.div_ceil(TILE)];
        Self { columns, rows, pixels: vec![[0; 3]; width * height], tiles }
    }

    /// Whether all of it is rendered.
    pub fn is_whole(&self) -> bool {
        self.tiles.iter().all(|is_done| *is_done)
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

/// Which tiles of a picture are rendered, as it comes band by band.
pub struct Tiles {
    width: usize,
    height: usize,
    strips: Vec<Strip>,
}

/// The tiles side by side. A picture has few strips that are neither whole nor empty, so that this takes little memory
/// for large ones.
enum Strip {
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
        let strips = band.tiles.chunks(self.width.div_ceil(TILE));
        self.strips.extend(strips.map(|tiles| match tiles {
            _ if tiles.iter().all(|is_done| *is_done) => Strip::Whole,
            _ if tiles.iter().any(|is_done| *is_done) => Strip::Part(tiles.to_vec()),
            _ => Strip::Nothing,
        }));
    }

    /// Whether each pixel of a row, counted from the top, is rendered.
    pub fn row(&self, row: usize) -> impl Iterator<Item = bool> + '_ {
        let strip = self.strips.get(row / TILE).unwrap_or(&Strip::Nothing);
        (0..self.width).map(move |column| match strip {
            Strip::Nothing => false,
            Strip::Whole => true,
            Strip::Part(tiles) => tiles[column / TILE],
        })
    }

    /// How many of the picture's pixels are rendered.
    pub fn pixels(&self) -> usize {
        let lengths = |side: usize| (0..side).step_by(TILE).map(move |from| TILE.min(side - from));
        let strips = iter::zip(&self.strips, lengths(self.height));
        strips
            .map(|(strip, tall)| match strip {
                Strip::Nothing => 0,
                Strip::Whole => tall * self.width,
                Strip::Part(tiles) => {
                    tall * iter::zip(tiles, lengths(self.width))
                        .map(|(done, wide)| usize::from(*done) * wide)
                        .sum::<usize>()
                }
            })
            .sum()
    }

    /// Whether the whole picture is rendered.
    pub fn is_whole(&self) -> bool {
        self.pixels() == self.width * self.height
    }
}
