//! The brightness of an image's bytes.

/// Counts of an image's bytes and pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Levels {
    /// The greatest byte.
    pub brightest: u8,
    /// The number of white pixels.
    pub white: usize,
    /// The number of pixels in runs of 16 in which no byte reaches [`DARK`].
    pub dark: usize,
    /// The number of all pixels.
    pub pixels: usize,
}

/// The number of pixels that are looked at together.
const RUN: usize = 16;

/// The least byte that is not almost black.
pub const DARK: u8 = 8;

impl Levels {
    /// Adds pixels: red, green, blue and alpha of each. What is transparent is black.
    pub fn add_with_alpha(&mut self, bytes: &[u8]) {
        let (pixels, _) = bytes.as_chunks::<4>();
        let colours = pixels.iter().map(|[red, green, blue, _]| [*red, *green, *blue]);
        self.add(colours.collect::<Vec<_>>().as_flattened());
    }

    /// Adds pixels: red, green and blue of each.
    pub fn add(&mut self, bytes: &[u8]) {
        for bytes in bytes.chunks(3 * RUN) {
            let brightest = bytes.iter().copied().fold(0, u8::max);
            self.brightest = self.brightest.max(brightest);
            let (pixels, _) = bytes.as_chunks::<3>();
            self.pixels += pixels.len();
            self.dark += if brightest < DARK { pixels.len() } else { 0 };
            // Few pixels are white, and counting them takes many times as long as finding out that there are none.
            if brightest == u8::MAX {
                self.white +=
                    pixels.iter().filter(|[red, green, blue]| red & green & blue == u8::MAX).count();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_full_in_all_channels() {
        let mut levels = Levels::default();
        levels.add(&[255, 255, 255, 255, 255, 254, 0, 0, 0]);
        levels.add_with_alpha(&[255; 8]);
        assert_eq!(levels, Levels { brightest: 255, white: 3, dark: 0, pixels: 5 });
        let mut dark = Levels::default();
        dark.add(&[7, 0, 3]);
        assert_eq!(dark, Levels { brightest: 7, white: 0, dark: 1, pixels: 1 });
    }
}
