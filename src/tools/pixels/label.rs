//! What a file of pixels says of its image: how it was made, the format of the pixels, and which tiles there are.

use crate::identity::Identity;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use tabray_core::output::aov::{Aov, Setting};
use tabray_core::output::deflate::Compression;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::render::division::Grid;

/// The maximum number of parts of an image.
pub const MAX_PARTS: usize = 100_000;

/// The format of the pixels of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PixelFormat {
    /// Pixels of a PPM: three bytes each.
    Ppm,
    /// Pixels of a PNG with this compression: three bytes each.
    Png(#[serde(with = "by_name")] Compression),
    /// Pixels of a PNG with alpha and this compression: four bytes each.
    PngAlpha(#[serde(with = "by_name")] Compression),
    /// Pixels of an EXR: three numbers of 32 bits each.
    Exr,
    /// Pixels of an EXR with alpha: four numbers of 32 bits each.
    ExrAlpha,
    /// Pixels of a PFM: three numbers of 32 bits each.
    Pfm,
    /// Pixels of an auxiliary image, which is a PNG with this compression, or else a PPM: three numbers of 64 bits
    /// each.
    Beside(Aov, #[serde(with = "by_name")] Option<Compression>, Setting),
}

/// Compression by its name on the command line.
mod by_name {
    use super::Compression;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
    use tabray_core::text;

    /// A compression, or none.
    pub trait Named: Sized {
        fn name(&self) -> Option<String>;
        fn of(name: Option<String>) -> Option<Self>;
    }

    impl Named for Compression {
        fn name(&self) -> Option<String> {
            Some(text::Named::name(*self).to_owned())
        }

        fn of(name: Option<String>) -> Option<Self> {
            <Self as text::Named>::of_name(&name?)
        }
    }

    impl Named for Option<Compression> {
        fn name(&self) -> Option<String> {
            self.map(|of| text::Named::name(of).to_owned())
        }

        fn of(name: Option<String>) -> Option<Self> {
            match name {
                Some(name) => <Compression as text::Named>::of_name(&name).map(Some),
                None => Some(None),
            }
        }
    }

    pub fn serialize<N: Named, S: Serializer>(of: &N, serializer: S) -> Result<S::Ok, S::Error> {
        of.name().serialize(serializer)
    }

    pub fn deserialize<'de, N: Named, D: Deserializer<'de>>(deserializer: D) -> Result<N, D::Error> {
        N::of(Option::deserialize(deserializer)?).ok_or_else(|| de::Error::custom("no compression"))
    }
}

impl PixelFormat {
    /// Returns the format of the parts of an image of this format. A PPM has no alpha.
    pub fn picture(format: Format, has_alpha: bool) -> Self {
        match format {
            Format::Ppm => Self::Ppm,
            Format::Png(compression) if has_alpha => Self::PngAlpha(compression),
            Format::Png(compression) => Self::Png(compression),
        }
    }

    /// Returns the format of the parts of an image of full range. A PFM has no alpha.
    pub fn full_range(format: FullRange, has_alpha: bool) -> Self {
        match format {
            FullRange::Exr if has_alpha => Self::ExrAlpha,
            FullRange::Exr => Self::Exr,
            FullRange::Pfm => Self::Pfm,
        }
    }

    /// Tells whether the pixels have alpha.
    pub fn has_alpha(self) -> bool {
        matches!(self, Self::PngAlpha(_) | Self::ExrAlpha)
    }

    /// Returns the length of a pixel in bytes.
    pub fn pixel(self) -> usize {
        match self {
            Self::Ppm | Self::Png(_) => 3,
            Self::PngAlpha(_) => 4,
            Self::Exr | Self::Pfm => 12,
            Self::ExrAlpha => 16,
            Self::Beside(..) => 24,
        }
    }
}

/// The label of a part: the image that it belongs to, and which of its parts it is. A whole image is part 1 of 1.
#[derive(Clone, Serialize, Deserialize)]
pub struct Label {
    /// The number of the part, from 1, and the number of parts.
    pub part: [usize; 2],
    /// The first of its tiles, and the first of the next part.
    pub tiles: [usize; 2],
    /// The width and height of the image in pixels.
    pub size: [usize; 2],
    /// The format of the pixels.
    pub what: PixelFormat,
    /// The auxiliary images, which have parts of their own.
    pub beside: Vec<Aov>,
    /// The settings and inputs on which the pixels depend.
    pub identity: Identity,
    /// The texts that a PNG records about how the image was made, each with its keyword.
    pub made: Vec<(String, String)>,
    /// The number of pixels per inch with which the image is to be printed.
    pub dpi: Option<u32>,
}

impl Label {
    /// Returns the tiles of the image.
    pub fn grid(&self) -> Grid {
        Grid { size: self.size }
    }

    /// Returns the tiles of the part.
    pub fn tiles(&self) -> Range<usize> {
        self.tiles[0]..self.tiles[1]
    }

    /// Tells whether the label can be that of a part.
    pub(super) fn is_sound(&self) -> bool {
        let [number, of] = self.part;
        let pixels = self.size[0].checked_mul(self.size[1]);
        let is_small = self.size.iter().all(|side| *side <= 100_000) && pixels.is_some_and(|all| all > 0);
        let is_keyword = |word: &str| {
            (1..80).contains(&word.len()) && word.bytes().all(|byte| byte.is_ascii_graphic() || byte == b' ')
        };
        let are_texts = self.made.iter().all(|(keyword, text)| is_keyword(keyword) && !text.contains('\0'));
        is_small
            && are_texts
            && of <= MAX_PARTS
            && (1..=of).contains(&number)
            && self.tiles[0] < self.tiles[1]
            && self.tiles[1] <= self.grid().count()
    }
}

/// Which tiles of a part are finished.
pub struct TileSet {
    tiles: Range<usize>,
    /// A bit for each tile of the part, beginning with the lowest of each byte.
    pub(super) bits: Vec<u8>,
}

impl TileSet {
    /// Makes an empty set of these tiles of an image.
    pub fn none(tiles: Range<usize>) -> Self {
        let bits = vec![0; tiles.len().div_ceil(8)];
        Self { tiles, bits }
    }

    /// Adds a tile, which must be one of the part.
    pub fn add(&mut self, tile: usize) {
        let at = tile - self.tiles.start;
        self.bits[at / 8] |= 1 << (at % 8);
    }

    /// Tells whether a tile of the image is in the set.
    pub fn has(&self, tile: usize) -> bool {
        let at = tile.wrapping_sub(self.tiles.start);
        at < self.tiles.len() && self.bits[at / 8] >> (at % 8) & 1 == 1
    }

    /// Lists the tiles in the set.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = usize> + '_ {
        self.tiles.clone().filter(|tile| self.has(*tile))
    }

    /// Tells whether all tiles are in the set.
    pub fn is_whole(&self) -> bool {
        self.iter().eq(self.tiles.clone())
    }

    /// Returns the number of pixels of the tiles in the set.
    pub fn pixels(&self, grid: Grid) -> usize {
        self.iter().map(|tile| grid.pixels(tile)).sum()
    }
}
