//! The slabs of a profile. In each, its square is a parabola to within a proven error.

use super::budget::Budget;
use super::no_surface::NoSurface;
use super::ranges::Ranges;
use super::runs::Runs;
use super::slab::Slab;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;
use tabray_exact::formula::Formula;

/// The target error of slabs, in square world units. Between 1/100 and 1/10000, it does not affect the time per ray. A
/// smaller error costs memory and time.
const ERROR: f64 = 1e-3;

/// The maximum number of halvings of a range for that target. Where the profile is not smooth, as at a kink, the error
/// stays larger.
const HALVINGS: u32 = 12;

/// Upper bounds of the error, regardless of the number of halvings: as a fraction of the slab's largest square, which
/// gives thin parts their own slabs, and as a fraction of the surface's largest square, below which the error does not
/// matter.
const COARSE: f64 = 1.0 / 16.0;
const COARSEST: f64 = 1.0 / 1_048_576.0;

/// A bound of the profile where rounding hides its sign, as a fraction of the largest radius.
const HIDDEN: f64 = 1.0 / 4_294_967_296.0;

/// The slabs of a profile, from the bottom up.
pub struct Slabs {
    slabs: Vec<Slab>,
    runs: Runs,
    /// The index of the lowest slab in each of equal parts of the height.
    table: Vec<u32>,
    parts_per_unit: f64,
    widest: f64,
    reach: f64,
    coarsest: f64,
    is_smooth: bool,
}

impl Slabs {
    /// Cuts a profile into slabs for heights from 0 to `height`. `square` is the square of the profile.
    pub fn new(profile: &Formula, square: &Formula, height: f64) -> Result<Self, NoSurface> {
        let mut budget = Budget::new();
        let ranges = Ranges::new(profile, height, &mut budget)?;
        let mut slabs = cut(square, height, &ranges.list, &mut budget)?;
        let is_void = |&&(_, _, is_void): &&(f64, f64, bool)| is_void;
        slabs.extend(ranges.list.iter().filter(is_void).map(|(from, to, _)| Slab::void(*from, *to)));
        slabs.sort_by(|a, b| a.from.total_cmp(&b.from));
        if slabs.iter().all(|slab| slab.max_square == 0.0) {
            return Err(NoSurface::Nowhere);
        }
        let parts = 256.max(2 * slabs.len());
        let parts_per_unit = parts as f64 / height;
        let slab_at = |y: f64| slabs.partition_point(|slab: &Slab| slab.to <= y).min(slabs.len() - 1) as u32;
        let table = (0..=parts).map(|part| slab_at(part as f64 / parts_per_unit)).collect();
        let max_square = slabs.iter().map(|slab| slab.max_square).fold(0.0, f64::max);
        let shell = slabs.iter().map(|slab| slab.max_square + 2.0 * slab.error).fold(0.0, f64::max);
        if ranges.hidden > HIDDEN * max_square.sqrt() {
            return Err(NoSurface::Rounding { near: ranges.hidden_at, hidden: ranges.hidden });
        }
        let is_smooth = slabs.iter().all(|slab| slab.slope_error.is_finite());
        Ok(Self {
            is_smooth,
            runs: Runs::new(&slabs),
            table,
            parts_per_unit,
            widest: max_square.sqrt().next_up(),
            reach: 1.001 * shell,
            coarsest: slabs.iter().map(|slab| slab.error).fold(0.0, f64::max),
            slabs,
        })
    }

    /// Returns the surface's maximum distance from the axis, in world units.
    #[inline(always)]
    pub fn widest(&self) -> f64 {
        self.widest
    }

    /// Returns the square of a distance from the axis beyond which a ray is outside of all parabolas and their errors.
    #[inline(always)]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Returns the maximum error of a slab, in square world units.
    #[inline(always)]
    pub fn coarsest(&self) -> f64 {
        self.coarsest
    }

    /// Returns whether the profile's slope is bounded everywhere, and so the profile does not jump.
    #[inline(always)]
    pub fn is_smooth(&self) -> bool {
        self.is_smooth
    }

    /// Returns whether each slab reaches the target error, and so few rays need a search.
    pub fn is_tight(&self) -> bool {
        self.is_smooth && self.coarsest <= ERROR
    }

    /// Returns the slab at an index, counted from the bottom.
    #[inline(always)]
    pub fn get(&self, index: usize) -> &Slab {
        &self.slabs[index]
    }

    /// Returns the number of slabs.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.slabs.len()
    }

    /// Returns a range of heights that consists of these slabs. It extends to infinity at the surface's ends, so that
    /// rounding cuts nothing off.
    #[inline(always)]
    pub fn extended(&self, slab: &Slab, slabs: Range<usize>) -> Slab {
        Slab {
            from: if slabs.start == 0 { f64::NEG_INFINITY } else { slab.from },
            to: if slabs.end == self.count() { f64::INFINITY } else { slab.to },
            ..*slab
        }
    }

    /// Returns the number of slabs that can be skipped, from `index` upward or downward: they lie in a range, and no
    /// ray hits them according to `may_meet`. Returns 0 if no run of slabs can be skipped.
    #[inline(always)]
    pub fn skipped(
        &self,
        index: usize,
        is_upward: bool,
        within: Range<usize>,
        mut may_meet: impl FnMut(&Slab) -> bool,
    ) -> usize {
        let runs = self.runs.starting(index, is_upward, within);
        runs.take_while(|(slabs, run)| !may_meet(&self.extended(run, slabs.clone())))
            .map(|(slabs, _)| slabs.len())
            .last()
            .unwrap_or(0)
    }

    /// Returns the index of the slab at a height.
    #[inline(always)]
    pub fn index(&self, y: f64) -> usize {
        // The cast converts negative numbers and NaN to 0.
        let part = (y * self.parts_per_unit) as usize;
        let mut index = self.table[part.min(self.table.len() - 1)] as usize;
        while index + 1 < self.slabs.len() && y > self.slabs[index].to {
            index += 1;
        }
        while index > 0 && y < self.slabs[index].from {
            index -= 1;
        }
        index
    }
}

/// A slab and the number of halvings of its range, ordered by the slab's error.
struct HalvedSlab {
    slab: Slab,
    halvings: u32,
}

impl PartialEq for HalvedSlab {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for HalvedSlab {}

impl PartialOrd for HalvedSlab {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for HalvedSlab {
    fn cmp(&self, other: &Self) -> Ordering {
        self.slab.error.total_cmp(&other.slab.error)
    }
}

/// Cuts the ranges of heights where the profile is not negative into slabs: first until thin parts have their own
/// slabs, then where the error is largest.
fn cut(
    square: &Formula,
    height: f64,
    ranges: &[(f64, f64, bool)],
    budget: &mut Budget,
) -> Result<Vec<Slab>, NoSurface> {
    const SAMPLES: u32 = 64;
    let samples = (0..=SAMPLES).map(|part| square.at(height * f64::from(part) / f64::from(SAMPLES)));
    let widest = samples.filter(|square| square.is_finite()).fold(0.0, f64::max);
    let mut waiting: Vec<(f64, f64, u32)> =
        ranges.iter().rev().filter(|range| !range.2).map(|(from, to, _)| (*from, *to, 0)).collect();
    let (mut slabs, mut coarse) = (Vec::new(), BinaryHeap::new());
    while let Some((from, to, halvings)) = waiting.pop() {
        let Some(slab) = Slab::fit(square, from, to, budget) else {
            return Err(NoSurface::Bends { from });
        };
        let Slab { middle, error, max_square, .. } = slab;
        let is_finite = error.is_finite() && max_square.is_finite();
        let is_stuck = middle <= from || middle >= to;
        // Where the slope is unbounded, as at a jump, halving does not reduce the error.
        let is_steep = !slab.slope_error.is_finite() && halvings >= HALVINGS;
        let enough = ERROR.max(COARSE * max_square).max(COARSEST * widest);
        if is_stuck && !is_finite {
            return Err(NoSurface::Unbounded { near: middle });
        } else if !is_finite || !is_stuck && !is_steep && error > enough {
            waiting.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
        } else if error > ERROR && halvings < HALVINGS && !is_stuck {
            coarse.push(HalvedSlab { slab, halvings });
        } else {
            slabs.push(slab);
        }
    }
    while let Some(HalvedSlab { slab, halvings }) = coarse.pop() {
        let (one, other) = (
            Slab::fit(square, slab.from, slab.middle, budget),
            Slab::fit(square, slab.middle, slab.to, budget),
        );
        // An unrefined slab only costs time for the rays that reach it.
        let (Some(one), Some(other)) = (one, other) else {
            slabs.push(slab);
            break;
        };
        for half in [one, other] {
            let is_stuck = half.middle <= half.from || half.middle >= half.to;
            if half.error > ERROR && halvings + 1 < HALVINGS && !is_stuck {
                coarse.push(HalvedSlab { slab: half, halvings: halvings + 1 });
            } else {
                slabs.push(half);
            }
        }
    }
    slabs.extend(coarse.into_iter().map(|part| part.slab));
    Ok(slabs)
}
