//! The ranges of heights where a profile is negative and where it is not, proven by bounds of its value and slope.
//!
//! A range is halved until bounds show that the profile has one sign there, or is monotonic and thus changes its sign
//! at most once, between two neighbouring numbers. Where rounding hides the sign on all shorter pieces, too, the
//! computed sign counts. A bound of the profile there is kept, and must be negligible.

use super::budget::Budget;
use super::no_surface::NoSurface;
use tabray_exact::dual::Dual;
use tabray_exact::formula::Formula;
use tabray_exact::interval::Interval;
use tabray_exact::roots::bisection::bisect;
use tabray_exact::scalar::Scalar;

/// The ranges of a profile, from the bottom up.
pub(super) struct Ranges {
    /// The ends of each range in world units, and whether the profile is negative there.
    pub list: Vec<(f64, f64, bool)>,
    /// A bound, in world units, of the profile where it counts as negative by mistake, and of its absolute value where
    /// it counts as not negative by mistake.
    pub hidden: f64,
    /// The height with the largest such value, in world units.
    pub hidden_at: f64,
}

impl Ranges {
    /// Computes the ranges of a profile for heights from 0 to `height`.
    pub fn new(profile: &Formula, height: f64, budget: &mut Budget) -> Result<Self, NoSurface> {
        let mut ranges = Self { list: Vec::new(), hidden: 0.0, hidden_at: 0.0 };
        let mut waiting = vec![(0.0, height)];
        while let Some((low, high)) = waiting.pop() {
            // Bounds of the value and the slope, and of the value again, take about 16 times as long as the plain
            // value.
            if !budget.charge(profile, 16) {
                return Err(NoSurface::Signs { from: low });
            }
            let middle = low + 0.5 * (high - low);
            let wide = profile.at(Dual::variable(Interval { low, high }));
            let thin = profile.at(Interval::constant(middle));
            let slope = wide.slope;
            let mut value = wide.value;
            if slope.is_bounded() {
                let reach = (middle - low).max(high - middle).next_up();
                let around = thin + slope * Interval { low: -reach, high: reach };
                value = Interval { low: value.low.max(around.low), high: value.high.min(around.high) };
            }
            if value.low >= 0.0 {
                ranges.push(low, high, false);
            } else if value.high <= 0.0 {
                ranges.push(low, high, true);
            } else if thin == Interval::WHOLE {
                return Err(NoSurface::Unbounded { near: middle });
            } else if slope.is_bounded() && !slope.has_zero() {
                ranges.push_monotone(profile, low, high);
            } else if middle <= low || middle >= high {
                // The ends are neighbouring numbers, and the void ends there, if there is one.
                let is_void = ranges.is_void(profile, low) | ranges.is_void(profile, high);
                ranges.push(low, high, is_void);
            } else if thin.has_zero() && value.magnitude() <= 4.0 * thin.magnitude() {
                // The bounds are little more than rounding error, and shorter pieces would not help.
                let is_void = profile.at(middle) < 0.0;
                ranges.keep_hidden(value, is_void, middle);
                ranges.push(low, high, is_void);
            } else {
                waiting.extend([(middle, high), (low, middle)]);
            }
        }
        Ok(ranges)
    }

    fn push(&mut self, from: f64, to: f64, is_void: bool) {
        match self.list.last_mut() {
            Some((_, end, last)) if *last == is_void => *end = to,
            _ if from < to => self.list.push((from, to, is_void)),
            _ => {}
        }
    }

    /// Adds a piece on which the profile is monotonic.
    fn push_monotone(&mut self, profile: &Formula, from: f64, to: f64) {
        let (at_from, at_to) = (self.is_void(profile, from), self.is_void(profile, to));
        if at_from == at_to {
            return self.push(from, to, at_from);
        }
        let (low, high) = bisect(|y| (profile.at(y) < 0.0) == at_to, (from, to), 0.0);
        self.is_void(profile, low);
        self.is_void(profile, high);
        // The surface ends at a number where it exists.
        let change = if at_from { high } else { low };
        self.push(from, change, at_from);
        self.push(change, to, at_to);
    }

    /// Returns whether the profile is negative at a height, as computed, and keeps a bound of a mistake.
    fn is_void(&mut self, profile: &Formula, y: f64) -> bool {
        let is_void = profile.at(y) < 0.0;
        self.keep_hidden(profile.at(Interval::constant(y)), is_void, y);
        is_void
    }

    /// Keeps a bound of the profile on the other side of 0 than it counts.
    fn keep_hidden(&mut self, bounds: Interval, is_void: bool, y: f64) {
        let beyond = if is_void { bounds.high } else { -bounds.low };
        // An unbounded profile makes no surface, which is found when it is cut into slabs.
        if beyond > self.hidden && beyond.is_finite() {
            (self.hidden, self.hidden_at) = (beyond, y);
        }
    }
}
