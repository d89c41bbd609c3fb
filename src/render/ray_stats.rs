//! The work of an image: its rays by kind, and their tests by object.

use crate::flaws::Flaws;
use crate::observer::{Count, RayKind, TraceObserver};
use serde::Serialize;
use std::collections::BTreeMap;
use tabray_world::sample::Sampler;
use tabray_world::scene::model::Model;

/// Counts of rays and tests. As an observer, it does not see single events, so packets stay whole and the counts are
/// those of plain rendering.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayStats {
    rays: [u64; RayKind::ALL.len()],
    /// The counts of each object, by the object's index.
    tests: Vec<TestCounts>,
    /// The flawed pixels.
    pub flaws: Flaws,
    /// The pixels with proven bounds of their colours.
    pub proofs: Proofs,
    /// The numbers of pixels that took 1, 2, 4 ... samples, where pixels differ in that.
    sampled: [u64; SAMPLE_COUNTS],
}

/// The number of possible sample counts of a pixel: the powers of two up to [`Sampler::MAX_SAMPLES`].
const SAMPLE_COUNTS: usize = Sampler::MAX_SAMPLES.ilog2() as usize + 1;

/// The pixels with proven bounds of their colours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Proofs {
    /// The number of pixels that are within the limit for certain.
    pub certified: u64,
    /// The number of pixels that are not certified.
    pub open: u64,
    /// The greatest possible error of a pixel that is not certified, where 1 is white.
    pub most: f64,
    /// The sum of the possible errors of the pixels that are not certified, each rounded up, in units of which
    /// [`PARTS`] are white: an integer, so the order of the sum makes no difference.
    sum: u64,
    /// The number of footprints that were examined.
    pub footprints: u64,
}

/// The number of units in white, for sums of errors.
const PARTS: f64 = 1e9;

impl Proofs {
    /// Adds the proofs of another part of the image.
    pub fn add(&mut self, other: Self) {
        self.certified += other.certified;
        self.open += other.open;
        self.most = self.most.max(other.most);
        self.sum += other.sum;
        self.footprints += other.footprints;
    }

    /// Returns the number of pixels.
    pub fn pixels(&self) -> u64 {
        self.certified + self.open
    }

    /// Returns the mean possible error of the pixels that are not certified, where 1 is white.
    pub fn mean(&self) -> f64 {
        if self.open == 0 { 0.0 } else { self.sum as f64 / PARTS / self.open as f64 }
    }
}

/// The tests against one object, or against all objects of an entity type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct TestCounts {
    /// The number of rays that were not tested, because they miss the object's bounds.
    ///
    /// Objects that the BVH skips, rays that leave the object, and rays that another object has blocked before count
    /// neither as tested nor as culled.
    pub culled: u64,
    /// The number of objects.
    pub objects: u64,
    /// The number of rays that were tested.
    pub tested: u64,
}

impl TraceObserver for RayStats {
    fn count(&mut self, count: Count) {
        match &count {
            &Count::Rays(kind, rays) => self.rays[kind as usize] += rays as u64,
            &Count::Tested(object, rays) => self.of(object).tested += rays as u64,
            &Count::Culled(object, rays) => self.of(object).culled += rays as u64,
            &Count::Sampled(samples) => self.sampled[samples.ilog2() as usize] += 1,
            &Count::Bounded { error, is_certified, footprints } => {
                let pixels = u64::from(!is_certified);
                let most = if is_certified { 0.0 } else { error };
                let sum = (PARTS * most).ceil() as u64;
                let footprints = footprints.into();
                self.proofs.add(Proofs { certified: 1 - pixels, open: pixels, most, sum, footprints });
            }
            Count::Cut(_) | Count::Undecided(..) | Count::Far(_) | Count::Noise(_) => {}
        }
        self.flaws.count(count);
    }
}

impl RayStats {
    /// Returns the counts of the object of this index.
    fn of(&mut self, object: usize) -> &mut TestCounts {
        if self.tests.len() <= object {
            self.tests.resize(object + 1, TestCounts { objects: 1, tested: 0, culled: 0 });
        }
        &mut self.tests[object]
    }

    /// Adds the counts of another part of the image.
    pub fn add(&mut self, other: &Self) {
        for (sum, part) in self.rays.iter_mut().zip(other.rays) {
            *sum += part;
        }
        self.flaws.add(&other.flaws);
        self.proofs.add(other.proofs);
        for (sum, part) in self.sampled.iter_mut().zip(other.sampled) {
            *sum += part;
        }
        for (object, part) in other.tests.iter().enumerate() {
            let sum = self.of(object);
            (sum.tested, sum.culled) = (sum.tested + part.tested, sum.culled + part.culled);
        }
    }

    /// Returns the numbers of samples that pixels took, each with the number of these pixels; empty where all pixels
    /// take the same number.
    pub fn sampled(&self) -> impl Iterator<Item = (u32, u64)> {
        let each = self.sampled.into_iter().zip(0..).map(|(pixels, power)| (1 << power, pixels));
        each.filter(|(_, pixels)| *pixels > 0)
    }

    /// Returns the number of rays of a kind that were cast.
    pub fn rays(&self, kind: RayKind) -> u64 {
        self.rays[kind as usize]
    }

    /// Returns the number of rays that were cast.
    pub fn all_rays(&self) -> u64 {
        self.rays.iter().sum()
    }

    /// Sums the tests against a model's objects, by the names of their entity types.
    pub fn tests(&self, model: &Model) -> BTreeMap<&'static str, TestCounts> {
        let mut tests: BTreeMap<_, TestCounts> = BTreeMap::new();
        for (index, object) in model.objects.iter().enumerate() {
            let part = self.tests.get(index).copied().unwrap_or_default();
            let sum = tests.entry(object.args.entity().name).or_default();
            sum.objects += 1;
            sum.tested += part.tested;
            sum.culled += part.culled;
        }
        tests
    }
}
