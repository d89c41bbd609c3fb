//! The tiles of an image, and which of them are rendered.

use std::iter;
use std::ops::Range;

/// The width and height of a tile in pixels, whose rays are traced together. Tiles at the right and lower edges may be
/// smaller.
pub(crate) const TILE: usize = 16;

/// Lists the pixels of a tile as runs of up to eight pixels, each by its columns and its row. The runs go through
/// blocks of 8 x 8 pixels, so that pixels that follow each other are close together.
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

/// Lists the pixels of all [`runs`] in `pixels`, by column and row.
pub(crate) fn list(columns: Range<usize>, rows: Range<usize>, pixels: &mut Vec<[usize; 2]>) {
    pixels.clear();
    for (columns, y) in runs(columns, rows) {
        pixels.extend(columns.map(|x| [x, y]));
    }
}

/// The maximum number of pixels that are in memory at one time, unless one row of tiles has more.
pub const BAND: usize = 1 << 22;

/// Some rows of an image, or of a part of one.
pub struct Band {
    /// The columns, counted from the left of the whole image.
    pub columns: Range<usize>,
    /// The rows, counted from the top of the whole image.
    pub rows: Range<usize>,
    /// Red, green and blue of each pixel, in rows from the top, each from the left; black where nothing is rendered.
    pub pixels: Vec<[u8; 3]>,
    /// Whether each tile is rendered, in rows from the top, each from the left.
    pub tiles: Vec<bool>,
}

impl Band {
    /// Makes a band of which nothing is rendered.
    pub fn blank(columns: Range<usize>, rows: Range<usize>) -> Self {
        let (width, height) = (columns.len(), rows.len());
        let tiles = vec![false; width.div_ceil(TILE) * height.div_ceil(TILE)];
        Self { columns, rows, pixels: vec![[0; 3]; width * height], tiles }
    }

    /// Tells whether all tiles are rendered.
    pub fn is_whole(&self) -> bool {
        self.tiles.iter().all(|is_done| *is_done)
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

/// Records which tiles of an image are rendered, band by band.
pub struct Tiles {
    width: usize,
    height: usize,
    strips: Vec<Strip>,
}

/// One row of tiles. An image has few strips that are partly rendered, so this takes little memory even for large
/// images.
enum Strip {
    Nothing,
    Whole,
    Part(Vec<bool>),
}

impl Tiles {
    /// Makes the record of an image of this width and height in pixels, of which nothing is rendered.
    pub fn none([width, height]: [usize; 2]) -> Self {
        Self { width, height, strips: Vec::new() }
    }

    /// Adds the tiles of the next band.
    pub fn add(&mut self, band: &Band) {
        let strips = band.tiles.chunks(self.width.div_ceil(TILE));
        self.strips.extend(strips.map(|tiles| match tiles {
            _ if tiles.iter().all(|is_done| *is_done) => Strip::Whole,
            _ if tiles.iter().any(|is_done| *is_done) => Strip::Part(tiles.to_vec()),
            _ => Strip::Nothing,
        }));
    }

    /// Tells for each pixel of a row, counted from the top, whether it is rendered.
    pub fn row(&self, row: usize) -> impl Iterator<Item = bool> + '_ {
        let strip = self.strips.get(row / TILE).unwrap_or(&Strip::Nothing);
        (0..self.width).map(move |column| match strip {
            Strip::Nothing => false,
            Strip::Whole => true,
            Strip::Part(tiles) => tiles[column / TILE],
        })
    }

    /// Returns the number of rendered pixels.
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

    /// Tells whether the whole image is rendered.
    pub fn is_whole(&self) -> bool {
        self.pixels() == self.width * self.height
    }
}
