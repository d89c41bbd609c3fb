//! A picture beside the right image of its scene.

use glam::DVec3;
use image::RgbImage;
use rayon::prelude::*;
use tabray_core::render::Renderer;
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::world::display::Display;

/// A picture, beside the image that is right.
pub(super) struct Compared<'c> {
    pub plan: &'c Plan<'c>,
    pub display: Display,
    pub size: [usize; 2],
    pub theirs: &'c RgbImage,
    /// The right bytes and the index of the object that is seen, in rows from the top.
    right: Vec<([u8; 3], Option<usize>)>,
}

impl<'c> Compared<'c> {
    pub fn new(renderer: &Renderer, plan: &'c Plan<'c>, theirs: &'c RgbImage) -> Self {
        let (display, size) = (plan.camera.display(), plan.camera.pixels);
        let pixel = |index: usize| {
            let [x, y] = place(index, size);
            let sight = plan.camera.sight(x as f64, y as f64);
            (display.bytes(trace::pixel(plan, x, y)), trace::first_hit(plan, &sight).map(|hit| hit.index))
        };
        let right = renderer.run(|| (0..size[0] * size[1]).into_par_iter().map(pixel).collect());
        Self { plan, display, size, theirs, right }
    }

    /// Returns all pixels, in rows from the top: columns from the left and rows from the bottom.
    pub fn places(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let size = self.size;
        (0..size[0] * size[1]).map(move |index| place(index, size))
    }

    pub fn theirs(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        self.theirs.get_pixel(x as u32, (self.size[1] - 1 - y) as u32).0
    }

    pub fn right(&self, at: [usize; 2]) -> [u8; 3] {
        self.right[self.index(at)].0
    }

    pub fn object(&self, at: [usize; 2]) -> Option<usize> {
        self.right[self.index(at)].1
    }

    fn index(&self, [x, y]: [usize; 2]) -> usize {
        (self.size[1] - 1 - y) * self.size[0] + x
    }
}

pub(super) fn place(index: usize, [width, height]: [usize; 2]) -> [usize; 2] {
    [index % width, height - 1 - index / width]
}

/// Returns the largest difference of a channel, in levels.
pub(super) fn apart(one: [u8; 3], other: [u8; 3]) -> u8 {
    let [r, g, b] = [0, 1, 2].map(|channel| one[channel].abs_diff(other[channel]));
    r.max(g).max(b)
}

/// Returns the bytes of colours from 0 to 1.
pub(super) fn levels(shown: DVec3) -> [u8; 3] {
    shown.to_array().map(|channel| (255.0 * channel).round() as u8)
}
