//! The brightness of an image, as its bytes have it.

/// What is known of the bytes of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Levels {
    /// The greatest byte.
    pub brightest: u8,
    /// The number of white pixels.
    pub white: usize,
    /// The number of all pixels.
    pub pixels: usize,
}

impl Levels {
    /// Adds pixels: red, green and blue of each.
    pub fn add(&mut self, bytes: &[u8]) {
        self.brightest = bytes.iter().copied().fold(self.brightest, u8::max);
        let (pixels, _) = bytes.as_chunks::<3>();
        self.white +=
            pixels.iter().map(|[red, green, blue]| usize::from(red & green & blue == u8::MAX)).sum::<usize>();
        self.pixels += pixels.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_full_in_all_channels() {
        let mut levels = Levels::default();
        levels.add(&[255, 255, 255, 255, 255, 254, 0, 0, 0]);
        levels.add(&[255; 6]);
        assert_eq!(levels, Levels { brightest: 255, white: 3, pixels: 5 });
        let mut dark = Levels::default();
        dark.add(&[7, 0, 3]);
        assert_eq!(dark, Levels { brightest: 7, white: 0, pixels: 1 });
    }
}
