//! How much work a picture took: its rays by kind, and their tests by object.

use crate::render::observer::{Count, RayKind, TraceObserver};
use crate::scene::model::Model;
use serde::Serialize;
use std::collections::BTreeMap;

/// Counts of rays and tests. It is a watcher that leaves packets together, and so counts what plain rendering does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayStats {
    rays: [u64; RayKind::ALL.len()],
    /// By the objects' indices.
    tests: Vec<TestCounts>,
    /// The pixels that have cost as many rays as they may.
    pub cuts: Cuts,
}

/// Pixels that have cost as many rays as they may. It is a watcher, too, which counts nothing else.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cuts {
    /// How many they are.
    pub pixels: u64,
    /// How much light one of them lacks at most, in any channel; infinite where nothing bounds it.
    pub most: f64,
}

impl Cuts {
    /// Adds those of another part of the picture.
    pub fn add(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.most = self.most.max(other.most);
    }
}

impl TraceObserver for Cuts {
    const SEES: bool = false;

    fn count(&mut self, count: Count) {
        if let Count::Cut(most) = count {
            self.add(Self { pixels: 1, most });
        }
    }
}

/// What became of the tests of an object, or of all objects of an entity type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct TestCounts {
    /// How many rays were not tested, as the object's bounds are not in their way.
    ///
    /// What a tree passes over is neither tested nor culled, and no more are rays that leave the object or were blocked
    /// by another one before.
    pub culled: u64,
    /// How many objects there are.
    pub objects: u64,
    /// How many rays were tested.
    pub tested: u64,
}

impl TraceObserver for RayStats {
    const SEES: bool = false;

    fn count(&mut self, count: Count) {
        match count {
            Count::Rays(kind, rays) => self.rays[kind as usize] += rays as u64,
            Count::Tested(object, rays) => self.of(object).tested += rays as u64,
            Count::Culled(object, rays) => self.of(object).culled += rays as u64,
            Count::Cut(_) => self.cuts.count(count),
        }
    }
}

impl RayStats {
    fn of(&mut self, object: usize) -> &mut TestCounts {
        if self.tests.len() <= object {
            self.tests.resize(object + 1, TestCounts { objects: 1, tested: 0, culled: 0 });
        }
        &mut self.tests[object]
    }

    /// Adds the counts of another part of the picture.
    pub fn add(&mut self, other: &Self) {
        for (sum, part) in self.rays.iter_mut().zip(other.rays) {
            *sum += part;
        }
        self.cuts.add(other.cuts);
        for (object, part) in other.tests.iter().enumerate() {
            let sum = self.of(object);
            (sum.tested, sum.culled) = (sum.tested + part.tested, sum.culled + part.culled);
        }
    }

    /// How many rays of a kind were cast.
    pub fn rays(&self, kind: RayKind) -> u64 {
        self.rays[kind as usize]
    }

    /// How many rays were cast.
    pub fn all_rays(&self) -> u64 {
        self.rays.iter().sum()
    }

    /// What became of the tests of a model's objects, by the names of their entity types.
    pub fn tests(&self, model: &Model) -> BTreeMap<&'static str, TestCounts> {
        let mut tests: BTreeMap<_, TestCounts> = BTreeMap::new();
        for (index, object) in model.objects.iter().enumerate() {
            let part = self.tests.get(index).copied().unwrap_or_default();
            let sum = tests.entry(object.args.entity.name).or_default();
            sum.objects += 1;
            sum.tested += part.tested;
            sum.culled += part.culled;
        }
        tests
    }
}
