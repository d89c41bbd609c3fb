//! Pixels drawn at random from strata: of an image's pixels, sorted by how much a few of their samples differ.
//!
//! All strata are drawn from alike. They are as large as the sum over their pixels of the differences and of the mean
//! difference: half of the draws go where samples differ, and half are spread over the image.

use super::places::{Drawing, mixed};
use super::right::{self, Right, SCRAMBLES};
use std::collections::BTreeSet;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::render::tiles::{self, TILE};

/// The number of strata.
const STRATA: usize = 32;

/// The number of samples of each of two images by which pixels are sorted, and the seeds of these, which no other image
/// has.
const SAMPLES: u32 = 2;
const SEEDS: [u32; 2] = [SCRAMBLES[0] ^ 0x68e3_1da4, SCRAMBLES[1] ^ 0x1b56_c4e9];

/// The weight of the squared difference of neighbours beside that of a pixel's own samples: an edge may lie between these.
const NEIGHBOURS: f64 = 0.125;

/// The least square of a difference that counts, where 1 is white.
const LEAST: f64 = 1e-6;

/// The pixels of an image in strata.
pub struct Strata {
    /// The pixels in the order in which they are drawn.
    strata: Vec<Vec<[usize; 2]>>,
    /// The number of pixels of the image in each stratum.
    pub(super) sizes: Vec<f64>,
}

/// Pixels that have been drawn.
pub struct Drawn<'s> {
    pub(super) strata: &'s Strata,
    /// The pixels, by column and row.
    pub pixels: Vec<[usize; 2]>,
    /// The stratum of each pixel.
    pub(super) of: Vec<usize>,
    /// The number of pixels that are drawn of each stratum, if it has as many.
    of_each: usize,
}

impl Strata {
    /// Sorts the pixels of a plan's image by some of their samples. Of an image with more pixels than `looked_at`, tiles are
    /// drawn at random. The pixels of `alone` are a stratum of their own. Those of `doubtful` may show what few samples meet,
    /// and are drawn as often as all that differ.
    pub fn new(
        plan: &mut Plan,
        threads: &Renderer,
        looked_at: usize,
        [alone, doubtful]: [&[[usize; 2]]; 2],
    ) -> Self {
        let size = plan.camera.pixels;
        let sides = size.map(|side| side.div_ceil(TILE));
        let drawing = Drawing::new(sides);
        let count = looked_at.div_ceil(TILE * TILE).min(sides[0] * sides[1]);
        let tile = |index: usize| {
            let [left, low] = drawing.at(index).map(|side| side * TILE);
            let mut pixels = Vec::new();
            tiles::list(left..size[0].min(left + TILE), low..size[1].min(low + TILE), &mut pixels);
            pixels
        };
        let tiles: Vec<_> = (0..count).map(tile).collect();
        let pairs = right::pairs(threads, plan, &tiles.concat(), (SAMPLES, SEEDS));
        let (mut rest, mut sorted) = (&pairs[..], Vec::new());
        for pixels in &tiles {
            let (own, others) = rest.split_at(pixels.len());
            sorted.extend(differences(pixels, own));
            rest = others;
        }
        let [alone_set, doubtful_set] =
            [alone, doubtful].map(|pixels| pixels.iter().collect::<BTreeSet<_>>());
        sorted.retain(|(_, pixel)| !alone_set.contains(pixel));
        let is_doubtful = |pixel: &[usize; 2]| doubtful_set.contains(pixel);
        let all: f64 = sorted.iter().map(|(difference, _)| LEAST + difference).sum();
        let each = all / sorted.iter().filter(|(_, pixel)| is_doubtful(pixel)).count().max(1) as f64;
        let of_doubtful = sorted.iter_mut().filter(|(_, pixel)| is_doubtful(pixel));
        of_doubtful.for_each(|(difference, _)| *difference += each);
        sorted.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        let all: f64 = sorted.iter().map(|(difference, _)| difference).sum();
        let mean = LEAST + all / sorted.len().max(1) as f64;
        let each = (all + mean * sorted.len() as f64) / STRATA as f64;
        let (mut strata, mut sum) = (vec![Vec::new(); STRATA], 0.0);
        for (difference, pixel) in &sorted {
            strata[((sum / each) as usize).min(STRATA - 1)].push(*pixel);
            sum += difference + mean;
        }
        strata.iter_mut().for_each(|pixels| pixels.sort_by_key(|pixel| mixed(*pixel)));
        // Of a large image, each pixel that was looked at stands for several.
        let scale = (size[0] * size[1] - alone.len()) as f64 / sorted.len().max(1) as f64;
        let mut sizes: Vec<_> = strata.iter().map(|pixels| scale * pixels.len() as f64).collect();
        sizes.push(alone.len() as f64);
        strata.push(alone.to_vec());
        Self { strata, sizes }
    }

    /// Returns the number of pixels that may be drawn.
    pub fn count(&self) -> usize {
        self.strata.iter().map(Vec::len).sum()
    }

    /// Begins with the pixels that are a stratum of their own.
    pub fn drawn(&self) -> Drawn<'_> {
        let alone = &self.strata[STRATA];
        Drawn { strata: self, pixels: alone.clone(), of: vec![STRATA; alone.len()], of_each: 0 }
    }
}

impl Drawn<'_> {
    /// Draws pixels until there are at least this many, or all. The strata take turns.
    pub fn draw(&mut self, count: usize) {
        let strata = &self.strata.strata[..STRATA];
        while self.pixels.len() < count.min(self.strata.count()) {
            let one = strata.iter().map(|pixels| pixels.get(self.of_each)).enumerate();
            for (index, pixel) in one.filter_map(|(index, pixel)| Some((index, *pixel?))) {
                self.pixels.push(pixel);
                self.of.push(index);
            }
            self.of_each += 1;
        }
    }
}

/// Returns the pixels of a tile, each with the mean square of the differences of its samples, and of those from its
/// neighbours.
fn differences<'p>(
    pixels: &'p [[usize; 2]],
    pairs: &'p [Right],
) -> impl Iterator<Item = (f64, [usize; 2])> + use<'p> {
    let mut means = [[None; TILE]; TILE];
    for ([x, y], [one, other]) in pixels.iter().zip(pairs) {
        means[y % TILE][x % TILE] = Some(0.5 * (*one + *other));
    }
    pixels.iter().zip(pairs).map(move |(pixel, [one, other])| {
        let [x, y] = pixel.map(|side| side % TILE);
        let around = [[x.wrapping_sub(1), y], [x + 1, y], [x, y.wrapping_sub(1)], [x, y + 1]];
        let mean = 0.5 * (*one + *other);
        let beside = around.iter().filter_map(|[x, y]| *means.get(*y)?.get(*x)?);
        let most = beside.map(|other| (other - mean).length_squared()).fold(0.0, f64::max);
        ((*one - *other).length_squared() + NEIGHBOURS * most, *pixel)
    })
}
