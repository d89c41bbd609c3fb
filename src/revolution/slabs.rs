//! A profile cut into slabs, in each of which its square is a parabola, but for a proven error.

use crate::dual::Dual;
use crate::formula::Formula;
use crate::interval::Interval;
use crate::number::Number;

/// The error that slabs are cut for. From 1/100 to 1/10000 makes no difference to the time a ray takes; less costs
/// memory and more.
const ERROR: f64 = 1e-3;

/// How often a slab is halved at most. What is not smooth there, such as a kink, keeps its larger error.
const HALVINGS: u32 = 12;

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

/// Why a profile makes no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoSurface {
    /// It has no bound.
    Unbounded {
        /// A height where that is so.
        near: f64,
    },
    /// It is nowhere above 0.
    Nowhere,
}

/// The slabs of a profile, from the bottom up.
pub struct Slabs {
    slabs: Vec<Slab>,
    /// The slab of each of so many equal parts of the height.
    table: Vec<u32>,
    parts_per_unit: f64,
    widest: f64,
    reach: f64,
    is_smooth: bool,
}

impl Slabs {
    /// Cuts a profile, whose square is given, too, into slabs from 0 to a height.
    pub fn new(profile: &Formula, square: &Formula, height: f64) -> Result<Self, NoSurface> {
        let mut ranges = Vec::new();
        signs(profile, (0.0, height), 20, &mut ranges);
        let mut slabs = Vec::new();
        for (from, to, is_void) in ranges {
            if is_void {
                slabs.push(Slab::void(from, to));
            } else {
                cut(square, (from, to), HALVINGS, &mut slabs)?;
            }
        }
        if slabs.iter().all(|slab| slab.most == 0.0) {
            return Err(NoSurface::Nowhere);
        }
        let parts = 256.max(2 * slabs.len());
        let parts_per_unit = parts as f64 / height;
        let slab_at = |y: f64| slabs.partition_point(|slab: &Slab| slab.to <= y).min(slabs.len() - 1) as u32;
        let table = (0..=parts).map(|part| slab_at(part as f64 / parts_per_unit)).collect();
        let most = slabs.iter().map(|slab| slab.most).fold(0.0, f64::max);
        let shell = slabs.iter().map(|slab| slab.most + 2.0 * slab.error).fold(0.0, f64::max);
        let is_smooth = slabs.iter().all(|slab| slab.slope_error.is_finite());
        Ok(Self {
            is_smooth,
            table,
            parts_per_unit,
            widest: most.sqrt().next_up(),
            reach: 1.001 * shell,
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

/// Parts a range of heights into those where the profile is negative (true) and those where it is not.
fn signs(profile: &Formula, (from, to): (f64, f64), halvings: u32, ranges: &mut Vec<(f64, f64, bool)>) {
    let mut push = |from: f64, to: f64, is_void: bool| match ranges.last_mut() {
        Some((_, end, last)) if *last == is_void => *end = to,
        _ if from < to => ranges.push((from, to, is_void)),
        _ => {}
    };
    let Dual { value, slope } = profile.at(Dual::variable(Interval { low: from, high: to }));
    let middle = 0.5 * (from + to);
    if value.low >= 0.0 {
        push(from, to, false);
    } else if value.high <= 0.0 {
        push(from, to, true);
    } else if !slope.has_zero() && slope.is_bounded() {
        // It grows or falls all the way: there is one change of sign at most.
        let is_void = |y: f64| profile.at(y) < 0.0;
        let (at_from, at_to) = (is_void(from), is_void(to));
        let change = if at_from == at_to { to } else { change(|y| is_void(y) == at_from, from, to) };
        push(from, change, at_from);
        push(change, to, at_to);
    } else if halvings == 0 || middle <= from || middle >= to {
        push(from, to, profile.at(middle) < 0.0);
    } else {
        signs(profile, (from, middle), halvings - 1, ranges);
        signs(profile, (middle, to), halvings - 1, ranges);
    }
}

/// The last number from `low` to `high` of which something is true, which is true of `low` and not of `high`.
fn change(is_true: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if is_true(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Cuts a range of heights into slabs.
fn cut(
    square: &Formula,
    (from, to): (f64, f64),
    halvings: u32,
    slabs: &mut Vec<Slab>,
) -> Result<(), NoSurface> {
    let slab = Slab::fit(square, from, to);
    if slab.error <= ERROR || halvings == 0 {
        if !slab.most.is_finite() || !slab.error.is_finite() {
            return Err(NoSurface::Unbounded { near: slab.middle });
        }
        slabs.push(slab);
        return Ok(());
    }
    let middle = slab.middle;
    cut(square, (from, middle), halvings - 1, slabs)?;
    cut(square, (middle, to), halvings - 1, slabs)
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

    /// The parabola through three Chebyshev points, and its proven error.
    fn fit(square: &Formula, from: f64, to: f64) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let node = 0.75_f64.sqrt();
        let [below, at, above] = [-node, 0.0, node].map(|x| square.at(middle + x * half));
        let c1 = (above - below) / (2.0 * node * half);
        let c2 = (above - 2.0 * at + below) / (2.0 * node * node * half * half);
        let mut slab = Self { c0: at, c1, c2, is_void: false, ..Self::void(from, to) };
        slab.certify(square);
        // Where the square has no slope to speak of, a level parabola is as good as any.
        if !slab.error.is_finite() {
            slab = Self { c0: 0.5 * slab.most, c1: 0.0, c2: 0.0, ..slab };
            slab.certify(square);
        }
        slab
    }

    /// Proves bounds of the difference between the square and the parabola, on eight parts of the slab.
    fn certify(&mut self, square: &Formula) {
        const PARTS: usize = 8;
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
            error = larger(error, second.min(first).min(plain));
            let slope = thin.first().magnitude() + wide.second().magnitude() * reach;
            slope_error = larger(slope_error, slope.min(wide.first().magnitude()));
            most = larger(most, value.value.value.high);
        }
        (self.error, self.slope_error, self.most) = (error, slope_error, most);
    }
}

/// The larger of two; without end where one is not a number.
fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}
