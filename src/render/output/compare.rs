//! The difference of two images, in numbers.

use image::{Rgb32FImage, RgbImage};
use std::fmt;
use tabray_exact::scalar::per_axis;
use tabray_world::text;

/// The difference of two images of the same size. Differences are in levels of a channel, from 0 to 255.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The width and the height in pixels.
    pub size: [u32; 2],
    /// The tolerance in levels: pixels count as equal if no channel differs by more.
    pub tolerance: u8,
    /// The number of pixels that differ by more than the tolerance.
    pub differing: usize,
    /// The largest difference of any channel, within the tolerance or not.
    pub largest: u8,
    /// The root mean square of the differences of all channels.
    pub rms: f64,
    /// The first pixel that differs by more than the tolerance, row by row from the top, each row from the left.
    pub first: Option<Pixel>,
    /// The pixel with the largest difference of a channel, if it differs by more than the tolerance: among several such
    /// pixels, the one whose channels together differ most, and among equal ones the first.
    pub worst: Option<Pixel>,
}

/// The difference of two images of the same size, at least one of them with numbers of full range. Differences are in
/// levels. There are 255 levels from black to white, and further levels beyond.
#[derive(Clone, Debug, PartialEq)]
pub struct FullRangeComparison {
    /// The number of pixels.
    pub pixels: usize,
    /// The tolerance in levels.
    pub tolerance: u8,
    /// The number of pixels that differ by more than the tolerance.
    pub differing: usize,
    /// The largest difference of any channel; infinite where one number is NaN or infinite and the other number is
    /// different.
    pub largest: f64,
    /// The root mean square of the differences of all channels.
    pub rms: f64,
}

impl FullRangeComparison {
    /// Compares two images; returns `None` if their sizes differ.
    pub fn new(old: &Rgb32FImage, new: &Rgb32FImage, tolerance: u8) -> Option<Self> {
        if old.dimensions() != new.dimensions() {
            return None;
        }
        let (mut differing, mut largest, mut squares) = (0, 0.0_f64, 0.0);
        for (a, b) in old.pixels().zip(new.pixels()) {
            let apart = |channel: usize| {
                let (a, b) = (f64::from(a[channel]), f64::from(b[channel]));
                let levels = 255.0 * (a - b).abs();
                let is_same = a == b || a.is_nan() && b.is_nan();
                if is_same {
                    0.0
                } else if levels.is_nan() {
                    f64::INFINITY
                } else {
                    levels
                }
            };
            let apart = per_axis(apart);
            let max = apart.into_iter().fold(0.0, f64::max);
            largest = largest.max(max);
            squares += apart.map(|levels| levels * levels).iter().sum::<f64>();
            differing += usize::from(max > f64::from(tolerance));
        }
        let pixels = old.width() as usize * old.height() as usize;
        let rms = (squares / (3.0 * pixels as f64)).sqrt();
        Some(Self { pixels, tolerance, differing, largest, rms })
    }
}

/// Writes a sentence for people, without a line end.
impl fmt::Display for FullRangeComparison {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let &Self { pixels, tolerance, differing, largest, rms } = self;
        let beyond = match tolerance {
            0 => String::new(),
            tolerance => format!(" by more than {}", text::count(tolerance.into(), "level")),
        };
        let verb = if differing == 1 { "differs" } else { "differ" };
        let percent = 100.0 * differing as f64 / pixels as f64;
        let pixels = text::count(pixels, "pixel");
        match differing {
            0 => write!(f, "none of {pixels} differs{beyond}")?,
            _ => write!(f, "{differing} of {pixels} {verb}{beyond} ({percent:.4} %)")?,
        }
        if largest > 0.0 {
            write!(f, "; largest difference {largest:.4} levels, RMS {rms:.4}")?;
        }
        Ok(())
    }
}

/// A pixel that differs, in both images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// The column, from 0 at the left.
    pub x: u32,
    /// The row, from 0 at the bottom.
    pub y: u32,
    /// The bytes in the old image.
    pub old: [u8; 3],
    /// The bytes in the new image.
    pub new: [u8; 3],
}

impl Comparison {
    /// Compares two images; returns `None` if their sizes differ.
    pub fn new(old: &RgbImage, new: &RgbImage, tolerance: u8) -> Option<Self> {
        if old.dimensions() != new.dimensions() {
            return None;
        }
        let (mut differing, mut largest, mut squares, mut first) = (0, 0, 0, None);
        let mut worst: Option<(u8, u16, Pixel)> = None;
        for ((x, from_top, a), b) in old.enumerate_pixels().zip(new.pixels()) {
            let apart = per_axis(|channel| a[channel].abs_diff(b[channel]));
            let max = apart.into_iter().max().unwrap_or(0);
            largest = largest.max(max);
            squares += apart.map(|levels| u64::from(levels).pow(2)).iter().sum::<u64>();
            if max > tolerance {
                differing += 1;
                let pixel = Pixel { x, y: old.height() - 1 - from_top, old: a.0, new: b.0 };
                first.get_or_insert(pixel);
                let sum = apart.map(u16::from).iter().sum();
                if worst.is_none_or(|(most, all, _)| (most, all) < (max, sum)) {
                    worst = Some((max, sum, pixel));
                }
            }
        }
        let channels = 3.0 * f64::from(old.width()) * f64::from(old.height());
        let rms = (squares as f64 / channels).sqrt();
        Some(Self {
            size: old.dimensions().into(),
            tolerance,
            differing,
            largest,
            rms,
            first,
            worst: worst.map(|(.., pixel)| pixel),
        })
    }

    /// Returns the number of pixels.
    pub fn pixels(&self) -> usize {
        self.size.iter().map(|side| *side as usize).product()
    }
}

/// Writes a sentence for people, without a line end.
impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let pixels = text::count(self.pixels(), "pixel");
        let beyond = match self.tolerance {
            0 => String::new(),
            tolerance => format!(" by more than {}", text::count(tolerance.into(), "level")),
        };
        match self.differing {
            0 => write!(f, "none of {pixels} differs{beyond}")?,
            differing => {
                let verb = if differing == 1 { "differs" } else { "differ" };
                let percent = 100.0 * differing as f64 / self.pixels() as f64;
                write!(f, "{differing} of {pixels} {verb}{beyond} ({percent:.4} %)")?;
            }
        }
        if self.largest > 0 {
            let largest = text::count(self.largest.into(), "level");
            write!(f, "; largest difference {largest}, RMS {:.4}", self.rms)?;
        }
        Ok(())
    }
}

impl fmt::Display for Pixel {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let bytes = |[r, g, b]: [u8; 3]| format!("({r}, {g}, {b})");
        let (old, new) = (bytes(self.old), bytes(self.new));
        write!(f, "{} from the left and {} from the bottom: {old} became {new}", self.x, self.y)
    }
}
