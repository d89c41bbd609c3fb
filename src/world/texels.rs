//! The texels of an image, and the light that each of them stands for.

use crate::display::Display;
use crate::material::Rgb;
use glam::{DVec2, DVec3};
use image::{GrayImage, Rgb32FImage, RgbImage};
use std::borrow::Cow;

/// The texels of an image.
#[derive(Debug)]
pub struct Texels {
    pixels: Pixels,
    /// The light of each byte.
    light: [f64; 256],
    /// The opacity of each texel, where any is not opaque, if opacities are kept.
    alpha: Option<GrayImage>,
}

#[derive(Debug)]
enum Pixels {
    Bytes(RgbImage),
    /// Light in full range.
    Floats(Rgb32FImage),
}

impl Texels {
    /// Makes texels from bytes. An image would show their light with the same bytes.
    pub(super) fn of_bytes(image: RgbImage, alpha: Option<GrayImage>, display: &Display) -> Self {
        let light = std::array::from_fn(|byte| display.light_of(byte as u8));
        Self { pixels: Pixels::Bytes(image), light, alpha }
    }

    /// Makes texels of light. NaN and numbers below 0 become 0.
    pub(super) fn of_light(mut image: Rgb32FImage, alpha: Option<GrayImage>) -> Self {
        image
            .iter_mut()
            .for_each(|channel| *channel = if *channel > 0.0 { channel.min(f32::MAX) } else { 0.0 });
        Self { pixels: Pixels::Floats(image), light: [0.0; 256], alpha }
    }

    /// Returns the width and height; neither is 0.
    pub fn size(&self) -> [u32; 2] {
        match &self.pixels {
            Pixels::Bytes(image) => image.dimensions().into(),
            Pixels::Floats(image) => image.dimensions().into(),
        }
    }

    /// Returns the light of a texel by its column from the left and its row from the bottom. Beyond an edge, the texel
    /// at the edge counts.
    #[inline]
    pub fn light(&self, column: u32, row: u32) -> Rgb {
        self.texel(column, row, |byte| self.light[usize::from(byte)])
    }

    /// Returns a texel that does not stand for light, otherwise as [`light`](Self::light) does. Bytes become numbers
    /// from 0 to 1.
    pub fn numbers(&self, column: u32, row: u32) -> DVec3 {
        self.texel(column, row, |byte| f64::from(byte) / 255.0)
    }

    /// Returns the opacity of a texel, from 0 to 1, as [`light`](Self::light) does; 1 where opacities are not kept.
    pub fn alpha(&self, column: u32, row: u32) -> f64 {
        let (column, row) = self.place(column, row);
        self.alpha.as_ref().map_or(1.0, |alpha| f64::from(alpha.get_pixel(column, row).0[0]) / 255.0)
    }

    /// Tells whether any texel is not opaque, and opacities are kept.
    pub fn has_alpha(&self) -> bool {
        self.alpha.is_some()
    }

    /// Returns the column and the row from the top of a texel, or of that at the edge.
    #[inline]
    fn place(&self, column: u32, row: u32) -> (u32, u32) {
        let [width, height] = self.size();
        (column.min(width - 1), height - 1 - row.min(height - 1))
    }

    #[inline]
    fn texel(&self, column: u32, row: u32, of_byte: impl Fn(u8) -> f64) -> DVec3 {
        let (column, row) = self.place(column, row);
        DVec3::from_array(match &self.pixels {
            Pixels::Bytes(image) => image.get_pixel(column, row).0.map(of_byte),
            Pixels::Floats(image) => image.get_pixel(column, row).0.map(f64::from),
        })
    }

    /// Returns the mean light of a small rectangle, given by its corners in texels.
    pub(super) fn mean_of_few(&self, low: DVec2, high: DVec2) -> Rgb {
        let cells = |from: f64, to: f64| {
            let cells = from.floor() as u32..=(to.ceil() as u32).max(from.floor() as u32 + 1) - 1;
            // A range without width lies where it begins.
            let part = move |cell: u32| {
                let at = f64::from(cell);
                if to > from { (to.min(at + 1.0) - from.max(at)) / (to - from) } else { 1.0 }
            };
            cells.map(move |cell| (cell, part(cell)))
        };
        let (mut sum, mut most) = (Rgb::ZERO, Rgb::ZERO);
        for (row, height) in cells(low.y, high.y) {
            for (column, width) in cells(low.x, high.x) {
                let texel = self.light(column, row);
                sum += width * height * texel;
                most = most.max(texel);
            }
        }
        // One texel is its own mean, to the last bit, and no mean is brighter than all texels.
        let is_one = low.floor() == high.floor();
        if is_one { self.light(low.x as u32, low.y as u32) } else { sum.min(most) }
    }

    /// Bounds the light of a channel of any texel.
    pub fn brightest(&self) -> f64 {
        match &self.pixels {
            Pixels::Bytes(_) => 1.0,
            Pixels::Floats(image) => image.iter().fold(0.0, |most, channel| channel.max(most)).into(),
        }
    }

    /// Returns the numbers of all texels as bytes.
    pub fn raw(&self) -> Cow<'_, [u8]> {
        let mut numbers = match &self.pixels {
            Pixels::Bytes(image) => Cow::Borrowed(&image.as_raw()[..]),
            Pixels::Floats(image) => image.iter().flat_map(|channel| channel.to_le_bytes()).collect(),
        };
        if let Some(alpha) = &self.alpha {
            numbers.to_mut().extend(alpha.as_raw());
        }
        numbers
    }

    /// Returns the memory that they take, in bytes.
    pub(super) fn memory(&self) -> u64 {
        let pixels = match &self.pixels {
            Pixels::Bytes(image) => image.as_raw().len(),
            Pixels::Floats(image) => 4 * image.as_raw().len(),
        };
        (pixels + self.alpha.as_ref().map_or(0, |alpha| alpha.as_raw().len())) as u64
    }
}
