//! Sums over the texels of an image, for means over rectangles of any size.
//!
//! Source: F. Crow, "Summed-area tables for texture mapping" (SIGGRAPH 1984).

use crate::material::Rgb;
use crate::texels::Texels;
use glam::DVec2;

/// The least width and height, in texels, of a rectangle whose mean is taken. The mean of a narrower one would be lost
/// in rounding.
const THINNEST: f64 = 1.0 / 64.0;

/// For each corner between texels, the sum of all texels to the left and below.
#[derive(Debug)]
pub(super) struct Sums {
    size: [u32; 2],
    sums: Vec<Rgb>,
    /// The light of the brightest channel.
    brightest: f64,
}

impl Sums {
    pub fn of(texels: &Texels) -> Self {
        let size = texels.size();
        let wide = size[0] as usize + 1;
        let mut sums = vec![Rgb::ZERO; wide * (size[1] as usize + 1)];
        for row in 0..size[1] {
            let (mut sum, start) = (Rgb::ZERO, (row as usize + 1) * wide);
            for column in 0..size[0] {
                sum += texels.light(column, row);
                let at = start + column as usize + 1;
                sums[at] = sums[at - wide] + sum;
            }
        }
        Self { size, sums, brightest: texels.brightest() }
    }

    /// Returns the mean over a rectangle within the image, given by its corners in texels.
    pub fn mean(&self, low: DVec2, high: DVec2) -> Rgb {
        let size = DVec2::from(self.size.map(f64::from));
        let high = high.max(low + THINNEST).min(size);
        let low = low.min(high - THINNEST);
        let corner = |x: f64, y: f64| self.up_to(x, y);
        let sum =
            corner(high.x, high.y) - corner(low.x, high.y) - corner(high.x, low.y) + corner(low.x, low.y);
        (sum / (high - low).element_product()).clamp(Rgb::ZERO, Rgb::splat(self.brightest))
    }

    /// Returns the sum over all texels, and parts of texels, to the left of a point and below it.
    fn up_to(&self, x: f64, y: f64) -> Rgb {
        let [column, row] = [x, y].map(|along| along.floor());
        let (right, above) = (x - column, y - row);
        let at = |column: f64, row: f64| {
            let column = (column as usize).min(self.size[0] as usize);
            let row = (row as usize).min(self.size[1] as usize);
            self.sums[row * (self.size[0] as usize + 1) + column]
        };
        let along = |row: f64| at(column, row).lerp(at(column + 1.0, row), right);
        along(row).lerp(along(row + 1.0), above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::Sensor;
    use image::RgbImage;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn means_of_sums_are_those_of_texels(
            x in 0.0..19.0_f64, y in 0.0..9.0_f64, width in 0.02..20.0_f64, height in 0.02..10.0_f64,
        ) {
            let image = RgbImage::from_fn(20, 10, |x, y| image::Rgb([(37 * x + 91 * y) as u8, (x * y) as u8, 255]));
            let texels = Texels::of_bytes(image, None, &Sensor::default().display());
            let (low, size) = (DVec2::new(x, y), DVec2::new(20.0, 10.0));
            let high = (low + DVec2::new(width, height)).min(size);
            let (one, other) = (Sums::of(&texels).mean(low, high), texels.mean_of_few(low, high));
            prop_assert!((one - other).abs().max_element() < 1e-9, "{one} {other}");
        }
    }
}
