//! The pixels that are measured, spread evenly over an image.

use glam::DVec2;
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

/// Returns the pixels of a tile and of those beside it, of which so many are traced together, in the order in which they
/// are traced.
pub fn tiles_around([width, height]: [usize; 2], [x, y]: [usize; 2], together: usize) -> Pixels {
    let (left, low) = (x / (TILE * together) * TILE * together, y / TILE * TILE);
    let mut pixels = Vec::new();
    for left in (left..width.min(left + TILE * together)).step_by(TILE) {
        tiles::list(left..width.min(left + TILE), low..height.min(low + TILE), &mut pixels);
    }
    pixels
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
    use std::collections::BTreeSet;

    #[test]
    fn tiles_hold_every_pixel_of_a_small_picture_once() {
        let pixels: Pixels = tiles([19, 9], 100).concat();
        assert_eq!(pixels.len(), 19 * 9);
        assert_eq!(pixels.into_iter().collect::<BTreeSet<_>>().len(), 19 * 9);
    }

    #[test]
    fn places_are_all_over_a_large_picture() {
        let quarters = |[x, y]: [usize; 2]| [x / 250, y / 250];
        let places: BTreeSet<_> = spread([1000, 1000], 40).into_iter().map(quarters).collect();
        assert_eq!(places.len(), 16);
    }
}
