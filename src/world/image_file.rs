//! Image files of any format, decoded to texels within a limit of memory.

use crate::bmp_file;
use crate::display::Display;
use crate::exr_file;
use crate::files::ImageBytes;
use crate::files::held::SceneFile;
use crate::texels::Texels;
use crate::text;
use crate::whole_image;
use bytesize::ByteSize;
use image::metadata::Orientation;
use image::{
    ColorType, DynamicImage, GrayImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, Luma,
    Rgb as Texel, Rgb32FImage, RgbImage,
};
use std::io::{BufReader, Cursor, Read, Seek};
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;

/// The memory that a decoder may take in addition to the image, in bytes.
const ASIDE: u64 = 1 << 20;

/// File types that the image reader neither reads nor recognises: their first bytes, the offset of these, and the
/// name of the type.
const OTHERS: [(&[u8], usize, &str); 13] = [
    (b"<", 0, "XML, as SVG is"),
    (b"8BPS", 0, "a file of Photoshop"),
    (b"ftyp", 4, "a HEIC, an AVIF or a film"),
    (b"JXL ", 4, "a JPEG XL"),
    (b"\xff\x0a", 0, "a JPEG XL"),
    (b"jP  ", 4, "a JPEG 2000"),
    (b"%PDF", 0, "a PDF"),
    (b"%!PS", 0, "PostScript"),
    (b"gimp xcf", 0, "a file of GIMP"),
    (b"\xabKTX", 0, "a KTX"),
    (b"\x0a\x05\x01", 0, "a PCX"),
    (b"\x01\xda", 0, "an SGI image"),
    (b"SIMPLE  =", 0, "a FITS"),
];

const SEES_THROUGH: &str =
    "has transparent texels, which do not show what is behind an object but its own colour";

/// The texels of an image, with remarks on their differences from the image.
pub(super) type Decoded = (Texels, Vec<&'static str>);

/// Decodes an image whose bytes are given.
///
/// # Errors
/// Returns the reason why the image cannot be decoded.
pub(super) fn decode(
    contents: &[u8],
    is_opaque: bool,
    display: &Display,
    most: u64,
) -> Result<Decoded, String> {
    decode_from(&mut Cursor::new(contents), contents.len() as u64, is_opaque, display, most)
}

/// Reads an image file, within `most` bytes of memory. With `is_opaque`, transparent texels keep their colours, and the
/// opacity of each is kept; otherwise, the image is laid over white. `display` says how an image shows light.
///
/// # Errors
/// Returns the reason why the image cannot be read.
pub(super) fn read(path: &Path, is_opaque: bool, display: &Display, most: u64) -> Result<Decoded, String> {
    let file = SceneFile::open(path).map_err(|error| text::reason(&error))?;
    let length = file.length().map_err(|error| text::reason(&error))?;
    decode_from(&mut BufReader::new(file), length, is_opaque, display, most)
}

fn decode_from(
    bytes: &mut dyn ImageBytes,
    length: u64,
    is_opaque: bool,
    display: &Display,
    most: u64,
) -> Result<Decoded, String> {
    let too_much = || format!("it takes more than {} of memory", ByteSize(most));
    let cannot = |error: ImageError| match error {
        ImageError::Limits(_) => too_much(),
        _ => text::picture_reason(&error),
    };
    // Some decoders hold the whole file.
    if length > most {
        return Err(too_much());
    }
    // A colour profile, which is not used, may be a thousand times as long as its compressed form in a PNG.
    let row = row_of_png(bytes.fill_buf().map_err(|error| text::reason(&error))?);
    let beside = row.map_or(most, |row| most.min(row + length));
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(beside.saturating_add(ASIDE));
    let reader = ImageReader::new(bytes).with_guessed_format();
    let reader = reader.map_err(|error| text::reason(&error))?;
    let format = reader.format();
    let bytes = reader.into_inner();
    let Some(format) = format.or_else(|| is_tga(bytes).then_some(ImageFormat::Tga)) else {
        return Err(other(bytes));
    };
    if !whole_image::has_end(format, bytes, length).map_err(|error| text::reason(&error))? {
        return Err("it ends early".to_owned());
    }
    let cannot = |error: ImageError| exr_file::reason_of(&error).unwrap_or_else(|| cannot(error));
    let is_read = |bytes: &mut dyn ImageBytes| ImageReader::with_format(bytes, format).into_decoder().is_ok();
    if format == ImageFormat::OpenExr && !is_read(bytes) {
        let (picture, are_several) = exr_file::read(bytes, most)?;
        let is_light = display.truncates().is_none();
        let (texels, mut remarks) = texels(picture, is_light, is_opaque, Orientation::NoTransforms, display);
        remarks.extend(are_several.then_some("has several layers, and the first of its colours are shown"));
        return Ok((texels, remarks));
    }
    bytes.rewind().map_err(|error| text::reason(&error))?;
    let beginning = bytes.fill_buf().map_err(|error| text::reason(&error))?;
    if format == ImageFormat::Bmp && bmp_file::has_four_masks(beginning) {
        let mut all = Vec::new();
        bytes.read_to_end(&mut all).map_err(|error| text::reason(&error))?;
        let later = bmp_file::with_later_header(&all).ok_or("it ends early")?;
        let most = most.saturating_sub(length + later.len() as u64);
        return decode(&later, is_opaque, display, most);
    }
    let mut reader = ImageReader::with_format(bytes, format);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(cannot)?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 {
        return Err(format!("it is {width} x {height} pixels, so it is empty"));
    }
    let (colours, orientation) =
        (decoder.color_type(), decoder.orientation().unwrap_or(Orientation::NoTransforms));
    let is_light = matches!(colours, ColorType::Rgb32F | ColorType::Rgba32F) && display.truncates().is_none();
    let pixels = u64::from(width) * u64::from(height);
    let beside = beside_decoded(format, length, pixels, (colours, is_light, orientation));
    if decoder.total_bytes().saturating_add(beside) > most {
        return Err(too_much());
    }
    // A decoder that panics, as that of TIFF does at tiles of separate planes, has met what it does not read.
    let decoded = panic::catch_unwind(AssertUnwindSafe(|| DynamicImage::from_decoder(decoder)));
    let picture = decoded.map_err(|_| text::not_read(format))?.map_err(cannot)?;
    Ok(texels(picture, is_light, is_opaque, orientation, display))
}

/// Returns the memory that an image takes in addition to its decoder's result, in bytes.
fn beside_decoded(
    format: ImageFormat,
    length: u64,
    pixels: u64,
    (colours, is_light, orientation): (ColorType, bool, Orientation),
) -> u64 {
    let each = if is_light { 4 } else { 1 };
    // The copies: as decoded, as red, green and blue, and turned.
    let copies = match colours {
        ColorType::Rgb8 => 0,
        colours if colours.has_alpha() => each * (4 + 3) + 3,
        _ => each * 3,
    };
    let turned = if orientation == Orientation::NoTransforms { 0 } else { each * 3 };
    // These decoders have no limits of their own.
    let aside = match format {
        ImageFormat::Jpeg | ImageFormat::WebP => length + 6 * pixels,
        ImageFormat::Tga => length,
        _ => 0,
    };
    ((copies + turned) * pixels).saturating_add(aside)
}

/// Converts a decoded image to texels, and turns it.
fn texels(
    picture: DynamicImage,
    is_light: bool,
    is_opaque: bool,
    orientation: Orientation,
    display: &Display,
) -> Decoded {
    let mut remarks = Vec::new();
    if is_bright(&picture) && !is_light {
        remarks.push("has colours above 1, which are cut to 1");
    }
    let has_alpha = picture.color().has_alpha();
    let alpha = if is_opaque && has_alpha { alpha_of(&picture) } else { None };
    let mut image = match (is_light, has_alpha && !is_opaque) {
        (true, true) => DynamicImage::ImageRgb32F(light_over_white(picture, &mut remarks)),
        (true, false) => DynamicImage::ImageRgb32F(picture.into_rgb32f()),
        (false, true) => DynamicImage::ImageRgb8(over_white(picture, &mut remarks)),
        (false, false) => DynamicImage::ImageRgb8(picture.into_rgb8()),
    };
    image.apply_orientation(orientation);
    let alpha = alpha.map(|alpha| {
        let mut alpha = DynamicImage::ImageLuma8(alpha);
        alpha.apply_orientation(orientation);
        alpha.into_luma8()
    });
    let texels = match is_light {
        true => Texels::of_light(image.into_rgb32f(), alpha),
        false => Texels::of_bytes(image.into_rgb8(), alpha, display),
    };
    (texels, remarks)
}

/// Returns the greatest length of a row of a PNG with this beginning, in bytes; `None` for another image.
fn row_of_png(head: &[u8]) -> Option<u64> {
    let width = head.strip_prefix(b"\x89PNG\r\n\x1a\n")?.get(8..12)?;
    Some(8 * u64::from(u32::from_be_bytes(width.try_into().ok()?)))
}

/// Tells whether a file begins as a TGA, which has no mark of its own: by its numbers, of which each has few values.
fn is_tga(bytes: &mut dyn ImageBytes) -> bool {
    let mut head = [0; 18];
    let is_read = bytes.rewind().and_then(|()| bytes.read_exact(&mut head)).is_ok();
    let [_, map, kind, _, _, _, _, entry, _, _, _, _, w, w2, h, h2, depth, descriptor] = head;
    let is_mapped = matches!(kind, 1 | 9);
    is_read
        && matches!(kind, 1..=3 | 9..=11)
        && matches!((map, entry), (0, 0) | (1, 15 | 16 | 24 | 32))
        && (map == 1 || !is_mapped)
        && matches!(depth, 8 | 15 | 16 | 24 | 32)
        && [w, w2] != [0; 2]
        && [h, h2] != [0; 2]
        && descriptor & 0xc0 == 0
        && descriptor & 0x0f <= 8
}

/// Names the type of a file that the image reader does not know.
fn other(mut file: impl Read + Seek) -> String {
    let mut start = [0; 16];
    let read = file.rewind().and_then(|()| file.read(&mut start));
    let known = |(begins, at, _): &&(&[u8], usize, &str)| start[*at..].starts_with(begins);
    match OTHERS.iter().find(known) {
        Some((_, _, what)) if read.is_ok() => format!("it is {what}: save it as PNG"),
        _ => text::NO_IMAGE.to_owned(),
    }
}

/// Tells whether colours of an image are brighter than white.
fn is_bright(picture: &DynamicImage) -> bool {
    match picture {
        DynamicImage::ImageRgb32F(image) => image.iter().any(|channel| *channel > 1.0),
        DynamicImage::ImageRgba32F(image) => image.iter().any(|channel| *channel > 1.0),
        _ => false,
    }
}

/// Returns the opacity of an image's pixels, if any pixel is not opaque.
fn alpha_of(picture: &DynamicImage) -> Option<GrayImage> {
    let picture = picture.to_luma_alpha8();
    let is_opaque = picture.pixels().all(|pixel| pixel.0[1] == u8::MAX);
    let alpha = |x, y| Luma([picture.get_pixel(x, y).0[1]]);
    (!is_opaque).then(|| GrayImage::from_fn(picture.width(), picture.height(), alpha))
}

/// Lays an image over white, so that an object shows its own colours where a texel is transparent.
fn over_white(picture: DynamicImage, remarks: &mut Vec<&'static str>) -> RgbImage {
    let picture = picture.into_rgba8();
    if picture.pixels().any(|texel| texel.0[3] < u8::MAX) {
        remarks.push(SEES_THROUGH);
    }
    let over = |[red, green, blue, alpha]: [u8; 4]| {
        let alpha = u16::from(alpha);
        [red, green, blue]
            .map(|channel| ((u16::from(channel) * alpha + 255 * (255 - alpha) + 127) / 255) as u8)
    };
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| Texel(over(picture.get_pixel(x, y).0)))
}

/// Lays light over white as [`over_white`] does.
fn light_over_white(picture: DynamicImage, remarks: &mut Vec<&'static str>) -> Rgb32FImage {
    let picture = picture.into_rgba32f();
    if picture.pixels().any(|texel| texel.0[3] < 1.0) {
        remarks.push(SEES_THROUGH);
    }
    let over = |[red, green, blue, alpha]: [f32; 4]| {
        [red, green, blue].map(|channel| channel * alpha + (1.0 - alpha))
    };
    Rgb32FImage::from_fn(picture.width(), picture.height(), |x, y| Texel(over(picture.get_pixel(x, y).0)))
}
