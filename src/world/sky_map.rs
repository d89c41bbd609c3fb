//! The brightness of a background around the scene.

use crate::background::EnclosedBackground;
use crate::number::Number;
use crate::parallel;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// The largest number of columns, and of rows, of a [`SkyMap`].
const MAX_CELLS: [u32; 2] = [1024, 512];

/// The largest number of cells along each side of a texel. If colours are interpolated between the middles of texels,
/// the brightest part of a lone bright texel is 16 times as bright as the corner to which its light reaches. With one
/// cell for all of it, the light would differ as much from the density by which directions are chosen.
const FINEST: usize = 4;

/// The minimum number of rows of a map that are filled on all threads.
const MANY: usize = 64;

/// The brightness of a background around the scene: cells of an equirectangular map, whose middle lies toward -z and
/// whose upper edge is straight up.
pub struct SkyMap {
    columns: usize,
    rows: usize,
    /// For each row, the fraction of all light that comes from this row and the rows below it.
    rows_up_to: Vec<f64>,
    /// For each row and each of its cells, the fraction of the row's light that comes from the cells up to this one.
    cells_up_to: Vec<f64>,
}

impl SkyMap {
    /// Makes the map of a background; `None` if it has no detail, or is black.
    pub(super) fn of(background: &dyn EnclosedBackground) -> Option<Self> {
        let [width, height] = background.detail()?;
        if width == 0 || height == 0 {
            return None;
        }
        let most = MAX_CELLS.map(|most| most as usize);
        let size = [width as usize, height as usize];
        let mut fine = FINEST;
        while fine > 1 && (fine * size[0] > most[0] || fine * size[1] > most[1]) {
            fine /= 2;
        }
        let [width, height] = size.map(|texels| fine * texels);
        let [columns, rows] = [width.min(most[0]), height.min(most[1])];
        let light = |y: usize| -> Vec<f32> {
            let up = (y as f64 + 0.5) / height as f64;
            let place = |x: usize| DVec2::new((x as f64 + 0.5) / width as f64, up);
            (0..width)
                .map(|x| background.colour_toward(direction(place(x))).max_element().max(0.0) as f32)
                .collect()
        };
        let looks = parallel::map_ranges(height, MANY, &|range| range.map(light).collect());
        // The mean of colours that are interpolated between the middles of texels. Over a part of a texel on one side
        // of its middle, the colour of the middle is taken for it. Over a whole texel, the texels around contribute.
        let mean = |x: usize, y: usize| {
            let at = |x: usize, y: usize| f64::from(looks[y][x % width]);
            if fine > 1 {
                return at(x, y);
            }
            let along = |y: usize| 0.75 * at(x, y) + 0.125 * (at(x + width - 1, y) + at(x + 1, y));
            0.75 * along(y) + 0.125 * (along(y.saturating_sub(1)) + along((y + 1).min(height - 1)))
        };
        let cells = |row: usize| {
            let mut sums = vec![0.0; columns];
            for y in row * height / rows..(row + 1) * height / rows {
                (0..width).for_each(|x| sums[x * columns / width] += mean(x, y));
            }
            sums
        };
        let lit = parallel::map_ranges(rows, MANY, &|range| range.map(cells).collect());
        let (mut rows_up_to, mut cells_up_to) =
            (Vec::with_capacity(rows), Vec::with_capacity(rows * columns));
        let mut all = 0.0;
        for (row, mut cells) in lit.into_iter().enumerate() {
            let sum: f64 = cells.iter().sum();
            let mut before = 0.0;
            for cell in &mut cells {
                before += *cell;
                *cell = if sum > 0.0 { before / sum } else { 1.0 };
            }
            cells_up_to.append(&mut cells);
            all += sum * band(row, rows);
            rows_up_to.push(all);
        }
        if all.is_nan() || all <= 0.0 {
            return None;
        }
        rows_up_to.iter_mut().for_each(|up_to| *up_to /= all);
        Some(Self { columns, rows, rows_up_to, cells_up_to })
    }

    fn cells(&self, row: usize) -> &[f64] {
        &self.cells_up_to[row * self.columns..][..self.columns]
    }

    /// Chooses a direction by two numbers from 0 to 1.
    pub fn direction(&self, numbers: DVec2) -> DVec3 {
        let (row, up) = chosen(&self.rows_up_to, numbers.y);
        let (column, along) = chosen(self.cells(row), numbers.x);
        // Equal solid angles are equal differences of the sine.
        let [low, high] = [row, row + 1].map(|row| sine(row, self.rows));
        let height = (low + up * (high - low)).clamp(-1.0, 1.0);
        let around = 2.0 * PI * ((column as f64 + along) / self.columns as f64 - 0.5);
        let (sin, cos) = libm::sincos(around);
        let flat = (1.0 - height * height).sqrt();
        DVec3::new(flat * sin, height, -flat * cos).normalize()
    }

    /// Returns the density of the directions that are chosen, per unit of solid angle, or bounds of it at the unit vectors in
    /// a box.
    pub(super) fn density<N: Number>(&self, toward: [N; 3]) -> N {
        let [around, up] = equirectangular(toward);
        let cells = |part: N, count: usize| {
            let place = part * N::constant(count as f64);
            let bounds = place.plain().map_or_else(|| place.bounds(), |place| [place; 2]);
            bounds.map(|place| (place as usize).min(count - 1))
        };
        let [[low, high], [left, right]] = [cells(up, self.rows), cells(around, self.columns)];
        if low == high && left == right {
            return N::constant(self.density_in(low, left));
        }
        let cells = (low..=high).flat_map(|row| (left..=right).map(move |column| [row, column]));
        let (least, most) = cells
            .map(|[row, column]| self.density_in(row, column))
            .fold((f64::INFINITY, 0.0), |(least, most), density| (density.min(least), density.max(most)));
        N::any(least, most)
    }

    /// Returns the density in a cell.
    fn density_in(&self, row: usize, column: usize) -> f64 {
        let part =
            |up_to: &[f64], index: usize| up_to[index] - if index == 0 { 0.0 } else { up_to[index - 1] };
        let solid_angle = 2.0 * PI / self.columns as f64 * band(row, self.rows);
        part(&self.rows_up_to, row) * part(self.cells(row), column) / solid_angle
    }
}

/// Returns the sine of the elevation at the lower edge of a row.
fn sine(row: usize, rows: usize) -> f64 {
    libm::sin(PI * (row as f64 / rows as f64 - 0.5))
}

/// Returns the height of a row of a unit sphere.
fn band(row: usize, rows: usize) -> f64 {
    sine(row + 1, rows) - sine(row, rows)
}

/// Returns the place of a direction in an equirectangular map whose middle lies toward -z, in its width from the left and
/// its height from below, or bounds of the places of the unit vectors in a box.
#[inline]
pub fn equirectangular<N: Number>([x, y, z]: [N; 3]) -> [N; 2] {
    let (half, pi) = (N::constant(0.5), N::pi());
    [half + x.atan2(-z) / (N::constant(2.0) * pi), half + y.asin() / pi]
}

/// Returns the direction at a place of an equirectangular map, in its width from the left and its height from below.
fn direction(place: DVec2) -> DVec3 {
    let (sin, cos) = libm::sincos(2.0 * PI * (place.x - 0.5));
    let (height, flat) = libm::sincos(PI * (place.y - 0.5));
    DVec3::new(flat * sin, height, -flat * cos)
}

/// Returns the index that a number from 0 to 1 chooses in a list of ascending numbers up to 1, and how far the number
/// is past the entry before, as a fraction of the difference.
fn chosen(up_to: &[f64], number: f64) -> (usize, f64) {
    let index = up_to.partition_point(|end| *end <= number).min(up_to.len() - 1);
    let before = if index == 0 { 0.0 } else { up_to[index - 1] };
    let part = up_to[index] - before;
    (index, if part > 0.0 { ((number - before) / part).clamp(0.0, 1.0) } else { 0.5 })
}
