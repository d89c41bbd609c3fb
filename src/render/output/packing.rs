//! Divides the rows of a PNG into pieces of the same height, which are compressed on all threads.

use crate::output::deflate::{Checksum, Compression, EMPTY_END, Piece};
use crate::renderer::Renderer;
use std::io;
use std::mem::take;
use tabray_world::parallel;

/// The maximum length of a piece in bytes, unless one row has more. Shorter pieces would make files larger, as each
/// piece has its own codes: in a black image with pieces of this length, the codes are a hundredth of the file.
pub const PIECE: usize = 1 << 20;

/// The number of pieces that are compressed together: as many as a renderer has rendered at one time.
const TOGETHER: usize = 12;

/// Compresses the rows of an image as they come.
pub(super) struct Packing<'r> {
    compression: Compression,
    renderer: Option<&'r Renderer>,
    /// The length of a row and of a pixel in bytes.
    row: usize,
    pixel: usize,
    /// The length of a piece in bytes, except for the last.
    piece: usize,
    /// The number of bytes of the image that are still to come.
    left: usize,
    /// The rows of a piece that have come.
    rows: Vec<u8>,
    /// The row above them; empty at the top of the image.
    above: Vec<u8>,
    /// Whole pieces that are not compressed yet.
    pieces: Vec<Piece>,
    checksum: Checksum,
}

impl<'r> Packing<'r> {
    /// Makes a packer for an image of this width and height in pixels, which have as many bytes each. The pieces depend only
    /// on the sizes.
    pub fn new(
        ([width, height], pixel): ([usize; 2], usize),
        compression: Compression,
        renderer: Option<&'r Renderer>,
    ) -> Self {
        let (row, left) = (pixel * width, pixel * width * height);
        let pieces = left.div_ceil(PIECE).clamp(1, height);
        Self {
            compression,
            renderer,
            row,
            pixel,
            piece: row * height.div_ceil(pieces),
            left,
            rows: Vec::new(),
            above: Vec::new(),
            pieces: Vec::new(),
            checksum: Checksum::none(),
        }
    }

    /// Compresses all rows, and passes the bytes of the zlib stream to `put`. Where `rows` ends with an error, `put`
    /// gets the rows before it.
    ///
    /// # Errors
    /// Returns the errors of `rows` and of `put`, and an error where the number of rows is not that of the image.
    pub fn run(
        mut self,
        rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
        mut put: impl FnMut(&[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        for rows in rows {
            match rows {
                Ok(rows) => self.add(rows, &mut put)?,
                Err(error) => {
                    self.end_piece();
                    self.pack(&mut put)?;
                    if !self.above.is_empty() {
                        // Decoders give out the last rows only of a stream that has an end.
                        put(&[&EMPTY_END[..], &self.checksum.trailer()].concat())?;
                    }
                    return Err(error);
                }
            }
        }
        if self.left > 0 {
            return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the image lacks rows"));
        }
        Ok(())
    }

    /// Adds some rows, and compresses the pieces once there are enough.
    fn add(&mut self, rows: Vec<u8>, put: &mut impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        if rows.len() > self.left {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the image has too many rows"));
        }
        if self.rows.is_empty() && rows.len() == self.piece {
            self.left -= rows.len();
            self.rows = rows;
            return self.end(put);
        }
        let mut rest = &rows[..];
        while !rest.is_empty() {
            let (next, others) = rest.split_at(rest.len().min(self.piece - self.rows.len()));
            self.rows.reserve_exact(self.piece.min(self.rows.len() + self.left) - self.rows.len());
            self.rows.extend_from_slice(next);
            (self.left, rest) = (self.left - next.len(), others);
            if self.rows.len() == self.piece || self.left == 0 {
                self.end(put)?;
            }
        }
        Ok(())
    }

    /// Ends a piece, and compresses it where it need not wait for others.
    fn end(&mut self, put: &mut impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        self.end_piece();
        let together = if self.renderer.is_some() { TOGETHER } else { 1 };
        if self.pieces.len() >= together || self.left == 0 { self.pack(put) } else { Ok(()) }
    }

    fn end_piece(&mut self) {
        let rows = take(&mut self.rows);
        let Some(last) = rows.rchunks_exact(self.row).next() else { return };
        let below = last.to_vec();
        let above = std::mem::replace(&mut self.above, below);
        self.pieces.push(Piece { above, rows, row: self.row, pixel: self.pixel, is_last: self.left == 0 });
    }

    /// Compresses the waiting pieces.
    fn pack(&mut self, put: &mut impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        let (pieces, compression) = (take(&mut self.pieces), self.compression);
        let is_last = pieces.last().is_some_and(|piece| piece.is_last);
        let pack_all = || {
            // Where there are fewer pieces than threads, each piece is compressed by several. One thread needs no
            // stripes.
            let threads = parallel::threads();
            let stripes = if threads == 1 { 1 } else { (2 * threads).div_ceil(pieces.len().max(1)) };
            parallel::map(pieces.len(), |piece| pieces[piece].pack(compression, stripes))
        };
        let packed = match self.renderer {
            Some(renderer) => renderer.run(pack_all),
            None => pieces.iter().map(|piece| piece.pack(compression, 1)).collect(),
        };
        let mut packed = packed.into_iter().collect::<io::Result<Vec<_>>>()?;
        for packed in &packed {
            self.checksum = self.checksum.and(&packed.checksum);
        }
        if let Some(last) = packed.last_mut().filter(|_| is_last) {
            last.bytes.extend(self.checksum.trailer());
        }
        packed.iter().try_for_each(|packed| put(&packed.bytes))
    }
}
