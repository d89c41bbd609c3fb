//! The pixels that are measured, spread evenly over an image.

use glam::DVec2;
use std::collections::BTreeSet;
use tabray_core::render::tiles::{self, TILE};

/// Pixels: columns from the left and rows from the bottom.
pub type Pixels = Vec<[usize; 2]>;

/// Returns `count` pixels of an image, or all pixels of a smaller image.
pub fn spread([width, height]: [usize; 2], count: usize) -> Pixels {
    let all = width * height;
    if count >= all {
        return (0..all).map(|index| [index % width, index / width]).collect();
    }
    (0..count).map(|index| place([width, height], index)).collect()
}

/// Returns one of the pixels that are spread over an image. Those of all indices below a number are spread evenly.
pub fn place([width, height]: [usize; 2], index: usize) -> [usize; 2] {
    let size = DVec2::new(width as f64, height as f64);
    (size * (STEP * index as f64).fract()).to_array().map(|side| side as usize)
}

/// The pixels of an image in a pseudorandom order, the same each time.
pub struct Drawing {
    size: [usize; 2],
    /// Half the number of bits of the least power of 4 that is at least the number of pixels.
    half: u32,
}

impl Drawing {
    /// Orders the pixels of an image of this size.
    pub fn new(size: [usize; 2]) -> Self {
        let bits = usize::BITS - (size[0] * size[1]).saturating_sub(1).leading_zeros();
        Self { size, half: bits.div_ceil(2).max(1) }
    }

    /// Returns the pixel of an index below the number of pixels.
    pub fn at(&self, index: usize) -> [usize; 2] {
        let mut index = self.mixed(index);
        // A place beyond the image is mixed again until it is a pixel. The result is still a permutation of the pixels.
        while index >= self.size[0] * self.size[1] {
            index = self.mixed(index);
        }
        [index % self.size[0], index / self.size[0]]
    }

    /// Permutes the numbers of 2 * `half` bits, by a Feistel network.
    fn mixed(&self, index: usize) -> usize {
        let mask = (1 << self.half) - 1;
        let (mut left, mut right) = (index as u64 >> self.half, index as u64 & mask);
        for round in 1..=ROUNDS {
            (left, right) = (right, left ^ hash(right + (round << 32)) & mask);
        }
        (left << self.half | right) as usize
    }
}

/// The rounds of a [`Drawing`].
const ROUNDS: u64 = 6;

/// Returns a number by which pixels are put in a pseudorandom order.
pub(super) fn mixed([x, y]: [usize; 2]) -> u64 {
    hash((x as u64) << 32 | y as u64)
}

/// Mixes the bits of a number: the finalizer of SplitMix64.
fn hash(number: u64) -> u64 {
    let mut hash = number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    hash = (hash ^ hash >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    hash = (hash ^ hash >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    hash ^ hash >> 31
}

/// The pixels of an image in the order in which they are drawn at random, without those that may show small things.
pub struct Draw {
    drawing: Drawing,
    all: usize,
    width: usize,
    without: BTreeSet<[usize; 2]>,
}

impl Draw {
    /// Draws from the pixels of an image of this size, without some.
    pub fn new([width, height]: [usize; 2], without: Pixels) -> Self {
        let without = without.into_iter().collect();
        Self { drawing: Drawing::new([width, height]), all: width * height, width, without }
    }

    /// Returns the number of all pixels.
    pub fn all(&self) -> usize {
        self.all
    }

    /// Returns the number of pixels that may be drawn.
    pub fn rest(&self) -> usize {
        self.all - self.without.len()
    }

    /// Returns the first `count` pixels, or all pixels in rows.
    pub fn first(&self, count: usize) -> Pixels {
        let is_drawn = |pixel: &[usize; 2]| !self.without.contains(pixel);
        if count >= self.rest() {
            return (0..self.all)
                .map(|index| [index % self.width, index / self.width])
                .filter(is_drawn)
                .collect();
        }
        (0..self.all).map(|index| self.drawing.at(index)).filter(is_drawn).take(count).collect()
    }
}

/// Returns the pixels of the `together` tiles around a pixel that are traced together, in the order in which they are
/// traced.
pub fn tiles_around([width, height]: [usize; 2], [x, y]: [usize; 2], together: usize) -> Pixels {
    let (left, low) = (x / (TILE * together) * TILE * together, y / TILE * TILE);
    let mut pixels = Vec::new();
    for left in (left..width.min(left + TILE * together)).step_by(TILE) {
        tiles::list(left..width.min(left + TILE), low..height.min(low + TILE), &mut pixels);
    }
    pixels
}

/// Returns the pixels of all tiles of an image, `together` tiles at a time.
pub fn all_tiles(size @ [width, height]: [usize; 2], together: usize) -> Vec<Pixels> {
    let corners = (0..height).step_by(TILE);
    let corners = corners.flat_map(|y| (0..width).step_by(TILE * together).map(move |x| [x, y]));
    corners.map(|corner| tiles_around(size, corner, together)).collect()
}

/// Returns `count` of the tiles of an image, each the pixels of one packet of rays, or all tiles of a smaller image.
pub fn tiles([width, height]: [usize; 2], count: usize) -> Vec<Pixels> {
    let tile = |corner: [usize; 2]| tiles_around([width, height], corner.map(|side| side * TILE), 1);
    spread([width, height].map(|side| side.div_ceil(TILE)), count).into_iter().map(tile).collect()
}

/// The step from each point to the next, as a fraction of the image's width and height: the R2 sequence (M. Roberts,
/// "The unreasonable effectiveness of quasirandom sequences", 2018).
const STEP: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_hold_every_pixel_of_a_small_picture_once() {
        let pixels: Pixels = tiles([19, 9], 100).concat();
        assert_eq!(pixels.len(), 19 * 9);
        assert_eq!(pixels.into_iter().collect::<BTreeSet<_>>().len(), 19 * 9);
    }

    #[test]
    fn a_drawing_has_every_pixel_once_in_no_order() {
        for size in [[1, 1], [19, 9], [64, 64], [100, 41]] {
            let drawing = Drawing::new(size);
            let all = size[0] * size[1];
            let drawn: Vec<_> = (0..all).map(|index| drawing.at(index)).collect();
            assert_eq!(drawn.iter().collect::<BTreeSet<_>>().len(), all);
            // Half of the neighbours in the drawing are in the same half of the image.
            let is_left = |[x, _]: &[usize; 2]| 2 * x < size[0];
            let same = drawn.windows(2).filter(|pair| is_left(&pair[0]) == is_left(&pair[1])).count();
            assert!(all < 100 || (4 * all / 10..6 * all / 10).contains(&same), "{same} of {all}");
        }
    }

    #[test]
    fn places_are_all_over_a_large_picture() {
        let quarters = |[x, y]: [usize; 2]| [x / 250, y / 250];
        let places: BTreeSet<_> = spread([1000, 1000], 40).into_iter().map(quarters).collect();
        assert_eq!(places.len(), 16);
    }
}
