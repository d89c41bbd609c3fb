//! Textures that repeat.

use crate::material::Rgb;
use crate::number::{MAX_TEXELS, Number, coarse, hull};
use crate::patch::MEAN_ROUNDING;
use crate::texture::Texture;
use glam::{DVec2, DVec3};
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, constants, per_axis};

impl Texture {
    /// Returns the blend of the four texels around a place, which is given in texels from the lower left corner.
    /// `texel` returns the colour, or another quantity, for a column and a row. The image repeats beyond its edges.
    pub fn blended(&self, place: DVec2, texel: impl Fn(u32, u32) -> DVec3) -> DVec3 {
        let [width, height] = self.size();
        let texel = |at: DVec2| texel(repeated(at.x, width), repeated(at.y, height));
        blended(place.to_array(), texel).map_or(DVec3::ZERO, DVec3::from)
    }

    /// Returns the mean light of a rectangle, given by its lower left and its upper right corner in texels, or bounds of
    /// the means; `None` where a rectangle may be empty. The image repeats beyond its edges.
    pub fn mean_repeated<N: Number>(&self, corners: [[N; 2]; 2]) -> Option<[N; 3]> {
        if let [[Some(left), Some(lower)], [Some(right), Some(upper)]] =
            corners.map(|corner| corner.map(N::plain))
        {
            return Some(constants(self.mean_between(DVec2::new(left, lower), DVec2::new(right, upper))));
        }
        // Where the corners are nearly known, the mean is known up to the light of the texels near the edges.
        let [low, high] = corners.map(|corner| corner.map(coarse));
        let mut around = Interval::constant(MEAN_ROUNDING);
        for axis in 0..2 {
            let width = high[axis] - low[axis];
            if width.low <= 0.0 || !width.is_bounded() {
                return None;
            }
            let doubt = Interval::point(low[axis].width()) + Interval::point(high[axis].width());
            around = around + Interval::constant(2.0) * doubt / width;
        }
        let error = (around * Interval::point(self.brightest())).high;
        let middle = |corner: [Interval; 2]| DVec2::from(corner.map(Interval::middle));
        let mean = self.mean_between(middle(low), middle(high));
        Some(per_axis(|channel| {
            let Interval { low, high } =
                Interval::point(mean[channel]) + Interval { low: -error, high: error };
            N::any(low, high)
        }))
    }

    /// Returns the mean light of a rectangle in plain numbers.
    pub fn mean_between(&self, low: DVec2, high: DVec2) -> Rgb {
        let size = DVec2::from(self.size().map(f64::from));
        // Two runs of texels in one repetition, and their parts of the whole: the part beyond the end begins again.
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

/// Returns the column of a texel among `count` columns that repeat, or the row among rows.
#[inline]
pub fn repeated(at: f64, count: u32) -> u32 {
    at.rem_euclid(f64::from(count).max(1.0)) as u32
}

/// Returns the blend of the four texels around a place, which is given in texels from the lower left corner, or bounds of
/// the blends around the places in a box. `texel` returns the colour, or another quantity, of any column and row. `None` if
/// the box covers many texels.
#[inline]
pub fn blended<N: Number>(place: [N; 2], texel: impl Fn(DVec2) -> DVec3) -> Option<[N; 3]> {
    let place = place.map(|along| along - N::constant(0.5));
    let [columns, rows] = place.map(N::floors);
    let texel = |x: f64, y: f64| constants::<N>(texel(DVec2::new(x, y)));
    if place[0].plain().is_some() || (columns[0] == columns[1] && rows[0] == rows[1]) {
        let (x, y) = (columns[0], rows[0]);
        let [right, up] = [place[0] - N::constant(x), place[1] - N::constant(y)];
        let row = |y: f64| N::lerp(texel(x, y), texel(x + 1.0, y), right);
        return Some(N::lerp(row(y), row(y + 1.0), up));
    }
    // Blends lie between the texels around.
    let are_few = |[low, high]: [f64; 2]| high - low < MAX_TEXELS as f64;
    let all = |[low, high]: [f64; 2]| (0..=(high - low) as u32 + 1).map(move |at| low + f64::from(at));
    let around = (are_few(columns) && are_few(rows)).then(|| all(rows))?;
    around.flat_map(|y| all(columns).map(move |x| [x, y])).map(|[x, y]| texel(x, y)).reduce(hull)
}
