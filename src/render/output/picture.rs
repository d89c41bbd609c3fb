//! Writes image files from bytes, and reads them back.

use crate::output::deflate::Compression;
use crate::output::packing::Packing;
use crate::renderer::Renderer;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use tabray_world::text::Named;

/// A file format of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary portable pixmap, `P6`.
    Ppm,
    /// Portable network graphics.
    Png(Compression),
}

/// What the file of an image says besides its pixels, where its format has a place for that.
#[derive(Clone, Copy, Debug, Default)]
pub struct About<'t> {
    /// Texts, each with its keyword.
    pub texts: &'t [(&'t str, String)],
    /// The number of pixels per inch with which the image is to be printed.
    pub dpi: Option<u32>,
    /// Whether pixels have alpha, which is not premultiplied in files of bytes and is in files of full range.
    pub alpha: bool,
}

impl About<'_> {
    /// Returns the number of channels of a pixel.
    pub fn channels(&self) -> usize {
        if self.alpha { 4 } else { 3 }
    }
}

/// The name is the extension of the format's files. A PNG of that name is compressed for speed.
impl Named for Format {
    const ALL: &'static [Self] = &[Self::Ppm, Self::Png(Compression::Fast)];

    fn name(self) -> &'static str {
        match self {
            Self::Ppm => "ppm",
            Self::Png(_) => "png",
        }
    }
}

impl Format {
    /// Returns the format that a file's extension names, in upper or lower case.
    pub fn of(path: &Path) -> Option<Self> {
        Self::of_name(&path.extension()?.to_str()?.to_ascii_lowercase())
    }

    /// Writes a whole image: `rows` yields its bytes, some rows at a time from the top, with red, green and blue of
    /// each pixel from the left.
    ///
    /// # Errors
    /// Returns the errors of `out` and of `rows`, and an error where the format cannot hold the size.
    pub fn write(
        self,
        out: impl Write,
        size: [usize; 2],
        rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
    ) -> io::Result<()> {
        self.write_on(None, &About::default(), out, size, rows)
    }

    /// Writes a whole image as [`write`](Self::write) does, and compresses it on a renderer's threads, if there is one.
    /// The bytes do not depend on the threads. Only a PNG says anything besides its pixels, and can have a fourth byte of
    /// each, its alpha.
    ///
    /// # Errors
    /// Returns the errors of [`write`](Self::write).
    pub fn write_on(
        self,
        renderer: Option<&Renderer>,
        about: &About,
        mut out: impl Write,
        [width, height]: [usize; 2],
        rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
    ) -> io::Result<()> {
        match self {
            Self::Ppm if about.alpha => Err(io::ErrorKind::InvalidInput.into()),
            Self::Ppm => write_ppm(&mut out, width, height, rows),
            Self::Png(compression) => {
                write_png(&mut out, [width, height], about, (compression, renderer), rows)
            }
        }
    }

    /// Returns the length of the file in bytes, where it does not depend on the image's content.
    pub fn len(self, [width, height]: [usize; 2]) -> Option<u64> {
        match self {
            Self::Ppm => Some((ppm_header(width, height).len() + 3 * width * height) as u64),
            Self::Png(_) => None,
        }
    }

    /// Opens a file that [`write`](Self::write) wrote, to read it from its first row.
    ///
    /// # Errors
    /// Returns the errors of the file.
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

/// The rows of an image file, from the top.
pub enum Rows {
    /// The file, positioned after the header.
    Ppm(BufReader<File>),
    /// The decoder.
    Png(Box<png::Reader<BufReader<File>>>),
}

impl Rows {
    /// Reads the next row: red, green and blue of each pixel, and alpha if the file has it.
    ///
    /// # Errors
    /// Returns the errors of the file, and an error where the file has no further row of this length.
    pub fn next(&mut self, row: &mut [u8]) -> io::Result<()> {
        match self {
            Self::Ppm(file) => file.read_exact(row),
            Self::Png(png) => png.read_row(row)?.map(drop).ok_or_else(|| io::ErrorKind::UnexpectedEof.into()),
        }
    }
}

fn ppm_header(width: usize, height: usize) -> String {
    format!("P6 {width} {height} 255\n")
}

fn write_ppm(
    out: &mut dyn Write,
    width: usize,
    height: usize,
    rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    out.write_all(ppm_header(width, height).as_bytes())?;
    for bytes in rows {
        out.write_all(&bytes?)?;
    }
    out.flush()
}

/// The colour space that a PNG declares: its bytes are to be shown as sRGB, like those of a PPM and those of the notes'
/// images.
///
/// No transfer function is applied: the byte of a channel is 255 times what the notes' formulas give, truncated. So the
/// formulas work in encoded display values, not in linear light, where one half would be byte 188. That is how scenes
/// were made and viewed: their numbers were chosen for a display that takes the bytes as they are. `gAMA` 1 would
/// declare the bytes proportional to light, and a viewer that honours it would show the same scene far brighter than
/// its PPM.
pub const AS_SHOWN: png::SrgbRenderingIntent = png::SrgbRenderingIntent::RelativeColorimetric;

/// Returns the number of pixels per metre that a PNG records, which is a whole number.
pub fn per_metre(dpi: u32) -> u32 {
    (f64::from(dpi) / 0.0254).round() as u32
}

fn write_png(
    out: &mut dyn Write,
    [width, height]: [usize; 2],
    about: &About,
    (compression, renderer): (Compression, Option<&Renderer>),
    rows: impl IntoIterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    let size = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
    let mut encoder = png::Encoder::new(out, size(width)?, size(height)?);
    encoder.set_color(if about.alpha { png::ColorType::Rgba } else { png::ColorType::Rgb });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(AS_SHOWN);
    encoder.set_pixel_dims(about.dpi.map(|dpi| {
        let side = per_metre(dpi);
        png::PixelDimensions { xppu: side, yppu: side, unit: png::Unit::Meter }
    }));
    for (keyword, text) in about.texts {
        let (keyword, text) = (String::from(*keyword), text.clone());
        match text.is_ascii() {
            true => encoder.add_text_chunk(keyword, text)?,
            false => encoder.add_itxt_chunk(keyword, text)?,
        }
    }
    let mut writer = encoder.write_header()?;
    let put = |bytes: &[u8]| writer.write_chunk(png::chunk::IDAT, bytes).map_err(io::Error::from);
    Packing::new(([width, height], about.channels()), compression, renderer).run(rows, put)?;
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::packing::PIECE;
    use std::io::Seek;

    fn pool(threads: usize) -> rayon::ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
    }

    #[test]
    fn a_png_is_the_same_file_however_its_rows_come_and_on_any_threads() {
        let renderers =
            [None, Some(1), Some(3)].map(|threads| threads.map(|n| Renderer::on_threads(pool(n))));
        for (width, height) in [(37, 29), (640, 640), (700, 2100)] {
            let pixels: Vec<u8> = (0..3 * width * height).map(|byte| (byte * byte / 977) as u8).collect();
            for compression in [Compression::Fast, Compression::Balanced, Compression::High] {
                let (mut files, format) = (Vec::new(), Format::Png(compression));
                for (rows, renderer) in [height, height - 1, 7].into_iter().zip(&renderers) {
                    let (mut png, bands) =
                        (Vec::new(), pixels.chunks(3 * width * rows).map(|band| Ok(band.to_vec())));
                    let written = format.write_on(
                        renderer.as_ref(),
                        &About::default(),
                        &mut png,
                        [width, height],
                        bands,
                    );
                    written.expect("memory takes it");
                    files.push(png);
                }
                let read = image::load_from_memory(&files[0]).expect("a PNG").into_rgb8();
                assert!(read.into_raw() == pixels, "{width} x {height}, {compression:?}");
                assert!(files.iter().all(|file| *file == files[0]), "{width} x {height}, {compression:?}");
            }
        }
    }

    #[test]
    fn a_png_that_breaks_off_has_the_rows_before() {
        let [width, height] = [700, 2100];
        let pixels: Vec<u8> = (0..3 * width * height).map(|byte| (byte * byte / 977) as u8).collect();
        for compression in [Compression::Fast, Compression::Balanced] {
            let rows = pixels[..3 * width * 901].chunks(3 * width * 17).map(|rows| Ok(rows.to_vec()));
            let mut file = tempfile::tempfile().expect("a file");
            let broken = rows.chain([Err(io::ErrorKind::Other.into())]);
            let written = Format::Png(compression).write(&mut file, [width, height], broken);
            assert_eq!(written.expect_err("an error").kind(), io::ErrorKind::Other);
            file.rewind().expect("a file");
            let mut read = Format::Png(compression).read(file).expect("a PNG");
            let mut row = vec![0; 3 * width];
            for (index, expected) in pixels.chunks(3 * width).take(900).enumerate() {
                read.next(&mut row).expect("a row");
                assert!(row == expected, "{compression:?}, row {index}");
            }
        }
    }

    #[test]
    fn a_png_says_how_its_bytes_are_shown() {
        for bytes in [12, PIECE + 3] {
            let mut png = Vec::new();
            let rows = [Ok(vec![7; 3 * (bytes / 3)])];
            Format::Png(Compression::Fast).write(&mut png, [bytes / 3, 1], rows).expect("memory takes it");
            let read = png::Decoder::new(io::Cursor::new(png)).read_info().expect("a PNG");
            assert_eq!(read.info().srgb, Some(AS_SHOWN));
        }
    }
}
