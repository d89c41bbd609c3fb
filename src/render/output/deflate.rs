//! Compression of the rows of a PNG in independent pieces, each on a thread of its own. Their bytes, one after the
//! other, are one zlib stream.

use crate::output::codes;
use crate::output::filter::Filter;
use flate2::write::DeflateEncoder;
use simd_adler32::Adler32;
use std::io::{self, Write};
use std::mem::take;
use std::ops::Range;
use tabray_world::named;
use tabray_world::parallel;

/// The effort of the compression. The decoded image does not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// Fastest.
    #[default]
    Fast,
    /// Smaller files.
    ///
    /// About half as large; compressing takes longer than most images take to render.
    Balanced,
    /// Smallest files.
    High,
}

named!(Compression { Fast => "fast", Balanced => "default", High => "best" });

/// The first two bytes of a zlib stream: deflate with a window of 32 KiB.
const HEADER: [u8; 2] = [0x78, 0x01];

/// The last block of a stream, without bytes.
pub(super) const EMPTY_END: [u8; 5] = [1, 0, 0, 0xff, 0xff];

/// The length of the checksum at the end of a zlib stream, in bytes.
const TRAILER: usize = 4;

/// The minimum length of the stripes of a piece, in bytes. Starting a thread takes as long as compressing some of
/// them.
const STRIPE: usize = 1 << 14;

/// The length of a block of bytes that are stored as they are, as in `flate2`.
const STORED: usize = 31745;

/// Some rows of a PNG.
pub(super) struct Piece {
    /// The row above, from which the first row is predicted; empty at the top of the image.
    pub above: Vec<u8>,
    /// The rows.
    pub rows: Vec<u8>,
    /// The length of a row in bytes.
    pub row: usize,
    /// The length of a pixel in bytes.
    pub pixel: usize,
    /// Whether the image ends with these rows.
    pub is_last: bool,
}

/// A compressed piece.
pub(super) struct CompressedPiece {
    /// Its bytes in the zlib stream. The last piece lacks the stream's checksum.
    pub bytes: Vec<u8>,
    /// The checksum of the bytes before compression.
    pub checksum: Checksum,
}

impl Piece {
    /// Compresses the rows; for [`Compression::Fast`], in a number of stripes at the same time. The bytes do not
    /// depend on the number.
    ///
    /// # Errors
    /// No error is known: all output is written to memory.
    pub fn pack(&self, compression: Compression, stripes: usize) -> io::Result<CompressedPiece> {
        match compression {
            Compression::Fast => self.pack_fast(stripes),
            Compression::Balanced => self.pack_at(flate2::Compression::default()),
            Compression::High => self.pack_at(flate2::Compression::best()),
        }
    }

    /// Compresses the rows with the one Huffman code of `fdeflate`, which was made for PNGs.
    fn pack_fast(&self, stripes: usize) -> io::Result<CompressedPiece> {
        let (height, len) = (self.height(), self.filtered_len());
        let stripe = height.div_ceil(stripes.min(self.rows.len() / STRIPE).max(1));
        let packed = parallel::map(height.div_ceil(stripe), |index| {
            self.coded(index * stripe..height.min((index + 1) * stripe))
        });
        let mut packed = packed.into_iter();
        let Some(first) = packed.next() else { return self.store() };
        let (mut bytes, mut checksum) = first?;
        for next in packed {
            let (more, sum) = next?;
            codes::append(&mut bytes, &more);
            checksum = checksum.and(&sum);
        }
        if bytes.len() + TRAILER > len {
            // Noise is shorter as it is.
            return self.store();
        }
        if !self.is_last {
            continues(&mut bytes);
        }
        if !self.above.is_empty() {
            bytes.drain(..HEADER.len());
        }
        Ok(CompressedPiece { bytes, checksum })
    }

    /// Returns the stream of some of the rows by themselves, without its checksum, and the checksum. `fdeflate` ends
    /// the runs of a row with the row, so the codes of a row do not depend on the rows before it.
    fn coded(&self, rows: Range<usize>) -> io::Result<(Vec<u8>, Checksum)> {
        let len = rows.len() * (self.row + 1);
        let mut compressor = fdeflate::Compressor::new(Vec::with_capacity(len / 4))?;
        self.filtered(rows, Filter::Up, |row| compressor.write_data(row))?;
        let mut bytes = compressor.finish()?;
        let checksum = bytes.split_off(bytes.len() - TRAILER);
        let checksum = checksum.try_into().map_or(0, u32::from_be_bytes);
        Ok((bytes, Checksum::new(checksum, len)))
    }

    /// Stores the rows as they are.
    fn store(&self) -> io::Result<CompressedPiece> {
        let (mut all, mut adler) = (Vec::with_capacity(self.filtered_len()), Adler32::new());
        self.filtered(0..self.height(), Filter::None, |row| {
            all.extend_from_slice(row);
            Ok(())
        })?;
        adler.write(&all);
        let mut bytes = if self.above.is_empty() { HEADER.to_vec() } else { Vec::new() };
        let mut block = |block: &[u8], is_last| {
            let len = (block.len() as u16).to_le_bytes();
            bytes.push(u8::from(is_last));
            bytes.extend(len.into_iter().chain(len.map(|byte| !byte)));
            bytes.extend_from_slice(block);
        };
        let whole = all.chunks_exact(STORED);
        let rest = whole.remainder();
        whole.for_each(|whole| block(whole, false));
        if !self.is_last && !rest.is_empty() {
            block(rest, false);
        }
        // As `flate2` ends a stream, or a part of one.
        block(if self.is_last { rest } else { &[] }, self.is_last);
        Ok(CompressedPiece { bytes, checksum: Checksum::new(adler.finish(), all.len()) })
    }

    /// Compresses the rows at a level of zlib.
    fn pack_at(&self, level: flate2::Compression) -> io::Result<CompressedPiece> {
        let bytes = if self.above.is_empty() { HEADER.to_vec() } else { Vec::new() };
        let (mut encoder, mut adler) = (DeflateEncoder::new(bytes, level), Adler32::new());
        self.filtered(0..self.height(), Filter::Adaptive, |row| {
            adler.write(row);
            encoder.write_all(row)
        })?;
        let bytes = if self.is_last {
            encoder.finish()?
        } else {
            // Ends the block, and then the byte.
            encoder.flush()?;
            take(encoder.get_mut())
        };
        Ok(CompressedPiece { bytes, checksum: Checksum::new(adler.finish(), self.filtered_len()) })
    }

    /// Passes each of some rows to `put`, filtered.
    fn filtered(
        &self,
        rows: Range<usize>,
        filter: Filter,
        mut put: impl FnMut(&[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        let black = vec![0; self.row];
        let mut above = match rows.start.checked_sub(1) {
            Some(above) => &self.rows[above * self.row..][..self.row],
            None if self.above.is_empty() => &black,
            None => &self.above[..],
        };
        let mut filtered = vec![0; 1 + self.row];
        for row in self.rows[rows.start * self.row..rows.end * self.row].chunks_exact(self.row) {
            filter.apply(self.pixel, above, row, &mut filtered);
            put(&filtered)?;
            above = row;
        }
        Ok(())
    }

    /// Returns the number of rows.
    fn height(&self) -> usize {
        self.rows.len() / self.row
    }

    /// Returns the length of the filtered rows in bytes. Each row has one more byte, which says how the row is
    /// filtered.
    fn filtered_len(&self) -> usize {
        self.height() * (self.row + 1)
    }
}

/// Turns the one block of an `fdeflate` stream, which is marked as the last, into one that others follow.
fn continues(stream: &mut Vec<u8>) {
    stream[HEADER.len()] &= !1;
    // The code that ends the block ends with a 1, after which the last byte is filled up with zeros. Three zeros begin
    // a block of stored bytes, which continues at the next whole byte with its length. That length is 0.
    let filled = stream.last().map_or(0, |last| last.leading_zeros());
    if filled < 3 {
        stream.push(0);
    }
    stream.extend([0, 0, 0xff, 0xff]);
}

/// The checksum of a zlib stream, Adler-32.
pub(super) struct Checksum {
    /// 1 plus the sum of the bytes, modulo [`MODULUS`](Self::MODULUS) like all sums.
    sum: u32,
    /// The sum of the values that `sum` has after each byte.
    sums: u32,
    /// The number of bytes.
    len: u32,
}

impl Checksum {
    const MODULUS: u64 = 65521;

    /// Returns the checksum of no bytes.
    pub fn none() -> Self {
        Self::new(1, 0)
    }

    fn new(adler: u32, len: usize) -> Self {
        Self { sum: adler & 0xffff, sums: adler >> 16, len: (len as u64 % Self::MODULUS) as u32 }
    }

    /// Returns the checksum of these bytes and others after them.
    pub fn and(&self, next: &Self) -> Self {
        let [sum, sums, len] = [self.sum, self.sums, self.len].map(u64::from);
        let [next_sum, next_sums, next_len] = [next.sum, next.sums, next.len].map(u64::from);
        // Each of the later sums is larger by the earlier bytes.
        let bytes = sum + Self::MODULUS - 1;
        let [sum, sums, len] = [bytes + next_sum, sums + next_sums + next_len * bytes, len + next_len]
            .map(|value| (value % Self::MODULUS) as u32);
        Self { sum, sums, len }
    }

    /// Returns the last bytes of the stream.
    pub(crate) fn trailer(&self) -> [u8; TRAILER] {
        (self.sums << 16 | self.sum).to_be_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes with runs, repetitions and noise, different for each seed.
    fn bytes(len: usize, seed: usize) -> Vec<u8> {
        let noise = |byte: usize| byte.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        (0..len)
            .map(|byte| if byte / 97 % 3 == 0 { 0 } else { noise(byte / (1 + seed % 5) + seed) as u8 })
            .collect()
    }

    #[test]
    fn pieces_are_one_stream() {
        for compression in [Compression::Fast, Compression::Balanced, Compression::High] {
            // A piece may end at any bit of a byte.
            for seed in 0..64 {
                let (row, heights) = (3 * (1 + 5 * seed), [1 + seed % 3, 4, 40]);
                let pixels = bytes(row * heights.iter().sum::<usize>(), seed);
                let (mut rest, mut above, mut checksum) = (&pixels[..], Vec::new(), Checksum::none());
                let mut file = Vec::new();
                let (width, height) = (row as u32 / 3, (pixels.len() / row) as u32);
                let mut encoder = png::Encoder::new(&mut file, width, height);
                encoder.set_color(png::ColorType::Rgb);
                let mut writer = encoder.write_header().expect("memory takes it");
                for height in heights {
                    let (rows, others) = rest.split_at(height * row);
                    let piece =
                        Piece { above, rows: rows.to_vec(), row, pixel: 3, is_last: others.is_empty() };
                    let mut packed = piece.pack(compression, 1).expect("memory takes it");
                    checksum = checksum.and(&packed.checksum);
                    if piece.is_last {
                        packed.bytes.extend(checksum.trailer());
                    }
                    writer.write_chunk(png::chunk::IDAT, &packed.bytes).expect("memory takes it");
                    (rest, above) = (others, rows[rows.len() - row..].to_vec());
                }
                writer.finish().expect("memory takes it");
                let read = image::load_from_memory(&file).expect("a PNG").into_rgb8();
                assert!(read.into_raw() == pixels, "{compression:?}, {seed}");
            }
        }
    }

    #[test]
    fn the_bytes_do_not_depend_on_the_number_of_stripes() {
        for seed in 0..32 {
            let (row, is_last) = (3 * (100 + 31 * seed), seed % 2 == 0);
            let rows = bytes(row * (STRIPE / row + 2) * 9, seed);
            let above = if seed % 3 == 0 { Vec::new() } else { bytes(row, seed + 1) };
            let piece = Piece { above, rows, row, pixel: 3, is_last };
            let [one, others @ ..] =
                [1, 2, 3, 8].map(|stripes| piece.pack(Compression::Fast, stripes).expect("memory takes it"));
            for other in others {
                assert!(one.bytes == other.bytes, "{seed}");
                assert_eq!(one.checksum.trailer(), other.checksum.trailer(), "{seed}");
            }
        }
    }

    #[test]
    fn noise_is_stored() {
        let rows: Vec<u8> =
            (0..3 << 16).map(|byte: u64| (byte.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as u8).collect();
        let packed = Piece { above: Vec::new(), row: 3 << 8, pixel: 3, is_last: true, rows }
            .pack(Compression::Fast, 1);
        let len = packed.expect("memory takes it").bytes.len();
        assert!(len < (3 << 16) + 400, "{len}");
    }
}
