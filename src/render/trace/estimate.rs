//! The estimate of a pixel's colour after some of its samples.

use glam::DVec3;
use std::ops::Range;
use tabray_world::display::Display;
use tabray_world::material::Rgb;
use tabray_world::simd::soa::View;

/// The number of blocks of samples whose means are compared.
const BLOCKS: usize = 8;

/// The number of blocks if lights are extended and a pixel's error is limited. If block means are normally
/// distributed, the mean of 8 is off by three of its estimated standard errors once in 50 times, and the mean of 32
/// once in 185. Each doubling of the samples is another chance to end by luck.
const MANY_BLOCKS: usize = 32;

/// The least fraction of an estimated error that is left when the number of samples doubles, where [`MANY_BLOCKS`] are
/// compared. The true error falls faster where samples are spread evenly over smooth light; more often, a faster fall
/// means that the blocks happen to be alike.
const LEFT: f64 = 0.5;

/// The fraction of the contrast around a pixel that may lie unseen between its samples; it is divided by their number.
/// The second number holds if all samples have hit the same surfaces on their paths.
const UNSEEN: f64 = 0.25;
const UNSEEN_WITHIN: f64 = 0.06;

/// The largest deviation, in estimated errors, that the error of a shown colour allows for. A colour farther beyond
/// white or black counts as clipped.
const FAR: f64 = 4.0;

/// The scratch space of pixels that take more samples where that is needed.
#[derive(Default)]
pub(super) struct AdaptiveScratch {
    /// The corners that are probed, by column and row.
    pub probes: Vec<[usize; 2]>,
    /// The results at each point of a grid of corners around the pixels and, where the camera has alpha, what is clear
    /// there.
    pub grids: [Vec<RaySummary>; 2],
    /// The pixels' estimates.
    pub estimates: Vec<Estimate>,
    /// The estimates of what is clear of the pixels, as colours; empty where the camera has no alpha.
    pub clear: Vec<Estimate>,
    /// The indices of the pixels that take more samples.
    pub active: Vec<u32>,
    /// The samples to be traced next.
    pub runs: Vec<SampleRun>,
}

impl AdaptiveScratch {
    /// Returns the number of samples of the first pixel, and the estimated error of its colour.
    pub fn first(&self, display: &Display) -> (u32, f64) {
        let clear = self.clear.first().map_or(0.0, |clear| clear.error(&Display::LINEAR, 1.0));
        let of = |estimate: &Estimate| (estimate.count, estimate.error(display, 1.0).max(clear));
        self.estimates.first().map_or((0, 0.0), of)
    }
}

/// Samples of a pixel that follow each other and are to be traced.
pub(super) struct SampleRun {
    /// The index of the pixel's estimate.
    pub of: u32,
    /// The pixel's column and row.
    pub pixel: [usize; 2],
    /// The indices of the samples.
    pub samples: Range<u32>,
    /// The lanes of their rays.
    pub lanes: Range<usize>,
    /// The number of rays that each sample may cost, if it is not the usual one.
    pub ray_budget: Option<u32>,
}

/// The results of single rays.
pub(super) struct RayResults<'f> {
    pub colours: View<'f>,
    /// A mark of the path of each ray, and the distance of its first hit in world units; empty where that is not
    /// recorded.
    pub marks: &'f [u64],
    pub distances: &'f [f64],
}

/// The results of rays, combined.
#[derive(Clone, Copy)]
pub(super) struct RaySummary {
    /// The least and the greatest colour.
    low: Rgb,
    high: Rgb,
    /// The mark of the first ray's path, and whether another ray's path has another mark.
    mark: u64,
    has_several_paths: bool,
    /// The distance of the farthest first hit, in world units.
    distance: f64,
}

impl Default for RaySummary {
    fn default() -> Self {
        Self {
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
            mark: 0,
            has_several_paths: false,
            distance: 0.0,
        }
    }
}

impl RaySummary {
    /// Returns the results of one ray.
    #[inline]
    pub fn of(found: &RayResults, lane: usize) -> Self {
        let colour = found.colours.get(lane);
        let (mark, distance) = (found.marks[lane], found.distances[lane]);
        Self { low: colour, high: colour, mark, has_several_paths: false, distance }
    }

    /// Includes the results of other rays.
    #[inline]
    pub fn include(&mut self, other: &Self) {
        (self.low, self.high) = (self.low.min(other.low), self.high.max(other.high));
        self.has_several_paths |= other.has_several_paths | (other.mark != self.mark);
        self.distance = self.distance.max(other.distance);
    }

    /// Includes the results of rays.
    #[inline]
    fn include_all(&mut self, found: &RayResults) {
        for lane in 0..found.colours.len() {
            let colour = found.colours.get(lane);
            (self.low, self.high) = (self.low.min(colour), self.high.max(colour));
        }
        for mark in found.marks {
            self.has_several_paths |= *mark != self.mark;
        }
        for distance in found.distances {
            self.distance = self.distance.max(*distance);
        }
    }
}

/// The estimate of a pixel's colour.
#[derive(Clone, Default)]
pub(super) struct Estimate {
    /// The number of samples.
    pub count: u32,
    /// The next number of samples of the pixel, a power of two.
    pub goal: u32,
    /// The sum of the samples' colours.
    sum: Rgb,
    /// The sums of the colours of equally long runs of samples, as many as there are samples but no more than
    /// `most_blocks`.
    blocks: [Rgb; MANY_BLOCKS],
    /// [`BLOCKS`] or [`MANY_BLOCKS`].
    most_blocks: usize,
    /// The lower limit of the estimated error.
    least_error: f64,
    /// The sum of the bounds on the light that the samples lack.
    pub missing: f64,
    /// The results of its samples and of the probes around it.
    summary: RaySummary,
}

impl Estimate {
    /// Starts with the results of the probes around the pixel, and with its first number of samples. `is_careful`
    /// tells that lights are extended and the error is limited. An estimate is too large to be made elsewhere and
    /// copied.
    #[inline]
    pub fn begin(&mut self, summary: RaySummary, goal: u32, is_careful: bool) {
        (self.count, self.goal) = (0, goal);
        self.most_blocks = if is_careful { MANY_BLOCKS } else { BLOCKS };
        self.blocks[..self.most_blocks].fill(Rgb::ZERO);
        (self.sum, self.missing, self.least_error) = (Rgb::ZERO, 0.0, 0.0);
        self.summary = summary;
    }

    /// Tells whether rays here or around hit different surfaces on their paths.
    pub fn has_several_paths(&self) -> bool {
        self.summary.has_several_paths
    }

    /// Returns the distance of the farthest first hit here or around, in world units.
    pub fn distance(&self) -> f64 {
        self.summary.distance
    }

    /// Adds the next samples, up to [`goal`](Self::goal).
    #[inline]
    pub fn add(&mut self, found: &RayResults) {
        self.summary.include_all(found);
        self.sum = found.colours.added_to(self.sum);
        // Each block has a power of two of them.
        let (shift, last) = (self.shift(self.goal), self.most_blocks - 1);
        for lane in 0..found.colours.len() {
            self.blocks[(self.count >> shift) as usize & last] += found.colours.get(lane);
            self.count += 1;
        }
    }

    /// Sets the next number of samples of the pixel, which is no less than before.
    #[inline]
    pub fn set_goal(&mut self, goal: u32) {
        // Pairs of blocks are joined, which makes room for as many samples again.
        for _ in self.shift(self.goal)..self.shift(goal) {
            let pairs = self.most_blocks / 2;
            for pair in 0..pairs {
                self.blocks[pair] = self.blocks[2 * pair] + self.blocks[2 * pair + 1];
            }
            self.blocks[pairs..self.most_blocks].fill(Rgb::ZERO);
        }
        self.goal = goal;
    }

    /// Returns the binary logarithm of the number of samples in each block, for a number of samples that is a power
    /// of 2.
    #[inline]
    fn shift(&self, samples: u32) -> u32 {
        samples.trailing_zeros().saturating_sub(self.most_blocks.trailing_zeros())
    }

    /// Returns the colour.
    #[inline]
    pub fn colour(&self) -> Rgb {
        self.sum / f64::from(self.count)
    }

    /// Returns the sums of the two halves of the samples.
    pub fn halves(&self) -> [Rgb; 2] {
        let blocks = (self.count as usize).min(self.most_blocks);
        let (one, other) = self.blocks[..blocks].split_at(blocks / 2);
        [one.iter().sum(), other.iter().sum()]
    }

    /// Estimates the error of the colour as it is shown, the largest of its channels, where 1 is white: the standard
    /// error of the mean, estimated from the means of its blocks, plus the error that the contrast around leaves open.
    /// `doubt` is the factor of the standard error.
    ///
    /// Sobol points are spread more evenly than independent ones, so differences of blocks tend to overstate the
    /// error.
    #[inline]
    fn error(&self, display: &Display, doubt: f64) -> f64 {
        let blocks = (self.count as usize).min(self.most_blocks);
        let (mean, long) = (self.colour(), f64::from(self.count) / blocks as f64);
        let squares: DVec3 = self.blocks[..blocks]
            .iter()
            .map(|sum| {
                let d = *sum / long - mean;
                d * d
            })
            .sum();
        let spread = match blocks {
            1 => DVec3::ZERO,
            _ => squares.map(f64::sqrt) / ((blocks * (blocks - 1)) as f64).sqrt(),
        };
        let unseen = if self.summary.has_several_paths { UNSEEN } else { UNSEEN_WITHIN };
        let error =
            doubt * spread + (self.summary.high - self.summary.low) * (unseen / f64::from(self.count));
        if let Some(gain) = display.truncates() {
            let (mean, error) = (gain * mean, gain * error);
            let is_below = mean.max_element() + FAR * error.max_element() <= 1.0;
            if is_below && (mean - FAR * error).min_element() >= 0.0 {
                return error.max_element();
            }
        }
        let shown = display.shown(mean);
        let off = |times: f64| {
            let [down, up] = display.shown_within([mean - times * error, mean + times * error]);
            (up - shown).max(shown - down).max_element() / times
        };
        off(1.0).max(off(FAR))
    }

    /// Estimates the error after the samples have doubled: if lights are extended and the error is limited, at least
    /// [`LEFT`] of the last estimate.
    #[inline]
    pub fn next_error(&mut self, display: &Display, doubt: f64) -> f64 {
        let error = self.error(display, doubt).max(self.least_error);
        if self.most_blocks == MANY_BLOCKS {
            self.least_error = LEFT * error;
        }
        error
    }
}
