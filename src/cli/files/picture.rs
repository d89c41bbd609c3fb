//! Reads images, to compare and to join them.

use crate::process::failure::Failure;
use image::{DynamicImage, ImageFormat, ImageReader, Rgb32FImage, RgbImage};
use std::io::{self, BufReader};
use std::path::Path;
use tabray_core::files::{self, ImageBytes};
use tabray_core::output::full_range::{self, FullRange};
use tabray_core::text;

/// Why no command reads an image that is transparent: it would be another one before each background.
const TRANSPARENT: &str = "it is transparent in places";

/// Returns the failure of a file whose content cannot be read, with the cure of what is transparent.
fn cannot_read(path: &Path, reason: &str) -> Failure {
    let failure = Failure::usage(format!("cannot read `{}`: {reason}", text::shown(path)));
    match reason == TRANSPARENT {
        true => failure.help(
            "render it without `--alpha` and `alpha yes`, or fill its background with a colour in an image editor",
        ),
        false => failure,
    }
}

/// Reads the image in a file.
pub fn read(path: &Path) -> Result<RgbImage, Failure> {
    let file = files::open(path).map_err(|error| Failure::cannot_read(path, &error))?;
    decode(&mut BufReader::new(file)).map_err(|reason| cannot_read(path, &reason))
}

/// An image with bytes or with numbers of full range.
pub enum Picture {
    /// With three bytes for each pixel.
    Bytes(RgbImage),
    /// With three numbers for each pixel.
    FullRange(Rgb32FImage),
}

impl Picture {
    /// Reads the image in a file.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let Some(format) = FullRange::of(path) else { return read(path).map(Self::Bytes) };
        let file = files::open(path).map_err(|error| Failure::cannot_read(path, &error))?;
        let file: &mut dyn ImageBytes = &mut BufReader::new(file);
        let picture = match format {
            FullRange::Pfm => full_range::read_pfm(file).map_err(|error| match error.kind() {
                io::ErrorKind::InvalidData => "it is not a PFM of three channels".to_owned(),
                _ => text::reason(&error),
            }),
            FullRange::Exr => ImageReader::with_format(file, ImageFormat::OpenExr)
                .decode()
                .map_err(|error| text::picture_reason(&error))
                .and_then(|picture| match picture {
                    DynamicImage::ImageRgba32F(picture) if picture.pixels().any(|pixel| pixel[3] != 1.0) => {
                        Err(TRANSPARENT.to_owned())
                    }
                    picture => Ok(picture.into_rgb32f()),
                }),
        };
        picture.map(Self::FullRange).map_err(|reason| cannot_read(path, &reason))
    }

    /// Returns the numbers, where 1 is white.
    pub fn full_range(self) -> Rgb32FImage {
        match self {
            Self::Bytes(picture) => DynamicImage::ImageRgb8(picture).into_rgb32f(),
            Self::FullRange(picture) => picture,
        }
    }

    /// Returns the width and the height in pixels.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Bytes(picture) => picture.dimensions(),
            Self::FullRange(picture) => picture.dimensions(),
        }
    }
}

/// Decodes an image. Content that 8-bit red, green and blue cannot represent is an error, and is not dropped.
pub fn decode(bytes: &mut dyn ImageBytes) -> Result<RgbImage, String> {
    let reader = ImageReader::new(bytes).with_guessed_format().map_err(|error| text::reason(&error))?;
    let picture = reader.decode().map_err(|error| text::picture_reason(&error))?;
    let is_opaque = match &picture {
        DynamicImage::ImageLuma8(_) | DynamicImage::ImageRgb8(_) => true,
        DynamicImage::ImageLumaA8(picture) => picture.pixels().all(|pixel| pixel[1] == u8::MAX),
        DynamicImage::ImageRgba8(picture) => picture.pixels().all(|pixel| pixel[3] == u8::MAX),
        _ => return Err("it does not have 8 bits per channel, and no other bytes can be read".to_owned()),
    };
    if is_opaque { Ok(picture.into_rgb8()) } else { Err(TRANSPARENT.to_owned()) }
}
