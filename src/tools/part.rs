//! Parts of images: the pixels of some tiles, in a file from which the image is assembled.
//!
//! A file consists of a line that names the format, a line of JSON (the [`Label`]), the pixels, and the SHA-256 of
//! all that. The pixels come tile by tile, and in a tile in rows from the top.

use crate::checkpoint::Identity;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use tabray_core::output::aov::{Aov, Setting};
use tabray_core::output::deflate::Compression;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::render::division::Grid;
use tabray_core::render::tiles::TILE;
use tabray_core::text;

/// The maximum number of parts of an image.
pub const MOST_PARTS: usize = 100_000;

/// The first line of each file.
const FIRST: &[u8] = b"tabray part 1\n";

/// The maximum length of the second line in bytes. It names each texture and each mesh of the scene.
const LONGEST: u64 = 1 << 26;

/// The length of the checksum at the end of a file in bytes.
const CHECKSUM: usize = 32;

/// The format of the pixels of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PixelFormat {
    /// Pixels of a PPM: three bytes each.
    Ppm,
    /// Pixels of a PNG with this compression: three bytes each.
    Png(#[serde(with = "by_name")] Compression),
    /// Pixels of an EXR: three numbers of 32 bits each.
    Exr,
    /// Pixels of a PFM: three numbers of 32 bits each.
    Pfm,
    /// Pixels of an auxiliary image, which is a PNG with this compression, or else a PPM: three numbers of 64 bits
    /// each.
    Beside(Aov, #[serde(with = "by_name")] Option<Compression>, Setting),
}

/// Compression by its name on the command line.
mod by_name {
    use super::{Compression, text};
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

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
    /// Returns the format of the parts of an image of this format.
    pub fn picture(format: Format) -> Self {
        match format {
            Format::Ppm => Self::Ppm,
            Format::Png(compression) => Self::Png(compression),
        }
    }

    /// Returns the format of the parts of an image of full range.
    pub fn full_range(format: FullRange) -> Self {
        match format {
            FullRange::Exr => Self::Exr,
            FullRange::Pfm => Self::Pfm,
        }
    }

    /// Returns the length of a pixel in bytes.
    pub fn pixel(self) -> usize {
        match self {
            Self::Ppm | Self::Png(_) => 3,
            Self::Exr | Self::Pfm => 12,
            Self::Beside(..) => 24,
        }
    }
}

/// The label of a part: the image that it belongs to, and which of its parts it is.
#[derive(Serialize, Deserialize)]
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
    fn is_sound(&self) -> bool {
        let [number, of] = self.part;
        let pixels = self.size[0].checked_mul(self.size[1]);
        let is_small = self.size.iter().all(|side| *side <= 100_000) && pixels.is_some_and(|all| all > 0);
        let is_keyword = |word: &str| {
            (1..80).contains(&word.len()) && word.bytes().all(|byte| byte.is_ascii_graphic() || byte == b' ')
        };
        let are_texts = self.made.iter().all(|(keyword, text)| is_keyword(keyword) && !text.contains('\0'));
        is_small
            && are_texts
            && of <= MOST_PARTS
            && (1..=of).contains(&number)
            && self.tiles[0] < self.tiles[1]
            && self.tiles[1] <= self.grid().count()
    }

    /// Returns the number of bytes between the label and the checksum.
    fn len(&self) -> u64 {
        (self.what.pixel() * self.grid().pixels_of(self.tiles())) as u64
    }
}

/// Writes a part.
pub struct Writer<W> {
    out: W,
    hasher: Sha256,
    /// The number of bytes before the pixels.
    pub begin: u64,
}

impl<W: Write> Writer<W> {
    /// Writes the label.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn new(out: W, label: &Label) -> io::Result<Self> {
        let mut writer = Self { out, hasher: Sha256::new(), begin: 0 };
        let line = text::json(label) + "\n";
        writer.put(FIRST)?;
        writer.put(line.as_bytes())?;
        writer.begin = (FIRST.len() + line.len()) as u64;
        Ok(writer)
    }

    /// Writes bytes of pixels.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hasher.update(bytes);
        self.out.write_all(bytes)
    }

    /// Writes the checksum.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.write_all(&self.hasher.finalize())?;
        Ok(self.out)
    }

    /// Returns the writer that the part is written to.
    pub fn out(&mut self) -> &mut W {
        &mut self.out
    }
}

/// Reads a part.
pub struct Reader {
    /// The label of the part.
    pub label: Label,
    file: BufReader<File>,
    hasher: Sha256,
    /// The number of bytes before the checksum that are still to be read.
    left: u64,
}

impl Reader {
    /// Reads the label of a part.
    ///
    /// # Errors
    /// Returns the errors of the file, and one of kind `InvalidData`, with the reason, if the file is not a part or is
    /// cut off.
    pub fn open(file: File) -> io::Result<Self> {
        let wrong = |reason: &'static str| io::Error::new(io::ErrorKind::InvalidData, reason);
        let len = file.metadata()?.len();
        let (mut file, mut hasher) = (BufReader::with_capacity(1 << 16, file), Sha256::new());
        let mut first = vec![0; FIRST.len()];
        let is_part = file.read_exact(&mut first).map(|()| first == FIRST);
        if !is_part.or_else(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => Ok(false),
            _ => Err(error),
        })? {
            return Err(wrong("it is not a part of an image"));
        }
        let mut line = Vec::new();
        file.by_ref().take(LONGEST).read_until(b'\n', &mut line)?;
        let label = serde_json::from_slice::<Label>(&line).ok().filter(Label::is_sound);
        let label = label.ok_or_else(|| wrong("it is damaged: its header makes no sense"))?;
        hasher.update(first);
        hasher.update(&line);
        let left = label.len();
        if len != (FIRST.len() + line.len() + CHECKSUM) as u64 + left {
            return Err(wrong("it is damaged: it is longer or shorter than its header says"));
        }
        Ok(Self { label, file, hasher, left })
    }

    /// Reads the next bytes. Damage is noticed at the end of the file, after the bytes before it were passed on.
    ///
    /// # Errors
    /// Returns the errors of the file, and one of kind `InvalidData`, with the reason, if the checksum is wrong.
    pub fn read(&mut self, bytes: &mut [u8]) -> io::Result<()> {
        self.file.read_exact(bytes)?;
        self.hasher.update(&*bytes);
        self.left -= bytes.len() as u64;
        if self.left > 0 {
            return Ok(());
        }
        let mut checksum = [0; CHECKSUM];
        self.file.read_exact(&mut checksum)?;
        if *std::mem::take(&mut self.hasher).finalize() == checksum {
            Ok(())
        } else {
            let reason = "it is damaged: its checksum is wrong";
            Err(io::Error::new(io::ErrorKind::InvalidData, reason))
        }
    }

    /// Reads the rest, to check that it is whole.
    ///
    /// # Errors
    /// Returns the errors of [`read`](Self::read).
    pub fn check(&mut self) -> io::Result<()> {
        let mut block = vec![0; 1 << 16];
        while self.left > 0 {
            let count = self.left.min(block.len() as u64) as usize;
            self.read(&mut block[..count])?;
        }
        Ok(())
    }

    /// Returns the checksum that the file has at its end.
    ///
    /// # Errors
    /// Returns the errors of the file.
    pub fn checksum(self) -> io::Result<[u8; CHECKSUM]> {
        let (mut file, mut checksum) = (self.file, [0; CHECKSUM]);
        file.seek(SeekFrom::End(-(CHECKSUM as i64)))?;
        file.read_exact(&mut checksum)?;
        Ok(checksum)
    }
}

/// Copies the pixels of a tile from an image, or from some rows of it, to the bytes of a part. `row` is the length of
/// the image's rows in bytes, and the columns and rows count from its upper left.
pub fn take_tile(
    image: &[u8],
    row: usize,
    [columns, rows]: [Range<usize>; 2],
    pixel: usize,
    tile: &mut Vec<u8>,
) {
    tile.clear();
    for at in rows {
        tile.extend_from_slice(&image[row * at..][pixel * columns.start..pixel * columns.end]);
    }
}

/// Copies the bytes of a tile to the place from which [`take_tile`] takes them.
fn put_tile(image: &mut [u8], row: usize, [columns, rows]: [Range<usize>; 2], pixel: usize, tile: &[u8]) {
    for (at, bytes) in rows.zip(tile.chunks(pixel * columns.len())) {
        image[row * at..][pixel * columns.start..pixel * columns.end].copy_from_slice(bytes);
    }
}

/// Assembles tiles: returns the bytes of each row of tiles that has some of them, from the top, 0 in place of the
/// others. `read` reads the bytes of the next tile, given its index.
pub fn strips<E>(
    grid: Grid,
    tiles: Range<usize>,
    pixel: usize,
    mut read: impl FnMut(usize, &mut [u8]) -> Result<(), E>,
) -> impl Iterator<Item = Result<Vec<u8>, E>> {
    let ([width, height], across, mut tile) = (grid.size, grid.across(), Vec::new());
    (tiles.start / across..tiles.end.div_ceil(across)).map(move |strip| {
        let mut rows = vec![0; pixel * width * TILE.min(height - TILE * strip)];
        for index in tiles.start.max(strip * across)..tiles.end.min((strip + 1) * across) {
            tile.resize(pixel * grid.pixels(index), 0);
            read(index, &mut tile)?;
            let [columns, at] = grid.tile(index);
            put_tile(&mut rows, pixel * width, [columns, 0..at.len()], pixel, &tile);
        }
        Ok(rows)
    })
}
