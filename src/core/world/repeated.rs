//! Textures that repeat.

use crate::world::material::Rgb;
use crate::world::texture::Texture;
use glam::{DVec2, DVec3};

impl Texture {
    /// Returns the blend of the four texels around a place, which is given in texels from the lower left corner: of colours, or
    /// what else `texel` returns for a column and a row. The image goes on where it ends.
    pub fn blended(&self, place: DVec2, texel: impl Fn(u32, u32) -> DVec3) -> DVec3 {
        let size = self.size().map(f64::from);
        let (corner, part) = ((place - 0.5).floor(), (place - 0.5) - (place - 0.5).floor());
        let wrapped = |at: f64, axis: usize| at.rem_euclid(size[axis].max(1.0)) as u32;
        let texel = |right: f64, up: f64| texel(wrapped(corner.x + right, 0), wrapped(corner.y + up, 1));
        let row = |up: f64| texel(0.0, up).lerp(texel(1.0, up), part.x);
        row(0.0).lerp(row(1.0), part.y)
    }

    /// Returns the mean light of a rectangle, given by its lower left and its upper right corner in texels. The image goes on
    /// where it ends.
    pub fn mean_repeated(&self, low: DVec2, high: DVec2) -> Rgb {
        let size = DVec2::from(self.size().map(f64::from));
        // Two runs of texels in one repetition, and their parts of the whole: what reaches beyond the end begins again.
        let runs = |axis: usize| {
            let (size, width) = (size[axis], high[axis] - low[axis]);
            if width >= size {
                return [(0.0, size, 1.0), (0.0, 0.0, 0.0)];
            }
            let from = low[axis] - size * (low[axis] / size).floor();
            let over = (from + width - size).max(0.0);
            let part = if over > 0.0 { over / width } else { 0.0 };
            [(from, from + width - over, 1.0 - part), (0.0, over, part)]
        };
        let all = runs(0).into_iter().flat_map(|x| runs(1).map(|y| (x, y)));
        let (mut sum, mut most) = (Rgb::ZERO, Rgb::ZERO);
        for (x, y) in all.filter(|(x, y)| x.2 * y.2 > 0.0) {
            let mean = self.mean(DVec2::new(x.0, y.0), DVec2::new(x.1, y.1));
            (sum, most) = (sum + x.2 * y.2 * mean, most.max(mean));
        }
        sum.min(most)
    }
}
