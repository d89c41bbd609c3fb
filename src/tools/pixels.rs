//! Finished tiles of an image or of a part of one, in a file: a part, from which the image is assembled, or a
//! checkpoint, which lacks some tiles and from which a later render continues.
//!
//! A file consists of a line that names the format, a line of JSON (the [`Label`]), the pixels of the tiles that are
//! finished, a bit for each tile that tells whether it is (a [`TileSet`]), and the SHA-256 of all that. The pixels come
//! tile by tile, and in a tile in rows from the top.

mod label;

pub use label::{Label, MAX_PARTS, PixelFormat, TileSet};

use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::mem::take;
use std::ops::Range;
use tabray_core::render::division::Grid;
use tabray_core::render::tiles::{Band, Strip, TILE};
use tabray_core::text;

/// The first line of each file.
const FIRST: &[u8] = b"tabray pixels 1\n";

/// What older versions wrote: how their parts begin, and a text near the beginning of their checkpoints, which are PNGs.
const OLDER_PART: &[u8] = b"tabray part ";
const OLDER_CHECKPOINT: &[u8] = b"tabray checkpoint";

/// The number of bytes in which the text of an older checkpoint begins.
const BEGINNING: usize = 256;

/// The maximum length of the second line in bytes. It names each texture and each mesh of the scene.
const LONGEST: u64 = 1 << 26;

/// The length of the checksum at the end of a file in bytes.
const CHECKSUM: usize = 32;

/// Writes a part, tile by tile.
pub struct Writer<W> {
    out: W,
    hasher: Sha256,
    /// The tiles that are written.
    pub done: TileSet,
    next: usize,
}

impl<W: Write> Writer<W> {
    /// Writes the label.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn new(out: W, label: &Label) -> io::Result<Self> {
        let (done, next) = (TileSet::none(label.tiles()), label.tiles[0]);
        let mut writer = Self { out, hasher: Sha256::new(), done, next };
        writer.put(FIRST)?;
        writer.put((text::json(label) + "\n").as_bytes())?;
        Ok(writer)
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hasher.update(bytes);
        self.out.write_all(bytes)
    }

    /// Writes the bytes of the next tile, or leaves it out.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn tile(&mut self, pixels: Option<&[u8]>) -> io::Result<()> {
        if let Some(pixels) = pixels {
            self.done.add(self.next);
            self.put(pixels)?;
        }
        self.next += 1;
        Ok(())
    }

    /// Writes which tiles are finished, and the checksum.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn finish(mut self) -> io::Result<W> {
        let bits = take(&mut self.done.bits);
        self.put(&bits)?;
        self.out.write_all(&self.hasher.finalize())?;
        Ok(self.out)
    }
}

/// Reads a part.
pub struct Reader {
    /// The label of the part.
    pub label: Label,
    /// The tiles that the file has.
    pub done: TileSet,
    file: BufReader<File>,
    hasher: Sha256,
    /// The number of bytes of pixels that are still to be read.
    left: u64,
}

impl Reader {
    /// Reads the label of a part.
    ///
    /// # Errors
    /// Returns the errors of the file, one of kind `Unsupported` if an older version of tabray wrote it, and one of kind
    /// `InvalidData` if it is not a part or is cut off, both with the reason.
    pub fn open(file: File) -> io::Result<Self> {
        let wrong = |reason: &'static str| io::Error::new(io::ErrorKind::InvalidData, reason);
        let len = file.metadata()?.len();
        let (mut file, mut hasher) = (BufReader::with_capacity(1 << 16, file), Sha256::new());
        let beginning = file.fill_buf()?;
        if !beginning.starts_with(FIRST) {
            let mut words = beginning[..beginning.len().min(BEGINNING)].windows(OLDER_CHECKPOINT.len());
            return Err(
                match beginning.starts_with(OLDER_PART) || words.any(|word| word == OLDER_CHECKPOINT) {
                    true => io::Error::new(io::ErrorKind::Unsupported, "it is of an older version of tabray"),
                    false => wrong("it is not a part of an image"),
                },
            );
        }
        file.consume(FIRST.len());
        let mut line = Vec::new();
        file.by_ref().take(LONGEST).read_until(b'\n', &mut line)?;
        let label = serde_json::from_slice::<Label>(&line).ok().filter(Label::is_sound);
        let label = label.ok_or_else(|| wrong("it is damaged: its header makes no sense"))?;
        hasher.update(FIRST);
        hasher.update(&line);
        let mut done = TileSet::none(label.tiles());
        let (begin, end) = ((FIRST.len() + line.len()) as u64, (done.bits.len() + CHECKSUM) as u64);
        if len > begin + end {
            file.seek(SeekFrom::Start(len - end))?;
            file.read_exact(&mut done.bits)?;
            file.seek(SeekFrom::Start(begin))?;
        }
        let left = (label.what.pixel() * done.pixels(label.grid())) as u64;
        if left == 0 || len != begin + left + end {
            return Err(wrong("it is damaged: it is longer or shorter than its header says"));
        }
        Ok(Self { label, done, file, hasher, left })
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
        self.hasher.update(&self.done.bits);
        if *take(&mut self.hasher).finalize() == self.checksum()? {
            Ok(())
        } else {
            let reason = "it is damaged: its checksum is wrong";
            Err(io::Error::new(io::ErrorKind::InvalidData, reason))
        }
    }

    /// Tells whether all pixels have been read.
    pub fn is_over(&self) -> bool {
        self.left == 0
    }

    /// Fills a band of an image of bytes, with alpha if the file has it, with the tiles that the file has, and leaves the others. `strip` is the index of
    /// its first row of tiles. Bands must be passed in order, from the top.
    ///
    /// # Errors
    /// Returns the errors of [`read`](Self::read).
    pub fn fill(&mut self, band: &Band, strip: usize) -> io::Result<()> {
        let (grid, mut bytes) = (self.label.grid(), Vec::new());
        let across = grid.across();
        for index in 0..band.strips.len() {
            let Strip { pixels, alpha, tiles } = &mut *band.strip(index);
            for (column, is_done) in tiles.iter_mut().enumerate() {
                let tile = (strip + index) * across + column;
                if self.done.has(tile) {
                    bytes.resize(band.pixel() * grid.pixels(tile), 0);
                    self.read(&mut bytes)?;
                    let ([columns, rows], width) = (grid.tile(tile), grid.size[0]);
                    let place = [columns, 0..rows.len()];
                    if band.has_alpha {
                        let (all, _) = bytes.as_chunks::<4>();
                        let alphas: Vec<u8> = all.iter().map(|pixel| pixel[3]).collect();
                        put_tile(alpha, width, place.clone(), 1, &alphas);
                        bytes = all.iter().flat_map(|pixel| pixel[..3].to_vec()).collect();
                    }
                    put_tile(pixels.as_flattened_mut(), 3 * width, place, 3, &bytes);
                    *is_done = true;
                }
            }
        }
        Ok(())
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

    /// Returns the checksum that the file has at its end. No pixels can be read after it.
    ///
    /// # Errors
    /// Returns the errors of the file.
    pub fn checksum(&mut self) -> io::Result<[u8; CHECKSUM]> {
        let mut checksum = [0; CHECKSUM];
        self.file.seek(SeekFrom::End(-(CHECKSUM as i64)))?;
        self.file.read_exact(&mut checksum)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identity::Identity;

    const SIZE: [usize; 2] = [20, 18];

    /// Makes a file with these bytes.
    fn file(bytes: &[u8]) -> File {
        let mut file = tempfile::tempfile().expect("a temporary file");
        file.write_all(bytes).and_then(|()| file.rewind()).expect("it is written");
        file
    }

    /// Returns all bytes of an image, as a file with these bytes fills them, and which tiles are done.
    fn filled(bytes: &[u8]) -> io::Result<(Vec<u8>, Vec<bool>)> {
        let mut reader = Reader::open(file(bytes))?;
        let band = Band::blank(0..SIZE[0], 0..SIZE[1], false);
        reader.fill(&band, 0)?;
        let tiles = (0..band.strips.len()).flat_map(|index| band.strip(index).tiles.clone()).collect();
        Ok((band.bytes(usize::MAX).concat(), tiles))
    }

    /// Makes a file of an image with the tiles that are `done`.
    fn written(pixels: &[u8], done: [bool; 4]) -> Vec<u8> {
        let (identity, what) = (Identity::default(), PixelFormat::Ppm);
        let (beside, made) = (Vec::new(), Vec::new());
        let label =
            Label { part: [1, 1], tiles: [0, 4], size: SIZE, what, beside, identity, made, dpi: None };
        let (mut writer, mut bytes) = (Writer::new(Vec::new(), &label).expect("memory takes it"), Vec::new());
        for (tile, is_done) in done.into_iter().enumerate() {
            take_tile(pixels, 3 * SIZE[0], label.grid().tile(tile), 3, &mut bytes);
            writer.tile(is_done.then_some(&bytes)).expect("memory takes it");
        }
        writer.finish().expect("memory takes it")
    }

    #[test]
    fn a_damaged_byte_anywhere_is_noticed() {
        let pixels: Vec<u8> = (0..3 * SIZE[0] * SIZE[1]).map(|byte| (byte * byte / 97) as u8).collect();
        for done in [[true; 4], [true, false, false, true]] {
            let bytes = written(&pixels, done);
            let (read, tiles) = filled(&bytes).expect("nothing is damaged");
            for (at, byte) in read.iter().enumerate() {
                let is_done = done[at / 3 / SIZE[0] / TILE * 2 + at / 3 % SIZE[0] / TILE];
                assert_eq!(*byte, if is_done { pixels[at] } else { 0 }, "{at}");
            }
            assert_eq!(tiles, done);
            for at in 0..bytes.len() {
                for mask in [1, 0x80, 0xff] {
                    let mut damaged = bytes.clone();
                    damaged[at] ^= mask;
                    assert!(filled(&damaged).is_err(), "{at}");
                }
                assert!(filled(&bytes[..at]).is_err(), "cut off at {at}");
            }
        }
    }

    #[test]
    fn a_file_of_an_older_version_is_told_to_be_one() {
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, 1, 1);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        encoder.add_itxt_chunk("tabray checkpoint".to_owned(), "{}".to_owned()).expect("a text");
        encoder.write_header().and_then(|mut png| png.write_image_data(&[7])).expect("memory takes it");
        for older in [&b"tabray part 1\n{}\n"[..], &png] {
            let error = Reader::open(file(older)).err().expect("an error");
            assert_eq!(
                (error.kind(), error.to_string()),
                (io::ErrorKind::Unsupported, "it is of an older version of tabray".to_owned())
            );
        }
        let error = Reader::open(file(b"P6 1 1 255\n123")).err().expect("an error");
        assert_eq!(error.kind(), io::ErrorKind::InvalidData);
    }
}
