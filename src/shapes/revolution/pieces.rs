//! A profile cut into slabs, in each of which its square is a parabola, but for a proven error.

use super::budget::Budget;
use super::no_surface::NoSurface;
use super::ranges::Ranges;
use crate::numeric::dual::Dual;
use crate::numeric::formula::Formula;
use crate::numeric::interval::Interval;
use crate::numeric::scalar::Scalar;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The error that slabs are cut for. From 1/100 to 1/10000 makes no difference to the time a ray takes; less costs
/// memory and more.
const ERROR: f64 = 1e-3;

/// How often a range is halved for that error at most. What is not smooth there, such as a kink, keeps a larger one.
const HALVINGS: u32 = 12;

/// What an error must be below as a part of a slab's largest square, however often it has to be halved for that, so
/// that thin parts get slabs of their own; and as a part of the whole surface's, below which that is no matter.
const COARSE: f64 = 1.0 / 16.0;
const COARSEST: f64 = 1.0 / 1_048_576.0;

/// Where rounding hides whether the profile is negative, it must be nearer to 0 than this part of the largest radius.
const HIDDEN: f64 = 1.0 / 4_294_967_296.0;

/// A range of heights.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    pub from: f64,
    pub to: f64,
    pub middle: f64,
    /// In it, the profile's square is `c0 + c1 v + c2 v^2`, `v` counted from the middle, within `error`; and its
    /// slope is that parabola's within `slope_error`.
    pub c0: f64,
    pub c1: f64,
    pub c2: f64,
    pub error: f64,
    pub slope_error: f64,
    /// The square is not greater than this.
    pub most: f64,
    /// The profile is negative there: there is nothing.
    pub is_void: bool,
}

impl Slab {
    /// The parabola at `v` from the middle.
    #[inline(always)]
    pub fn parabola(&self, v: f64) -> f64 {
        self.c0 + v * (self.c1 + v * self.c2)
    }
}

/// The slabs of a profile, from the bottom up.
pub struct Slabs {
    slabs: Vec<Slab>,
    /// The slab of each of so many equal parts of the height.
    table: Vec<u32>,
    parts_per_unit: f64,
    widest: f64,
    reach: f64,
    coarsest: f64,
    is_smooth: bool,
}

impl Slabs {
    /// Cuts a profile, whose square is given, too, into slabs from 0 to a height.
    pub fn new(profile: &Formula, square: &Formula, height: f64) -> Result<Self, NoSurface> {
        let mut budget = Budget::new();
        let ranges = Ranges::new(profile, height, &mut budget)?;
        let mut slabs = cut(square, height, &ranges.list, &mut budget)?;
        let is_void = |&&(_, _, is_void): &&(f64, f64, bool)| is_void;
        slabs.extend(ranges.list.iter().filter(is_void).map(|(from, to, _)| Slab::void(*from, *to)));
        slabs.sort_by(|a, b| a.from.total_cmp(&b.from));
        if slabs.iter().all(|slab| slab.most == 0.0) {
            return Err(NoSurface::Nowhere);
        }
        let parts = 256.max(2 * slabs.len());
        let parts_per_unit = parts as f64 / height;
        let slab_at = |y: f64| slabs.partition_point(|slab: &Slab| slab.to <= y).min(slabs.len() - 1) as u32;
        let table = (0..=parts).map(|part| slab_at(part as f64 / parts_per_unit)).collect();
        let most = slabs.iter().map(|slab| slab.most).fold(0.0, f64::max);
        let shell = slabs.iter().map(|slab| slab.most + 2.0 * slab.error).fold(0.0, f64::max);
        if ranges.hidden > HIDDEN * most.sqrt() {
            return Err(NoSurface::Rounding { near: ranges.hidden_at, hidden: ranges.hidden });
        }
        let is_smooth = slabs.iter().all(|slab| slab.slope_error.is_finite());
        Ok(Self {
            is_smooth,
            table,
            parts_per_unit,
            widest: most.sqrt().next_up(),
            reach: 1.001 * shell,
            coarsest: slabs.iter().map(|slab| slab.error).fold(0.0, f64::max),
            slabs,
        })
    }

    /// How far the surface is from the axis at most.
    #[inline(always)]
    pub fn widest(&self) -> f64 {
        self.widest
    }

    /// The square of a distance from the axis at which every ray is outside of the parabolas and of their errors.
    #[inline(always)]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The largest of the slabs' errors.
    #[inline(always)]
    pub fn coarsest(&self) -> f64 {
        self.coarsest
    }

    /// Whether the profile's slope is bounded everywhere, so that it does not jump.
    #[inline(always)]
    pub fn is_smooth(&self) -> bool {
        self.is_smooth
    }

    /// The slab of this index, from the bottom.
    #[inline(always)]
    pub fn get(&self, index: usize) -> &Slab {
        &self.slabs[index]
    }

    /// How many there are.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.slabs.len()
    }

    /// The index of the slab at a height.
    #[inline(always)]
    pub fn index(&self, y: f64) -> usize {
        // The cast takes what is below 0, and what is no number, to 0.
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

/// A slab, and how often its range was halved for it. They are compared by their errors.
struct Part {
    slab: Slab,
    halvings: u32,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.slab.error.total_cmp(&other.slab.error)
    }
}

/// Cuts ranges of heights into slabs, those where the profile is negative left out: first until every thin part has
/// slabs of its own, then where the error is largest.
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
        let Slab { middle, error, most, .. } = slab;
        let is_finite = error.is_finite() && most.is_finite();
        let is_stuck = middle <= from || middle >= to;
        // Where its slope has no bound, as where it jumps, halving does not make the error less.
        let is_steep = !slab.slope_error.is_finite() && halvings >= HALVINGS;
        let enough = ERROR.max(COARSE * most).max(COARSEST * widest);
        if is_stuck && !is_finite {
            return Err(NoSurface::Unbounded { near: middle });
        } else if !is_finite || !is_stuck && !is_steep && error > enough {
            waiting.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
        } else if error > ERROR && halvings < HALVINGS && !is_stuck {
            coarse.push(Part { slab, halvings });
        } else {
            slabs.push(slab);
        }
    }
    while let Some(Part { slab, halvings }) = coarse.pop() {
        let (one, other) = (
            Slab::fit(square, slab.from, slab.middle, budget),
            Slab::fit(square, slab.middle, slab.to, budget),
        );
        // What has to be left as it is costs time for the rays that come there, and nothing else.
        let (Some(one), Some(other)) = (one, other) else {
            slabs.push(slab);
            break;
        };
        for half in [one, other] {
            let is_stuck = half.middle <= half.from || half.middle >= half.to;
            if half.error > ERROR && halvings + 1 < HALVINGS && !is_stuck {
                coarse.push(Part { slab: half, halvings: halvings + 1 });
            } else {
                slabs.push(half);
            }
        }
    }
    slabs.extend(coarse.into_iter().map(|part| part.slab));
    Ok(slabs)
}

impl Slab {
    fn void(from: f64, to: f64) -> Self {
        let middle = 0.5 * (from + to);
        Self {
            from,
            to,
            middle,
            c0: 0.0,
            c1: 0.0,
            c2: 0.0,
            error: 0.0,
            slope_error: 0.0,
            most: 0.0,
            is_void: true,
        }
    }

    /// The parabola through three Chebyshev points, and its proven error; nothing where that costs too much.
    fn fit(square: &Formula, from: f64, to: f64, budget: &mut Budget) -> Option<Self> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let node = 0.75_f64.sqrt();
        let [below, at, above] = [-node, 0.0, node].map(|x| square.at(middle + x * half));
        let c1 = (above - below) / (2.0 * node * half);
        let c2 = (above - 2.0 * at + below) / (2.0 * node * node * half * half);
        let mut slab = Self { c0: at, c1, c2, is_void: false, ..Self::void(from, to) };
        slab.certify(square, budget)?;
        // Where the square has no slope to speak of, a level parabola is as good as any.
        if !slab.error.is_finite() {
            slab = Self { c0: 0.5 * slab.most, c1: 0.0, c2: 0.0, ..slab };
            slab.certify(square, budget)?;
        }
        Some(slab)
    }

    /// Proves bounds of the difference between the square and the parabola, on eight parts of the slab.
    fn certify(&mut self, square: &Formula, budget: &mut Budget) -> Option<()> {
        const PARTS: usize = 8;
        // Two evaluations in each part, with bounds of two derivatives: about nine of the value alone.
        if !budget.spend(square, 2 * PARTS as u64 * 9) {
            return None;
        }
        let parabola = |y: Dual<Dual<Interval>>| {
            let v = y - Dual::constant(self.middle);
            Dual::constant(self.c0) + v * Dual::constant(self.c1) + v.powi(2) * Dual::constant(self.c2)
        };
        let (mut error, mut slope_error, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
        let end = |part: usize| self.from + (self.to - self.from) * part as f64 / PARTS as f64;
        for part in 0..PARTS {
            let (low, high) = (end(part), if part + 1 == PARTS { self.to } else { end(part + 1) });
            let middle = 0.5 * (low + high);
            let reach = (high - middle).max(middle - low);
            let at = |y: Interval| {
                let y = Dual::variable_twice(y);
                let value = square.at(y);
                (value, value - parabola(y))
            };
            let (_, thin) = at(Interval::constant(middle));
            let (value, wide) = at(Interval { low, high });
            let thin_value = thin.value.value.magnitude();
            // Taylor's theorem of second and of first order, and the values themselves: whichever says most.
            let second = thin_value
                + thin.first().magnitude() * reach
                + 0.5 * wide.second().magnitude() * reach * reach;
            let first = thin_value + wide.first().magnitude() * reach;
            let plain = wide.value.value.magnitude();
            error = larger_or_infinite(error, second.min(first).min(plain));
            let slope = thin.first().magnitude() + wide.second().magnitude() * reach;
            slope_error = larger_or_infinite(slope_error, slope.min(wide.first().magnitude()));
            most = larger_or_infinite(most, value.value.value.high);
        }
        (self.error, self.slope_error, self.most) = (error, slope_error, most);
        Some(())
    }
}

/// The larger of two; without end where one is not a number.
fn larger_or_infinite(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}
