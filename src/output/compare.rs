//! How two pictures differ, in numbers.

use crate::words;
use image::RgbImage;
use std::fmt;

/// How a picture differs from another of the same size. Differences are in levels of a channel, from 0 to 255.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What counts as the same: pixels of which no channel differs by more.
    pub tolerance: u8,
    /// How many pixels differ.
    pub differing: usize,
    /// The largest difference of any channel, within the tolerance or not.
    pub largest: u8,
    /// The root of the mean of all channels' squared differences.
    pub rms: f64,
    /// The first pixel that differs, row by row from the top, each from the left.
    pub first: Option<Pixel>,
}

/// One pixel in both pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// Its column, from 0 at the left.
    pub x: u32,
    /// Its row, from 0 at the bottom.
    pub y: u32,
    /// Its bytes in the old picture.
    pub old: [u8; 3],
    /// Its bytes in the new one.
    pub new: [u8; 3],
}

impl Comparison {
    /// Compares two pictures; nothing where their sizes differ.
    pub fn new(old: &RgbImage, new: &RgbImage, tolerance: u8) -> Option<Self> {
        if old.dimensions() != new.dimensions() {
            return None;
        }
        let (mut differing, mut largest, mut squares, mut first) = (0, 0, 0, None);
        for ((x, from_top, a), b) in old.enumerate_pixels().zip(new.pixels()) {
            let apart = [0, 1, 2].map(|channel| a[channel].abs_diff(b[channel]));
            let most = apart.into_iter().max().unwrap_or(0);
            largest = largest.max(most);
            squares += apart.map(|levels| u64::from(levels).pow(2)).iter().sum::<u64>();
            if most > tolerance {
                differing += 1;
                first.get_or_insert(Pixel { x, y: old.height() - 1 - from_top, old: a.0, new: b.0 });
            }
        }
        let channels = 3.0 * f64::from(old.width()) * f64::from(old.height());
        let rms = (squares as f64 / channels).sqrt();
        Some(Self { size: old.dimensions().into(), tolerance, differing, largest, rms, first })
    }

    /// How many pixels there are.
    pub fn pixels(&self) -> usize {
        self.size.iter().map(|side| *side as usize).product()
    }
}

/// A sentence for people, without a line end.
impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let pixels = words::count(self.pixels(), "pixel");
        let beyond = match self.tolerance {
            0 => String::new(),
            tolerance => format!(" by more than {}", words::count(tolerance.into(), "level")),
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
            let largest = words::count(self.largest.into(), "level");
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
