//! Flawed pixels of an image: those cut off at the ray budget, those whose first hit is undecided, and those that
//! lack light from beyond the longest path; and the noise of those that take several samples.

use crate::observer::{Count, RayKind, TraceObserver};
use glam::DVec3;
use std::collections::BTreeMap;
use tabray_world::certify::Doubt;

/// Counts the flawed pixels of an image. As an observer, it counts nothing else.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flaws {
    /// The pixels that have used up their ray budget.
    pub cuts: BudgetCuts,
    /// The pixels whose first hit could not be decided.
    pub undecided: Undecided,
    /// The rays from the viewer that lack light because the notes' rules end long paths.
    pub far: FarPaths,
    /// The noise of pixels that take several samples.
    pub noise: Noise,
}

/// The pixels that have used up their ray budget.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BudgetCuts {
    /// The number of pixels that have used up their ray budget.
    pub pixels: u64,
    /// A bound on the light that any of these pixels lacks, in any channel; infinite where nothing bounds it.
    pub most: f64,
}

/// The rays from the viewer whose paths are too long under the notes' rules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FarPaths {
    /// The number of rays with a path in mirrors or through glass that is too long.
    pub rays: u64,
    /// The number of all rays from the viewer.
    pub of: u64,
}

/// The pixels with a camera ray whose first hit could not be decided, by the index of the object that it
/// may hit, and by the reason. Where a pixel has several, the first counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Undecided(pub BTreeMap<(usize, Doubt), UndecidedPixels>);

/// Pixels whose first hit could not be decided for one reason.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UndecidedPixels {
    /// Their number.
    pub count: u64,
    /// Where one of their rays may hit the object, in world coordinates: the point with the least x, and of those with the
    /// same the one with the least y.
    pub at: DVec3,
}

/// The estimated noise of pixels that take several samples, one in eight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// The number of pixels.
    pixels: u64,
    /// The sum of their mean square errors in units of [`SQUARE`]: an integer, so the order of the sum makes no difference.
    sum: u64,
}

/// The unit of the sum of mean square errors, where 1 is white.
const SQUARE: f64 = 1e-12;

impl Noise {
    fn add(&mut self, Self { pixels, sum }: Self) {
        self.pixels += pixels;
        self.sum = self.sum.saturating_add(sum);
    }

    /// Returns the root mean square error of the pixels as they are shown, where 1 is white; `None` where it is not known.
    pub fn rms(&self) -> Option<f64> {
        (self.pixels != 0).then(|| (SQUARE * self.sum as f64 / self.pixels as f64).sqrt())
    }
}

impl Flaws {
    /// Adds the flaws of another part of the image.
    pub fn add(&mut self, other: &Self) {
        self.cuts.add(other.cuts);
        self.noise.add(other.noise);
        self.far = FarPaths { rays: self.far.rays + other.far.rays, of: self.far.of + other.far.of };
        for (of, pixels) in &other.undecided.0 {
            self.undecided.add(of.clone(), *pixels);
        }
    }
}

impl BudgetCuts {
    fn add(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.most = self.most.max(other.most);
    }
}

impl Undecided {
    /// Returns the number of pixels.
    pub fn pixels(&self) -> u64 {
        self.0.values().map(|pixels| pixels.count).sum()
    }

    fn add(&mut self, of: (usize, Doubt), UndecidedPixels { count, at }: UndecidedPixels) {
        let known = self.0.entry(of).or_insert(UndecidedPixels { count: 0, at });
        known.count += count;
        let order_of = |one: f64, other: f64| one.total_cmp(&other);
        let order =
            order_of(at.x, known.at.x).then(order_of(at.y, known.at.y)).then(order_of(at.z, known.at.z));
        if order.is_lt() {
            known.at = at;
        }
    }
}

impl TraceObserver for Flaws {
    // Most counts compile to nothing.
    #[inline(always)]
    fn count(&mut self, count: Count) {
        match count {
            Count::Rays(RayKind::Primary, count) => self.far.of += count as u64,
            Count::Far(count) => self.far.rays += count as u64,
            Count::Noise(square) => self.noise.add(Noise { pixels: 1, sum: (square / SQUARE) as u64 }),
            Count::Cut(most) => self.cuts.add(BudgetCuts { pixels: 1, most }),
            Count::Undecided(object, doubt, at) => {
                self.undecided.add((object, doubt), UndecidedPixels { count: 1, at });
            }
            _ => {}
        }
    }
}
