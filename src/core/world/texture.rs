//! Textures: images that colour surfaces and light.

use crate::files::{self, ImageBytes};
use crate::text;
use crate::world::material::Rgb;
use bytesize::ByteSize;
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageReader, Limits, RgbImage};
use std::fs;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, constants, per_axis};

/// The memory that a decoder may take beside the image, in bytes.
const ASIDE: u64 = 1 << 20;

/// The number of columns or rows from which on an enclosure no longer examines each texel.
const MOST_TEXELS: usize = 8;

/// An image in a file. It is read once, when it is first needed.
#[derive(Debug, Default)]
pub struct Texture {
    path: PathBuf,
    image: OnceLock<Result<RgbImage, String>>,
}

/// Textures are equal if their paths are.
impl PartialEq for Texture {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Texture {
    /// Makes a texture of an image file: PPM, PGM, PBM or PNG. Nothing is read yet.
    pub fn new(path: PathBuf) -> Self {
        Self { path, image: OnceLock::new() }
    }

    /// Returns the path of the image file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the image, and reads its file at the first call.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn load(&self) -> Result<&RgbImage, &str> {
        self.load_within(u64::MAX)
    }

    /// Returns the image, and reads its file at the first call, unless that takes more than `bytes` bytes of memory.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn load_within(&self, bytes: u64) -> Result<&RgbImage, &str> {
        self.image.get_or_init(|| self.read(bytes)).as_ref().map_err(String::as_str)
    }

    fn read(&self, most: u64) -> Result<RgbImage, String> {
        let file = files::open(&self.path).map_err(|error| text::reason(&error))?;
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(most.saturating_add(ASIDE));
        let cannot = |error: ImageError| match error {
            ImageError::Limits(_) => format!("it takes more than {} of memory", ByteSize(most)),
            _ => text::picture_reason(&error),
        };
        let bytes: &mut dyn ImageBytes = &mut BufReader::new(file);
        let reader = ImageReader::new(bytes).with_guessed_format();
        let mut reader = reader.map_err(|error| text::reason(&error))?;
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(cannot)?;
        let (width, height) = decoder.dimensions();
        if width == 0 || height == 0 {
            return Err(format!("it is {width} x {height} pixels, and has none"));
        }
        // As it is decoded, and as bytes of red, green and blue.
        let pixels = u64::from(width) * u64::from(height);
        let bytes = if decoder.color_type() == ColorType::Rgb8 { 0 } else { 3 * pixels };
        let bytes = decoder.total_bytes().saturating_add(bytes);
        if bytes > most {
            return Err(format!("it takes more than {} of memory", ByteSize(most)));
        }
        let picture = DynamicImage::from_decoder(decoder).map_err(cannot)?;
        Ok(picture.into_rgb8())
    }

    /// Returns the memory that the image takes, in bytes; 0 if it has not been read.
    pub fn bytes(&self) -> u64 {
        let picture = self.image.get().and_then(|picture| picture.as_ref().ok());
        picture.map_or(0, |picture| picture.as_raw().len() as u64)
    }

    /// Tells whether no file exists at the path.
    pub fn is_missing(&self) -> bool {
        fs::metadata(&self.path).is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
    }

    /// Returns the width and height in texels; 0 and 0 where the image cannot be read.
    pub fn size(&self) -> [u32; 2] {
        self.load().map_or([0, 0], |image| image.dimensions().into())
    }

    /// Returns a texel by its column from the left and its row from the bottom, each channel from 0 to below 1. Beyond
    /// an edge, the texel at the edge is returned; a texture whose image cannot be read is white.
    pub fn texel(&self, column: u32, row: u32) -> Rgb {
        let Ok(image) = self.load() else { return Rgb::ONE };
        let (width, height) = image.dimensions();
        let pixel = image.get_pixel(column.min(width - 1), height - 1 - row.min(height - 1));
        Rgb::from_array(pixel.0.map(f64::from)) / 256.0
    }

    /// Encloses the texels of at least one column and row. If they are many, the channels may be anything from 0 to 1.
    pub fn enclose<F: Float>(
        &self,
        columns: impl Iterator<Item = u32> + Clone,
        rows: impl Iterator<Item = u32> + Clone,
    ) -> [Interval<F>; 3] {
        let any = Interval::constant(0.0).hull(Interval::constant(1.0));
        if columns.clone().nth(MOST_TEXELS).is_some() || rows.clone().nth(MOST_TEXELS).is_some() {
            return [any; 3];
        }
        let of_row = |row: u32| columns.clone().map(move |column| constants(self.texel(column, row)));
        let hull = |one: [Interval<F>; 3], other: [Interval<F>; 3]| {
            per_axis(|channel| one[channel].hull(other[channel]))
        };
        rows.flat_map(of_row).reduce(hull).unwrap_or([any; 3])
    }
}
