//! Where a ray grazes the shell of a slab: the first root on a short piece of it, by second-order Taylor bounds.

use super::Revolution;
use super::local::Local;
use crate::dual::Dual;
use crate::interval::Interval;
use crate::newton;
use crate::number::Number;

/// The most pieces that wait to be looked at.
const PIECES: usize = 128;

impl Revolution {
    /// The first place from `from` to `to` where the ray crosses the surface: falling below 0 where `wanted` is
    /// positive, rising above it where `wanted` is negative, either where it is 0.
    ///
    /// A piece without a root is proven to have none, by bounds of the second derivative; one where the function
    /// grows or falls all the way shows its root by the signs at its ends; any other is parted (numerics: "Taylor-2",
    /// after Mitchell 1990).
    pub(super) fn first_crossing(&self, local: &Local, from: f64, to: f64, wanted: f64) -> Option<f64> {
        let mut waiting = [(0.0, 0.0); PIECES];
        let mut count = 1;
        waiting[0] = (from, to);
        let tolerance = local.tolerance();
        let dy = local.dir.y;
        while count > 0 {
            count -= 1;
            let (low, high) = waiting[count];
            let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
            let y = local.height(middle);
            let at = self.square.at(Dual::variable(y));
            let around = local.around(middle);
            let value = around - at.value;
            let slope = 2.0 * (local.a * middle + local.b) - at.slope * dy;
            // What rounding makes of the squares, and of y through the slope of the profile's square.
            let rounding = 16.0
                * f64::EPSILON
                * (around + at.value.abs() + 0.5 * at.slope.abs() * (y.abs() + local.origin.y.abs()));
            let heights =
                Interval::constant(local.origin.y) + Interval { low, high } * Interval::constant(dy);
            let bend = self.square.at(Dual::variable_twice(heights)).second();
            let (least, greatest) = (2.0 * local.a - dy * dy * bend.high, 2.0 * local.a - dy * dy * bend.low);
            // With its sign turned so that it is positive in the middle, it is above height + slope u + bend u^2 / 2.
            let (height, falls, bend) =
                if value > 0.0 { (value, slope, least) } else { (-value, -slope, -greatest) };
            let height = height - rounding;
            let dip = if bend < 0.0 { 0.5 * bend * reach * reach } else { 0.0 };
            if height - falls.abs() * reach + dip > 0.0 {
                continue;
            }
            if slope.abs() > least.abs().max(greatest.abs()) * reach * (1.0 + 1e-7) && reach < f64::INFINITY {
                if wanted * slope > 0.0 {
                    continue;
                }
                let (at_low, at_high) = (self.outside(local, low), self.outside(local, high));
                if at_low == 0.0 || (at_low < 0.0) != (at_high < 0.0) {
                    let start = (middle - value / slope).clamp(low, high);
                    let f = |along| self.outside_and_slope(local, along);
                    return Some(newton::root(f, (low, high), at_low, start, tolerance));
                }
                continue;
            }
            if high - low < 64.0 * tolerance {
                if self.is_crossing(local, low, high, wanted) {
                    return Some(middle);
                }
                continue;
            }
            if count + 2 > PIECES {
                return None;
            }
            if height <= 0.0 || !bend.is_finite() {
                waiting[count] = (middle, high);
                waiting[count + 1] = (low, middle);
                count += 2;
                continue;
            }
            // Around the middle that bound is positive: only what lies beyond can have roots.
            let (left, right) = free_around(height, falls, bend);
            if right <= reach {
                waiting[count] = (middle + right * (1.0 - 1e-12), high);
                count += 1;
            }
            if left >= -reach {
                waiting[count] = (low, middle + left * (1.0 - 1e-12));
                count += 1;
            }
        }
        None
    }

    /// The last word on a piece of a few units in the last place: it is a crossing if the sign changes in it or all
    /// of it is at the level of rounding. A jump of the profile far from 0 is neither.
    fn is_crossing(&self, local: &Local, low: f64, high: f64, wanted: f64) -> bool {
        let (at_low, at_high) = (self.outside(local, low), self.outside(local, high));
        if (at_low < 0.0) != (at_high < 0.0) {
            return wanted * at_low >= 0.0;
        }
        at_low.abs().min(at_high.abs()) <= 1e3 * f64::EPSILON * local.around(low)
    }
}

/// The roots next to 0 of `height + slope u + bend u^2 / 2`, which is positive at 0.
fn free_around(height: f64, slope: f64, bend: f64) -> (f64, f64) {
    let (mut left, mut right) = (f64::NEG_INFINITY, f64::INFINITY);
    let discriminant = slope * slope - 2.0 * bend * height;
    if discriminant >= 0.0 {
        let root = discriminant.sqrt();
        for u in [-2.0 * height / (slope + root), -2.0 * height / (slope - root)] {
            if u < 0.0 {
                left = left.max(u);
            } else if u > 0.0 {
                right = right.min(u);
            }
        }
    }
    (left, right)
}
