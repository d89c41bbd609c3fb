//! Textures: images that colour surfaces and light.

use crate::display::Display;
use crate::image_file;
use crate::material::Rgb;
use crate::number::{MAX_TEXELS, Number, hull};
use crate::rules::Rules;
use crate::sensor::Sensor;
use crate::sums::Sums;
use crate::texels::Texels;
use glam::{DVec2, DVec3};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use tabray_exact::scalar::constants;

/// The default opacity below which a place of an image is cut out.
pub const CUTOFF: f64 = 0.5;

/// An image in a file. It is read once, when it is first needed.
#[derive(Debug, Default)]
pub struct Texture {
    path: PathBuf,
    /// The contents of the file, where they are not to be read from the path.
    contents: Option<Vec<u8>>,
    /// Whether transparent texels show their colours as other texels do, and the opacity of each texel is kept.
    is_opaque: bool,
    alpha: Alpha,
    /// The display of the rendered image; that of the notes' rules unless it is set.
    display: OnceLock<Display>,
    picture: OnceLock<Result<Picture, String>>,
}

/// What the alpha of a texture does to surfaces on which it is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Alpha {
    /// Nothing: transparent texels show the object's own colour.
    #[default]
    Own,
    /// It cuts them out where it is below [`CUTOFF`].
    CutsOut,
    /// It is the fraction of what is behind them that they cover.
    Covers,
}

/// An image that was read.
#[derive(Debug)]
struct Picture {
    texels: Texels,
    /// The sums over texels, made when the first mean is asked for.
    sums: OnceLock<Sums>,
    remarks: Vec<&'static str>,
}

/// Textures are equal if their paths are, and their alpha does the same.
impl PartialEq for Texture {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path && self.alpha == other.alpha
    }
}

impl Texture {
    /// Makes a texture of an image file. Nothing is read yet.
    pub fn new(path: PathBuf) -> Self {
        Self { path, ..Self::default() }
    }

    /// Makes a texture of a model, in which transparent texels show their colours as others do. `contents` are those
    /// of the image file, where they are not to be read from the path.
    pub fn of_model(path: PathBuf, contents: Option<Vec<u8>>) -> Self {
        Self { path, contents, is_opaque: true, ..Self::default() }
    }

    /// Makes a texture of an image file whose alpha does this.
    pub fn with_alpha(path: PathBuf, alpha: Alpha) -> Self {
        Self { path, is_opaque: alpha != Alpha::Own, alpha, ..Self::default() }
    }

    /// Returns what the [`alpha`](Self::alpha) does.
    pub fn alpha_use(&self) -> Alpha {
        self.alpha
    }

    /// Tells whether there are places where the texture cuts surfaces out.
    pub fn cuts_out(&self) -> bool {
        self.alpha != Alpha::Own
    }

    /// Tells whether the texture cuts a surface out where its [`alpha`](Self::alpha) is this.
    pub fn is_hole(&self, alpha: f64) -> bool {
        match self.alpha {
            Alpha::Own => false,
            Alpha::Covers if self.covers_in_part() => alpha <= 0.0,
            Alpha::CutsOut | Alpha::Covers => alpha < CUTOFF,
        }
    }

    /// Tells whether the [`alpha`](Self::alpha) is the fraction of what is behind a surface that it covers: the notes'
    /// rules of light know none but 0 and 1.
    pub fn covers_in_part(&self) -> bool {
        self.alpha == Alpha::Covers
            && self.display.get().is_some_and(|display| display.rules() == Rules::Free)
    }

    /// Returns the path of the image file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Sets the display that turns bytes into light. This must be done before the file is read.
    pub fn decode_by(&self, display: Display) {
        let _ = self.display.set(display);
    }

    /// Returns the texels, and reads their file at the first call.
    ///
    /// # Errors
    /// Returns the reason why the image cannot be read.
    pub fn load(&self) -> Result<&Texels, &str> {
        self.load_within(u64::MAX)
    }

    /// Returns the texels, and reads their file at the first call, unless that takes more than `bytes` bytes of memory.
    ///
    /// # Errors
    /// Returns the reason why the image cannot be read.
    pub fn load_within(&self, bytes: u64) -> Result<&Texels, &str> {
        let picture = self.picture.get_or_init(|| self.read(bytes));
        picture.as_ref().map(|picture| &picture.texels).map_err(String::as_str)
    }

    fn read(&self, most: u64) -> Result<Picture, String> {
        let display = self.display.get_or_init(|| Sensor::default().display());
        let (texels, remarks) = match &self.contents {
            None => image_file::read(&self.path, self.is_opaque, display, most),
            Some(contents) => image_file::decode(contents, self.is_opaque, display, most),
        }?;
        Ok(Picture { texels, sums: OnceLock::new(), remarks })
    }

    /// Returns the remarks on differences from the image, phrased to follow the texture's name.
    pub fn remarks(&self) -> &[&'static str] {
        self.picture.get().and_then(|picture| picture.as_ref().ok()).map_or(&[], |picture| &picture.remarks)
    }

    /// Returns the memory that the image takes, in bytes; 0 if it has not been read.
    pub fn bytes(&self) -> u64 {
        let picture = self.picture.get().and_then(|picture| picture.as_ref().ok());
        picture
            .map_or(0, |picture| picture.texels.memory() + self.contents.as_ref().map_or(0, Vec::len) as u64)
    }

    /// Tells whether no file exists at the path.
    pub fn is_missing(&self) -> bool {
        self.contents.is_none()
            && fs::metadata(&self.path).is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
    }

    /// Returns the width and height in texels; 0 and 0 where the image cannot be read.
    pub fn size(&self) -> [u32; 2] {
        self.load().map_or([0, 0], Texels::size)
    }

    /// Returns the light of a texel by its column from the left and its row from the bottom, each channel from 0 to
    /// [`brightest`](Self::brightest). Beyond an edge, it is that of the texel at the edge. A texture whose image
    /// cannot be read is white.
    pub fn texel(&self, column: u32, row: u32) -> Rgb {
        self.load().map_or(Rgb::ONE, |texels| texels.light(column, row))
    }

    /// Returns the mean light of a rectangle, given by its lower left and its upper right corner in texels. Beyond an
    /// edge of the image, texels are those at the edge.
    pub fn mean(&self, low: DVec2, high: DVec2) -> Rgb {
        let Ok(texels) = self.load() else { return Rgb::ONE };
        let Some(Ok(picture)) = self.picture.get() else { return Rgb::ONE };
        let size = DVec2::from(texels.size().map(f64::from));
        let (low, high) = (low.clamp(DVec2::ZERO, size), high.clamp(DVec2::ZERO, size));
        if (high.floor() - low.floor()).max_element() < MAX_TEXELS as f64 {
            return texels.mean_of_few(low, high);
        }
        picture.sums.get_or_init(|| Sums::of(texels)).mean(low, high)
    }

    /// Returns a texel of an image of other numbers than colours, each from 0 to 1, as [`texel`](Self::texel) does.
    /// If the image cannot be read, the numbers are 0.5, 0.5 and 1, which stand for a straight normal.
    pub fn numbers(&self, column: u32, row: u32) -> DVec3 {
        self.load().map_or(DVec3::new(0.5, 0.5, 1.0), |texels| texels.numbers(column, row))
    }

    /// Returns the opacity of a texel, from 0 to 1, as [`texel`](Self::texel) does: 1 unless the texture's
    /// alpha does anything, or it is one of a model.
    pub fn alpha(&self, column: u32, row: u32) -> f64 {
        self.load().map_or(1.0, |texels| texels.alpha(column, row))
    }

    /// Blends the light of texels, each as much as it covers: those that cover nothing may have any colour. `blend`
    /// returns the weighted mean of what a function returns for each texel by its column and its row.
    pub fn by_alpha(&self, blend: impl Fn(&dyn Fn(u32, u32) -> DVec3) -> DVec3) -> Rgb {
        let covered = blend(&|column, row| DVec3::splat(self.alpha(column, row))).x;
        match covered > 0.0 {
            true => blend(&|column, row| self.alpha(column, row) * self.texel(column, row)) / covered,
            false => blend(&|column, row| self.texel(column, row)),
        }
    }

    /// Tells whether [`alpha`](Self::alpha) is below 1 anywhere.
    pub fn has_alpha(&self) -> bool {
        self.load().is_ok_and(Texels::has_alpha)
    }

    /// Bounds the light of a channel of any texel: 1, unless the file has colours above 1 and the rules of light show
    /// them.
    pub fn brightest(&self) -> f64 {
        self.load().map_or(1.0, Texels::brightest)
    }

    /// Encloses the texels of at least one column and row. If they are many, the channels may be anything that
    /// a texel may be.
    pub fn enclose<N: Number>(
        &self,
        columns: impl Iterator<Item = u32> + Clone,
        rows: impl Iterator<Item = u32> + Clone,
    ) -> [N; 3] {
        let any = || [N::any(0.0, self.brightest()); 3];
        if columns.clone().nth(MAX_TEXELS).is_some() || rows.clone().nth(MAX_TEXELS).is_some() {
            return any();
        }
        let of_row = |row: u32| columns.clone().map(move |column| constants(self.texel(column, row)));
        rows.flat_map(of_row).reduce(hull).unwrap_or_else(any)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display::{Tone, Transfer};
    use crate::text;
    use image::{DynamicImage, ImageEncoder, ImageFormat, Rgb as Texel, Rgb32FImage, RgbImage, RgbaImage};
    use tempfile::TempDir;

    fn texture(folder: &TempDir, name: &str, bytes: &[u8]) -> Texture {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("a file");
        Texture::new(path)
    }

    /// Returns an image of three by two texels, in a format that keeps its colours.
    fn written(format: ImageFormat) -> Vec<u8> {
        let image = RgbImage::from_fn(3, 2, |x, y| Texel([50 * x as u8, 90 * y as u8, 200]));
        let mut bytes = io::Cursor::new(Vec::new());
        DynamicImage::ImageRgb8(image).write_to(&mut bytes, format).expect("an image");
        bytes.into_inner()
    }

    /// Returns the bytes of a texel by its column and its row from the top.
    fn bytes_at(texture: &Texture, [x, y]: [u32; 2]) -> [u8; 3] {
        let row = texture.size()[1] - 1 - y;
        texture.texel(x, row).to_array().map(|channel| (256.0 * channel) as u8)
    }

    #[test]
    fn images_of_all_formats_are_read_whatever_their_names() {
        let folder = TempDir::new().expect("a folder");
        for format in [
            ImageFormat::Png,
            ImageFormat::Pnm,
            ImageFormat::Bmp,
            ImageFormat::Tiff,
            ImageFormat::WebP,
            ImageFormat::Tga,
        ] {
            let texture = texture(&folder, "a.jpg", &written(format));
            assert_eq!(bytes_at(&texture, [2, 1]), [100, 90, 200], "{format:?}");
            assert!(texture.remarks().is_empty());
        }
        let near =
            |texel: [u8; 3]| texel.iter().zip([100, 90, 200]).all(|(one, other)| one.abs_diff(other) < 25);
        let texture = texture(&folder, "a.png", &written(ImageFormat::Jpeg));
        assert!(near(bytes_at(&texture, [2, 1])));
    }

    /// A BMP may have masks for red, green, blue and alpha after its first header.
    #[test]
    fn a_bmp_with_four_masks_after_its_first_header_is_read() {
        let folder = TempDir::new().expect("a folder");
        let head = [40_u32, 2, 1, 0x0020_0001, 6, 8, 0, 0, 0, 0];
        let masks = [0xff00_0000, 0x0000_ff00, 0x0000_00ff, 0x00ff_0000];
        let numbers = [&[78, 0, 70][..], &head, &masks, &[0x64ff_5ac8, 0x00ff_0000]].concat();
        let mut bytes = b"BM".to_vec();
        bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        let read = texture(&folder, "a.bmp", &bytes);
        assert_eq!([[0, 0], [1, 0]].map(|at| bytes_at(&read, at)), [[100, 90, 200], [0, 0, 0]]);
        for end in 0..bytes.len() {
            assert!(texture(&folder, "a.bmp", &bytes[..end]).load().is_err(), "{end}");
        }
    }

    #[test]
    fn an_image_that_takes_too_much_memory_is_refused_before_it_is_decoded() {
        let folder = TempDir::new().expect("a folder");
        for format in
            [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Tiff, ImageFormat::WebP, ImageFormat::Jpeg]
        {
            let texture = texture(&folder, "a", &written(format));
            let refusal = texture.load_within(17).expect_err("too large");
            assert!(refusal.contains("it takes more than 17 B of memory"), "{format:?} {refusal}");
        }
    }

    /// A text of numbers has no end, but a number of them.
    #[test]
    fn a_cut_image_is_refused_or_shows_the_same_texels() {
        const LENGTHS: usize = 150;
        let folder = TempDir::new().expect("a folder");
        let noise = |x: u32, y: u32, channel: u32| ((x * 7919 + y * 104_729 + channel * 1299) % 251) as u8;
        let picture = RgbImage::from_fn(40, 30, |x, y| Texel([0, 1, 2].map(|channel| noise(x, y, channel))));
        for format in [
            ImageFormat::Png,
            ImageFormat::Bmp,
            ImageFormat::Tiff,
            ImageFormat::WebP,
            ImageFormat::Jpeg,
            ImageFormat::Pnm,
            ImageFormat::Hdr,
            ImageFormat::OpenExr,
            ImageFormat::Tga,
        ] {
            let mut bytes = io::Cursor::new(Vec::new());
            let picture = DynamicImage::ImageRgb8(picture.clone());
            match format {
                ImageFormat::Hdr | ImageFormat::OpenExr => picture.into_rgb32f().write_to(&mut bytes, format),
                _ => picture.write_to(&mut bytes, format),
            }
            .expect("an image");
            cut(&folder, format, &bytes.into_inner());
        }
        let numbers: String = picture.iter().map(|channel| format!("{channel} ")).collect();
        cut(&folder, ImageFormat::Pnm, format!("P3 40 30 255\n{numbers}").as_bytes());

        fn cut(folder: &TempDir, format: ImageFormat, bytes: &[u8]) {
            let texels = |bytes: &[u8]| {
                let texture = texture(folder, "a", bytes);
                texture.load().is_ok().then(|| {
                    let all = (0..30).flat_map(|y| (0..40).map(move |x| [x, y]));
                    all.map(|at| bytes_at(&texture, at)).collect::<Vec<_>>()
                })
            };
            let whole = texels(bytes).unwrap_or_else(|| panic!("{format:?} is not read"));
            for cut in 0..LENGTHS {
                let length = bytes.len() * cut / LENGTHS;
                if let Some(shown) = texels(&bytes[..length]) {
                    assert!(shown == whole, "{format:?}, {length} of {} bytes", bytes.len());
                }
            }
        }
    }

    #[test]
    fn transparent_texels_show_the_objects_own_colour() {
        let folder = TempDir::new().expect("a folder");
        let image = RgbaImage::from_fn(2, 1, |x, _| image::Rgba([200, 100, 0, if x == 0 { 0 } else { 51 }]));
        let mut bytes = io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).expect("an image");
        let texture = texture(&folder, "a.png", &bytes.into_inner());
        assert_eq!([0, 1].map(|x| bytes_at(&texture, [x, 0])), [[255; 3], [244, 224, 204]]);
        assert_eq!(texture.remarks().len(), 1);
    }

    #[test]
    fn texels_of_a_cut_out_image_keep_their_colours_and_their_alpha() {
        let folder = TempDir::new().expect("a folder");
        let image = RgbaImage::from_fn(2, 1, |x, _| image::Rgba([200, 100, 0, if x == 0 { 0 } else { 51 }]));
        let path = folder.path().join("a.png");
        image.save(&path).expect("an image");
        let texture = Texture::with_alpha(path, Alpha::CutsOut);
        assert_eq!([0, 1].map(|x| bytes_at(&texture, [x, 0])), [[200, 100, 0]; 2]);
        assert_eq!([0, 1].map(|x| texture.alpha(x, 0)), [0.0, 0.2]);
        assert!(texture.remarks().is_empty());
    }

    #[test]
    fn a_photograph_is_turned_as_it_says() {
        let folder = TempDir::new().expect("a folder");
        let mut bytes = Vec::new();
        let mut encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 100);
        // An orientation of 6: to be turned clockwise.
        let exif = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0".to_vec();
        encoder.set_exif_metadata(exif).expect("metadata");
        let image = RgbImage::from_fn(32, 16, |x, _| Texel([if x < 16 { 0 } else { 255 }; 3]));
        encoder.write_image(image.as_raw(), 32, 16, image::ExtendedColorType::Rgb8).expect("an image");
        let texture = texture(&folder, "a.jpg", &bytes);
        assert_eq!(texture.size(), [16, 32]);
        assert!(bytes_at(&texture, [8, 2])[0] < 9 && bytes_at(&texture, [8, 30])[0] > 246);
    }

    #[test]
    fn bytes_stand_for_the_light_that_an_image_shows_with_them() {
        let folder = TempDir::new().expect("a folder");
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            let display = Display::new(Rules::Free, 0.0, Tone::Clip, transfer);
            let texture = texture(&folder, "a.png", &written(ImageFormat::Png));
            texture.decode_by(display);
            assert_eq!(display.bytes(texture.texel(2, 0)), [100, 90, 200]);
            assert_eq!(texture.brightest(), 1.0);
        }
    }

    #[test]
    fn light_above_white_is_kept_by_the_free_rules_alone() {
        let folder = TempDir::new().expect("a folder");
        let image = Rgb32FImage::from_pixel(1, 1, Texel([7.5, 0.25, -1.0]));
        let mut bytes = io::Cursor::new(Vec::new());
        DynamicImage::ImageRgb32F(image).write_to(&mut bytes, ImageFormat::OpenExr).expect("an image");
        let texture = || texture(&folder, "a.exr", bytes.get_ref());
        let (notes, free) = (texture(), texture());
        free.decode_by(Display::new(Rules::Free, 3.0, Tone::Neutral, Transfer::Srgb));
        assert_eq!((free.texel(0, 0), free.brightest()), (Rgb::new(7.5, 0.25, 0.0), 7.5));
        assert!(free.remarks().is_empty());
        assert_eq!(bytes_at(&notes, [0, 0]), [255, 64, 0]);
        assert_eq!(notes.remarks().len(), 1);
    }

    #[test]
    fn other_files_are_named_with_the_cure() {
        let folder = TempDir::new().expect("a folder");
        for (bytes, said) in [
            (&b"GIF89a\x01\0\x01\0\0\0\0"[..], "it is a GIF, which is not read: save it as PNG"),
            (b"<svg xmlns='x'/>", "it is XML, as SVG is: save it as PNG"),
            (b"\0\0\0\x18ftypheic\0\0\0\0", "it is a HEIC, an AVIF or a film: save it as PNG"),
            (b"one two three", text::NO_IMAGE),
        ] {
            assert_eq!(texture(&folder, "a.png", bytes).load().err(), Some(said));
        }
    }
}
