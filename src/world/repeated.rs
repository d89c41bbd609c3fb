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
        let size = self.size().map(f64::from);
        let (corner, part) = ((place - 0.5).floor(), (place - 0.5) - (place - 0.5).floor());
        let wrapped = |at: f64, axis: usize| at.rem_euclid(size[axis].max(1.0)) as u32;
        let texel = |right: f64, up: f64| texel(wrapped(corner.x + right, 0), wrapped(corner.y + up, 1));
        let row = |up: f64| texel(0.0, up).lerp(texel(1.0, up), part.x);
        row(0.0).lerp(row(1.0), part.y)
    }

    /// Encloses the blends of the four texels around the places in a box, which are given as in
    /// [`blended`](Self::blended). `texel` returns the texel of any column and row. `None` if the box covers many
    /// texels.
    pub fn enclose_blended<N: Number>(
        &self,
        place: [N; 2],
        texel: impl Fn(DVec2) -> DVec3,
    ) -> Option<[N; 3]> {
        let place = place.map(|along| along - N::constant(0.5));
        let [columns, rows] = place.map(N::floors);
        let texel = |x: f64, y: f64| constants::<N>(texel(DVec2::new(x, y)));
        if columns[0] == columns[1] && rows[0] == rows[1] {
            let (x, y) = (columns[0], rows[0]);
            let part = |along: N, from: f64| along - N::constant(from);
            let blend = |one: [N; 3], other: [N; 3], part: N| {
                per_axis(|channel| one[channel] + part * (other[channel] - one[channel]))
            };
            let row = |y: f64| blend(texel(x, y), texel(x + 1.0, y), part(place[0], x));
            return Some(blend(row(y), row(y + 1.0), part(place[1], y)));
        }
        // Blends lie between the texels around.
        let are_few = |[low, high]: [f64; 2]| high - low < MAX_TEXELS as f64;
        let all = |[low, high]: [f64; 2]| (0..=(high - low) as u32 + 1).map(move |at| low + f64::from(at));
        let around = (are_few(columns) && are_few(rows)).then(|| all(rows))?;
        around.flat_map(|y| all(columns).map(move |x| [x, y])).map(|[x, y]| texel(x, y)).reduce(hull)
    }

    /// Encloses the means of [`mean_repeated`](Self::mean_repeated) over rectangles whose corners are enclosed;
    /// `None` where a rectangle may be empty. Where the corners are nearly known, the mean is known up to the light
    /// of the texels near the edges.
    pub fn enclose_mean_repeated<N: Number>(&self, corners: [[N; 2]; 2]) -> Option<[N; 3]> {
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
        let mean = self.mean_repeated(middle(low), middle(high));
        Some(per_axis(|channel| {
            let Interval { low, high } =
                Interval::point(mean[channel]) + Interval { low: -error, high: error };
            N::any(low, high)
        }))
    }

    /// Returns the mean light of a rectangle, given by its lower left and its upper right corner in texels. The image
    /// repeats beyond its edges.
    pub fn mean_repeated(&self, low: DVec2, high: DVec2) -> Rgb {
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
