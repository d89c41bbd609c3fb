//! Flawed pixels of an image: those cut off at the ray budget, those whose first hit is undecided, and those that
//! lack light from beyond the longest path.

use crate::observer::{Count, RayKind, TraceObserver};
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

/// The numbers of pixels with a camera ray whose first hit could not be decided, by the index of the object that it
/// may hit, and by the reason. Where a pixel has several, the first counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Undecided(pub BTreeMap<(usize, Doubt), u64>);

impl Flaws {
    /// Adds the flaws of another part of the image.
    pub fn add(&mut self, other: &Self) {
        self.cuts.add(other.cuts);
        self.far = FarPaths { rays: self.far.rays + other.far.rays, of: self.far.of + other.far.of };
        for (of, pixels) in &other.undecided.0 {
            *self.undecided.0.entry(of.clone()).or_default() += pixels;
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
        self.0.values().sum()
    }
}

impl TraceObserver for Flaws {
    const SEES: bool = false;

    // Most counts compile to nothing.
    #[inline(always)]
    fn count(&mut self, count: Count) {
        match count {
            Count::Rays(RayKind::Primary, count) => self.far.of += count as u64,
            Count::Far(count) => self.far.rays += count as u64,
            Count::Cut(most) => self.cuts.add(BudgetCuts { pixels: 1, most }),
            Count::Undecided(object, doubt) => *self.undecided.0.entry((object, doubt)).or_default() += 1,
            _ => {}
        }
    }
}
