//! Textures: pictures that colour surfaces and light.

use crate::words;
use crate::world::material::Rgb;
use image::{ImageReader, RgbImage};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A picture in a file. It is read once, when something first needs it, and never if nothing does.
#[derive(Debug, Default)]
pub struct Texture {
    path: PathBuf,
    picture: OnceLock<Result<RgbImage, String>>,
}

/// Textures are the same where their files are.
impl PartialEq for Texture {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Texture {
    /// The picture of this file: PPM, PGM, PBM or PNG.
    pub fn new(path: PathBuf) -> Self {
        Self { path, picture: OnceLock::new() }
    }

    /// The file of its picture.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The picture, read from its file at the first call.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn load(&self) -> Result<&RgbImage, &str> {
        let read = || {
            let reader = ImageReader::open(&self.path).and_then(ImageReader::with_guessed_format);
            let picture = reader.map_err(|error| self.not_read(&error))?.decode();
            picture.map(|picture| picture.into_rgb8()).map_err(|error| words::picture_reason(&error))
        };
        self.picture.get_or_init(read).as_ref().map_err(String::as_str)
    }

    fn not_read(&self, error: &io::Error) -> String {
        let near = words::nearest_file(&self.path).filter(|_| error.kind() == io::ErrorKind::NotFound);
        match near {
            Some(near) => format!("it does not exist, but `{near}` does"),
            None => words::reason(error),
        }
    }

    /// Width and height in texels; none where there is no picture.
    pub fn size(&self) -> [u32; 2] {
        self.load().map_or([0, 0], |picture| picture.dimensions().into())
    }

    /// A texel by its column from the left and its row from the bottom, each channel from 0 to below 1. Past
    /// an edge is the texel at the edge; no picture is white.
    pub fn texel(&self, column: u32, row: u32) -> Rgb {
        let Ok(picture) = self.load() else { return Rgb::ONE };
        let (width, height) = picture.dimensions();
        let pixel = picture.get_pixel(column.min(width - 1), height - 1 - row.min(height - 1));
        Rgb::from_array(pixel.0.map(f64::from)) / 256.0
    }
}
