//! Colours to bytes, and bytes to picture files.

use crate::material::Rgb;
use glam::DVec3;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;

/// The byte of a channel: 1 and more is 255, 0 and less is 0, and between them it is cut, not rounded.
/// A NaN is 0.
pub fn to_byte(channel: f64) -> u8 {
    (255.0 * channel) as u8
}

/// What a picture shows of a colour: each channel from 0 to 1, a NaN as 0.
pub fn shown(colour: Rgb) -> Rgb {
    DVec3::from_array(colour.to_array().map(|channel| if channel > 0.0 { channel.min(1.0) } else { 0.0 }))
}

/// How hard a file is compressed. The picture is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// As quickly as possible.
    #[default]
    Fast,
    /// To about half of that size, which takes longer than most pictures take to render.
    Balanced,
    /// As small as possible.
    High,
}

/// A picture's file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary portable pixmap, `P6`.
    Ppm,
    /// Portable network graphics.
    Png(Compression),
}

impl Format {
    /// The format that a file's extension names, whatever its case.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_ascii_lowercase();
        match extension.to_str()? {
            "ppm" => Some(Self::Ppm),
            "png" => Some(Self::Png(Compression::default())),
            _ => None,
        }
    }

    /// Writes a whole picture: `rows` hands out its bytes, some rows at a time from the top: red, green and blue of each
    /// pixel from the left.
    ///
    /// # Errors
    /// Those of `out`, of `rows`, and a size that the format cannot hold.
    pub fn write(
        self,
        out: impl Write,
        [width, height]: [usize; 2],
        rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
    ) -> io::Result<()> {
        match self {
            Self::Ppm => write_ppm(out, width, height, rows),
            Self::Png(compression) => write_png(out, width, height, compression, rows),
        }
    }

    /// Reads a file that [`write`](Self::write) wrote, from its beginning.
    ///
    /// # Errors
    /// Those of the file.
    pub fn read(self, file: File) -> io::Result<Rows> {
        let mut file = BufReader::with_capacity(1 << 16, file);
        Ok(match self {
            Self::Ppm => {
                file.skip_until(b'\n')?;
                Rows::Ppm(file)
            }
            Self::Png(_) => Rows::Png(Box::new(png::Decoder::new(file).read_info()?)),
        })
    }
}

/// The rows of a picture's file, from the top.
pub enum Rows {
    /// From after the header.
    Ppm(BufReader<File>),
    /// From the decoder.
    Png(Box<png::Reader<BufReader<File>>>),
}

impl Rows {
    /// The next row: red, green and blue of each pixel.
    ///
    /// # Errors
    /// Those of the file, and where it has no other row of this length.
    pub fn next(&mut self, row: &mut [u8]) -> io::Result<()> {
        match self {
            Self::Ppm(file) => file.read_exact(row),
            Self::Png(png) => png.read_row(row)?.map(drop).ok_or_else(|| io::ErrorKind::UnexpectedEof.into()),
        }
    }
}

fn write_ppm(
    mut out: impl Write,
    width: usize,
    height: usize,
    rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    writeln!(out, "P6 {width} {height} 255")?;
    for bytes in rows {
        out.write_all(&bytes?)?;
    }
    out.flush()
}

fn write_png(
    out: impl Write,
    width: usize,
    height: usize,
    compression: Compression,
    rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    let size = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
    let mut encoder = png::Encoder::new(out, size(width)?, size(height)?);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(match compression {
        Compression::Fast => png::Compression::Fast,
        Compression::Balanced => png::Compression::Balanced,
        Compression::High => png::Compression::High,
    });
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    for bytes in rows {
        stream.write_all(&bytes?)?;
    }
    stream.finish()?;
    Ok(writer.finish()?)
}
