//! Reads images, to compare them.

use super::failure::Failure;
use crate::files::{self, ImageBytes};
use crate::text;
use image::{DynamicImage, ImageReader, RgbImage};
use std::io::BufReader;
use std::path::Path;

/// Reads the image in a file.
pub fn read(path: &Path) -> Result<RgbImage, Failure> {
    let cannot = |reason: String| Failure::Usage(format!("cannot read `{}`: {reason}", path.display()), None);
    let file = files::open(path).map_err(|error| cannot(text::reason(&error)))?;
    decode(&mut BufReader::new(file)).map_err(cannot)
}

/// Decodes an image. Content that 8-bit red, green and blue cannot represent is an error, and is not dropped.
pub fn decode(bytes: &mut dyn ImageBytes) -> Result<RgbImage, String> {
    let reader = ImageReader::new(bytes).with_guessed_format().map_err(|error| text::reason(&error))?;
    let picture = reader.decode().map_err(|error| text::picture_reason(&error))?;
    let is_plain = match &picture {
        DynamicImage::ImageLuma8(_) | DynamicImage::ImageRgb8(_) => true,
        DynamicImage::ImageLumaA8(picture) => picture.pixels().all(|pixel| pixel[1] == u8::MAX),
        DynamicImage::ImageRgba8(picture) => picture.pixels().all(|pixel| pixel[3] == u8::MAX),
        _ => false,
    };
    if is_plain {
        Ok(picture.into_rgb8())
    } else {
        Err("it is not an opaque image with 8 bits per channel, and no other kind can be compared".to_owned())
    }
}
