//! Objects so small in the image that they may fall between samples.

use crate::tiles::TILE;
use glam::{DVec2, DVec3};
use std::ops::RangeInclusive;
use tabray_exact::scalar::per_axis;
use tabray_world::camera::Projected;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::scene::model::Object;
use tabray_world::sensor::Sensor;

/// The width or height in pixels below which the first samples of pixels may miss an object: its bounds then contain
/// no whole neighbourhood of a pixel.
const SMALL: f64 = 2.0;

/// The minimum number of samples of a pixel into which the bounds of a small object reach.
pub(crate) const FEATURE_SAMPLES: u32 = 64;

/// The small objects of an image, by the squares of pixels on which their bounds are projected.
pub(crate) struct Features {
    /// The number of squares across and down.
    squares: [usize; 2],
    /// For each square, from the lower left one in rows, the index of its first entry in `small`; and the end.
    starts: Vec<u32>,
    small: Vec<SmallObject>,
    /// The number of small objects, each counted once. `None` where the camera cannot project them: then any pixel
    /// may see one.
    count: Option<usize>,
}

/// The projected bounds of a small object.
#[derive(Clone)]
struct SmallObject {
    /// The columns and rows of the pixels that it covers.
    columns: RangeInclusive<u32>,
    rows: RangeInclusive<u32>,
    /// The distance from the viewer to its bounds in world units.
    distance: f64,
}

impl Features {
    /// Projects the bounds of objects.
    pub fn new(camera: &Sensor, objects: &[Object]) -> Self {
        let squares = camera.pixels.map(|side| side.div_ceil(TILE));
        let is_unknown = camera.project(camera.origins().middle) == Projected::Unknown;
        let small = objects.iter().filter_map(|object| SmallObject::of(camera, &object.shape.bounds()?));
        let mut each: Vec<(u32, SmallObject)> = Vec::new();
        let mut count = 0;
        for small in small {
            count += 1;
            let squares_of = |pixels: &RangeInclusive<u32>| {
                *pixels.start() as usize / TILE..=*pixels.end() as usize / TILE
            };
            for row in squares_of(&small.rows) {
                for column in squares_of(&small.columns) {
                    each.push(((row * squares[0] + column) as u32, small.clone()));
                }
            }
        }
        each.sort_by_key(|(square, _)| *square);
        let last = (squares[0] * squares[1]) as u32;
        let start = |square| each.partition_point(|(other, _)| *other < square) as u32;
        let starts = (0..=last).map(start).collect();
        Self {
            squares,
            starts,
            small: each.into_iter().map(|(_, small)| small).collect(),
            count: (!is_unknown).then_some(count),
        }
    }

    /// Tells whether the bounds of a small object reach into a pixel, given by column and row, and are nearer than a
    /// distance in world units.
    pub fn any_at(&self, [column, row]: [usize; 2], distance: f64) -> bool {
        if self.count.is_none() {
            return true;
        }
        let square = row / TILE * self.squares[0] + column / TILE;
        let [from, to] = [self.starts[square], self.starts[square + 1]];
        let (column, row) = (column as u32, row as u32);
        self.small[from as usize..to as usize].iter().any(|small| {
            small.distance < distance && small.columns.contains(&column) && small.rows.contains(&row)
        })
    }

    /// Returns the number of small objects; `None` where the camera cannot project them.
    pub fn count(&self) -> Option<usize> {
        self.count
    }
}

impl SmallObject {
    /// Projects bounds; `None` where they are not small, or not in the image.
    fn of(camera: &Sensor, bounds: &Aabb) -> Option<Self> {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in 0..8 {
            let part = |axis: usize| {
                if corner >> axis & 1 == 0 { bounds.low[axis] } else { bounds.high[axis] }
            };
            let Projected::At(place) = camera.project(DVec3::from_array(per_axis(part))) else { return None };
            (low, high) = (low.min(place), high.max(place));
        }
        // Written so that NaN does not count as small.
        let is_small = (high - low).min_element() < SMALL && (high - low).is_finite();
        let pixels = |axis: usize| {
            let last = camera.pixels[axis] as f64 - 1.0;
            let (from, to) = ((low[axis] - 0.5).ceil(), (high[axis] + 0.5).floor());
            let is_seen = from <= last && to >= 0.0;
            is_seen.then(|| from.max(0.0) as u32..=to.min(last) as u32)
        };
        let (columns, rows) = (pixels(0).filter(|_| is_small)?, pixels(1)?);
        Some(Self { columns, rows, distance: camera.origins().distance(bounds) })
    }
}
