//! Image files with colours as they are computed: numbers of any size, instead of 256 levels.

use crate::output::picture::About;
use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage};
use image::Rgb32FImage;
use std::io::{self, BufRead, Cursor, Read, Write};
use std::path::Path;

/// A file format for colours of full range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FullRange {
    /// OpenEXR.
    Exr,
    /// Portable float map, `PF`.
    Pfm,
}

/// The maximum number of pixels of an image that is read.
const MAX_PIXELS: u64 = 1 << 28;

impl FullRange {
    /// Returns the format that a file's extension names, in upper or lower case.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "exr" => Some(Self::Exr),
            "pfm" => Some(Self::Pfm),
            _ => None,
        }
    }

    /// Writes a whole image: red, green and blue of each pixel, in rows from the top, each from the left. An EXR can have
    /// premultiplied alpha, and says with how many pixels per inch it is to be printed, if that is given.
    ///
    /// # Errors
    /// Returns the errors of `out`, and an error where the format cannot hold the size.
    pub fn write(
        self,
        out: &mut impl Write,
        [width, height]: [usize; 2],
        pixels: &[f32],
        about: &About,
    ) -> io::Result<()> {
        match self {
            Self::Exr => {
                let (mut file, density) = (Cursor::new(Vec::new()), about.dpi.map(|dpi| dpi as f32));
                let written = if about.alpha {
                    let (pixels, _) = pixels.as_chunks::<4>();
                    let channels = SpecificChannels::rgba(|Vec2(x, y)| {
                        <(f32, f32, f32, f32)>::from(pixels[y * width + x])
                    });
                    let mut image = Image::from_channels((width, height), channels);
                    image.layer_data.attributes.horizontal_density = density;
                    image.write().to_buffered(&mut file)
                } else {
                    let (pixels, _) = pixels.as_chunks::<3>();
                    let channels =
                        SpecificChannels::rgb(|Vec2(x, y)| <(f32, f32, f32)>::from(pixels[y * width + x]));
                    let mut image = Image::from_channels((width, height), channels);
                    image.layer_data.attributes.horizontal_density = density;
                    image.write().to_buffered(&mut file)
                };
                written.map_err(io::Error::other)?;
                out.write_all(&file.into_inner())
            }
            Self::Pfm if about.alpha => Err(io::ErrorKind::InvalidInput.into()),
            Self::Pfm => {
                // A negative scale stands for little-endian numbers.
                write!(out, "PF\n{width} {height}\n-1.0\n")?;
                for row in pixels.chunks(3 * width).rev() {
                    let bytes: Vec<u8> = row.iter().flat_map(|number| number.to_le_bytes()).collect();
                    out.write_all(&bytes)?;
                }
                out.flush()
            }
        }
    }
}

/// Reads a portable float map of three channels.
///
/// # Errors
/// Returns the errors of the file, and one of kind `InvalidData` if the file is not such a map.
pub fn read_pfm(mut file: impl BufRead) -> io::Result<Rgb32FImage> {
    let wrong = || io::Error::from(io::ErrorKind::InvalidData);
    let mut line = || {
        // No line of a header is long; a file without line ends must not fill the memory.
        let mut line = String::new();
        file.by_ref().take(64).read_line(&mut line).map_err(|_| wrong())?;
        line.ends_with('\n').then(|| line.trim_end().to_owned()).ok_or_else(wrong)
    };
    if line()? != "PF" {
        return Err(wrong());
    }
    let size = line()?;
    let (width, height) = size.split_once(' ').ok_or_else(wrong)?;
    let [width, height]: [u32; 2] =
        [width.parse().map_err(|_| wrong())?, height.parse().map_err(|_| wrong())?];
    let scale: f32 = line()?.parse().map_err(|_| wrong())?;
    let count = u64::from(width) * u64::from(height);
    if count == 0 || count > MAX_PIXELS || scale == 0.0 || !scale.is_finite() {
        return Err(wrong());
    }
    let mut bytes = Vec::new();
    file.take(12 * count).read_to_end(&mut bytes)?;
    if bytes.len() as u64 != 12 * count {
        return Err(wrong());
    }
    let number = |four: &[u8]| {
        let four = [four[0], four[1], four[2], four[3]];
        if scale < 0.0 { f32::from_le_bytes(four) } else { f32::from_be_bytes(four) }
    };
    // Rows are stored from the bottom.
    let rows = bytes.chunks(12 * width as usize).rev();
    let pixels = rows.flat_map(|row| row.chunks(4).map(number)).collect();
    Rgb32FImage::from_raw(width, height, pixels).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_float_map_is_read_as_it_was_written() {
        let pixels: Vec<f32> = (0..3 * 5 * 2).map(|index| 0.3 * index as f32 - 1.0).collect();
        let mut bytes = Vec::new();
        FullRange::Pfm.write(&mut bytes, [5, 2], &pixels, &About::default()).expect("memory takes it");
        assert_eq!(read_pfm(&bytes[..]).expect("a map").into_raw(), pixels);
        for end in 0..bytes.len() {
            assert!(read_pfm(&bytes[..end]).is_err(), "cut off at {end}");
        }
        assert!(read_pfm(&b"PF\n4294967295 4294967295\n-1\n"[..]).is_err());
    }
}
