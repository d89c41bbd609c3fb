//! Points of an image.

use glam::DVec2;
use tabray_exact::scalar::Scalar;

/// A point of an image, in any number type: its distances from the left and from the bottom.
#[derive(Clone, Copy, Debug)]
pub struct ImagePoint<N = f64> {
    /// The distances in pixels from the centre of the lower left pixel, to the right and up.
    pub at: [N; 2],
    /// The image's width and height in pixels.
    pub pixels: [usize; 2],
}

impl<N: Scalar> ImagePoint<N> {
    /// Returns the point as fractions of the distances between the centres of the outermost pixels, like the notes. An
    /// image of a single pixel only has its middle.
    pub fn fraction(&self) -> [N; 2] {
        [0, 1].map(|side| match self.pixels[side] {
            1 => N::constant(0.5),
            pixels => self.at[side] / N::constant((pixels - 1) as f64),
        })
    }

    /// Returns the point in units of half the image's width, to the right and up from the image's middle. The left and
    /// the right edge of the image, half a pixel beyond the centres of the outermost pixels, are at -1 and 1.
    #[inline(always)]
    pub fn from_middle(&self) -> [N; 2] {
        // In the middle, this difference is 0 for intervals, too: many scenes are symmetric there.
        let off = |side: usize| self.at[side] - N::constant(0.5 * (self.pixels[side] - 1) as f64);
        let half = N::constant(0.5 * self.pixels[0] as f64);
        [off(0) / half, off(1) / half]
    }
}

impl ImagePoint {
    /// Returns the point in another number type.
    #[inline(always)]
    pub fn exactly<N: Scalar>(&self) -> ImagePoint<N> {
        ImagePoint { at: [N::constant(self.at[0]), N::constant(self.at[1])], pixels: self.pixels }
    }
}

/// Returns the point, in pixels from the centre of the lower left pixel, that [`ImagePoint::from_middle`] maps to this
/// one.
pub fn from_middle(place: DVec2, pixels: [usize; 2]) -> DVec2 {
    let [width, height] = pixels.map(|side| side as f64);
    0.5 * (place * width + DVec2::new(width - 1.0, height - 1.0))
}
