//! `--size`, `--quick` and `--crop`: the size of the image, and the part of it that is rendered.

use crate::process::failure::Failure;
use image::ImageReader;
use std::ffi::OsString;
use std::ops::Range;
use std::path::Path;
use tabray_core::text;
use tabray_core::world::sensor::Sensor;

/// The maximum width and the maximum height in pixels, as for `pixeldim`.
const MAX_SIDE: usize = 100_000;

/// The size of the image, and the part of it that is rendered.
#[derive(clap::Args)]
#[group(id = "how large")]
#[command(next_help_heading = "Image")]
pub struct Args {
    /// The width and height of the image in pixels, or only the width, with the height in proportion. By default, those
    /// of the scene's camera
    #[arg(long, value_name = "W|WxH", value_parser = size)]
    size: Option<Size>,
    /// Render a preview: a quarter of the width and height, with one sample per pixel
    #[arg(long, conflicts_with_all = ["size", "samples", "max_error"])]
    quick: bool,
    /// Render only this part of the image, W pixels wide and H pixels high, with the pixels of the whole image. X is
    /// its first column, from 0 at the left, and Y its first row, from 0 at the bottom
    #[arg(long, value_name = "X,Y,W,H", conflicts_with = "aov", value_parser = crop, allow_hyphen_values = true)]
    crop: Option<[i64; 4]>,
    /// Replace a larger image, which `--quick`, `--size` and `--crop` otherwise refuse
    #[arg(long)]
    force: bool,
}

/// A size, as the user asked for it.
#[derive(Clone, Copy)]
struct Size {
    width: usize,
    height: Option<usize>,
}

/// A part of an image.
pub struct Region {
    /// The columns, from 0 at the left.
    pub columns: Range<usize>,
    /// The rows, from 0 at the top.
    pub rows: Range<usize>,
}

impl Region {
    /// Returns the width and the height in pixels.
    pub fn size(&self) -> [usize; 2] {
        [self.columns.len(), self.rows.len()]
    }

    /// Returns the whole image of a camera.
    pub fn whole(camera: &Sensor) -> Self {
        let [width, height] = camera.pixels;
        Self { columns: 0..width, rows: 0..height }
    }
}

impl Args {
    /// Gives the image the requested size, and returns the requested part of it.
    pub fn apply(&self, camera: &mut Sensor) -> Result<Region, Failure> {
        let [width, height] = camera.pixels;
        if self.quick {
            camera.pixels = camera.pixels.map(|side| (side / 4).max(1));
            camera.samples = 1;
        }
        if let Some(size) = self.size {
            let in_proportion = (size.width as f64 * height as f64 / width as f64).round() as usize;
            camera.pixels = [size.width, size.height.unwrap_or(in_proportion.max(1))];
            if camera.pixels[1] > MAX_SIDE {
                return Err(Failure::usage(format!(
                    "an image {} pixels wide would be {} high",
                    size.width, camera.pixels[1]
                ))
                .help(format!(
                    "the maximum is {MAX_SIDE} in each dimension: give a smaller width, or both as `WxH`"
                )));
            }
        }
        match self.crop {
            Some(crop) => part(camera, crop),
            None => Ok(Region::whole(camera)),
        }
    }

    /// Refuses to let a preview, an image of a size asked for or a part replace an image that is larger, such as the one
    /// that took an hour. One with a checkpoint beside it is not finished.
    pub fn refuse_larger(&self, path: &Path, region: &Region) -> Result<(), Failure> {
        let is_asked_for = self.quick || self.size.is_some() || self.crop.is_some();
        let mut checkpoint = path.as_os_str().to_owned();
        checkpoint.push(".checkpoint");
        if self.force || !is_asked_for || !path.is_file() || Path::new(&checkpoint).exists() {
            return Ok(());
        }
        let reader = ImageReader::open(path).and_then(ImageReader::with_guessed_format).ok();
        let Some((width, height)) = reader.and_then(|reader| reader.into_dimensions().ok()) else {
            return Ok(());
        };
        let [new_width, new_height] = region.size();
        if width as usize <= new_width && height as usize <= new_height {
            return Ok(());
        }
        let mut beside = OsString::from(if self.quick { "quick" } else { "other" });
        if let Some(extension) = path.extension() {
            beside.push(".");
            beside.push(extension);
        }
        let old = format!("`{}` is an image of {width} x {height} pixels", text::shown(path));
        let beside = text::quoted(path.with_extension(beside).as_os_str());
        Err(Failure::usage(format!("{old}, and this one would have {new_width} x {new_height}"))
            .help(format!("write it beside that one with `-o {beside}`, or replace that one with `--force`")))
    }
}

/// Returns the part that the user named, if the image contains it.
fn part(camera: &Sensor, [x, y, wide, high]: [i64; 4]) -> Result<Region, Failure> {
    let [width, height] = camera.pixels;
    let range = |from: i64, count: i64, whole: usize| {
        let (from, count) = (usize::try_from(from).ok()?, usize::try_from(count).ok()?);
        let to = from.checked_add(count).filter(|to| count > 0 && *to <= whole)?;
        Some(from..to)
    };
    match (range(x, wide, width), range(y, high, height)) {
        (Some(columns), Some(rows)) => Ok(Region { columns, rows: height - rows.end..height - rows.start }),
        _ => {
            let message =
                format!("the image of {width} x {height} pixels has no part of {wide} x {high} at {x} {y}");
            Err(Failure::usage(message).help(format!(
                "X counts from the left and Y from the bottom, both from 0; W and H are at least 1, X + W at most \
                 {width}, and Y + H at most {height}"
            )))
        }
    }
}

fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    let (width, height) = match text.split_once('x') {
        Some((width, height)) => (side(width), side(height).map(Some)),
        None => (side(text), Some(None)),
    };
    width
        .zip(height)
        .map(|(width, height)| Size { width, height })
        .ok_or_else(|| format!("give a width as `800`, or both as `800x600`, each from 1 to {MAX_SIDE}"))
}

fn crop(text: &str) -> Result<[i64; 4], String> {
    let numbers: Result<Vec<i64>, _> = text.split(',').map(str::parse).collect();
    let numbers = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    numbers.ok_or_else(|| "give the part as `X,Y,W,H`, whole numbers".to_owned())
}
