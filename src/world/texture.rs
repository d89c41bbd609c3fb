//! Textures: images that colour surfaces and light.

use crate::words;
use crate::world::material::Rgb;
use image::{ImageReader, RgbImage};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

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
        let read = || {
            let reader = ImageReader::open(&self.path).and_then(ImageReader::with_guessed_format);
            let image = reader.map_err(|error| self.not_read(&error))?.decode();
            image.map(|image| image.into_rgb8()).map_err(|error| words::picture_reason(&error))
        };
        self.image.get_or_init(read).as_ref().map_err(String::as_str)
    }

    fn not_read(&self, error: &io::Error) -> String {
        let near = words::nearest_file(&self.path).filter(|_| error.kind() == io::ErrorKind::NotFound);
        match near {
            Some(near) => format!("it does not exist, but `{near}` does"),
            None => words::reason(error),
        }
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
}
