//! Functions of formulas over intervals.

use super::{Float, Interval};
use crate::scalar::{Scalar, apart_if, of_cubic};
use crate::spline::{Coefficient, Spline};

/// The largest exponent that counts as an integer, as in formulas.
const MAX_WHOLE: f64 = 1000.0;

impl<F: Float> Interval<F> {
    /// Tells whether no number of the interval is an integer.
    fn has_no_integer(self) -> bool {
        let Interval { low, high } = self.coarse();
        low.floor() < low && high < low.floor() + 1.0
    }

    /// Returns whether the interval may contain `start` plus any multiple of 2π radians.
    fn holds_angle(self, start: F) -> bool {
        // The errors, in EPSILON of the angles, are half each for two roundings in the difference, and for one each in
        // π, the quotient, the product and the two sums: 3.5 in total.
        let rounding = F::of(4.503_599_627_370_496) * F::EPSILON;
        let slack = rounding * (F::of(1.0) + self.low.abs() + self.high.abs());
        let turn = F::of(2.0) * F::PI;
        let turns = -(-((self.low - slack - start) / turn)).floor();
        start + turns * turn <= self.high + slack
    }

    /// Encloses a coefficient of a spline.
    #[inline]
    fn of_coefficient(of: &Coefficient) -> Self {
        if of.error == 0.0 {
            Self::constant(of.near)
        } else if F::IS_LONG {
            let (low, high) = F::enclosing(of.bounds[0], of.bounds[1]);
            Self { low, high }
        } else {
            Self::about(of.near, of.error)
        }
    }

    /// Returns whether the interval is narrower than a bound in radians, and below 1e15 radians, where sines are still
    /// meaningful. Other intervals count as containing all angles.
    fn is_narrower(self, than: F) -> bool {
        self.width() < than && self.magnitude() < F::of(1e15)
    }

    /// Tells whether a sine or cosine certainly has no turning point in the interval, by its derivative at the
    /// endpoints. The derivative has one sign between two neighbouring turning points, and the other beyond them.
    #[inline]
    fn is_monotone(self, slopes: [F; 2]) -> bool {
        // The derivative is smaller than the distance from a turning point, and far above rounding.
        let least = F::of(1e-6);
        let same = slopes[0] > least && slopes[1] > least || slopes[0] < -least && slopes[1] < -least;
        same && self.width() < F::of(3.0) && self.magnitude() < F::of(1e5)
    }

    /// Returns the sine or cosine over the interval, given its values at the endpoints, and whether it is monotonic. It
    /// is 1 at `top` and -1 at `top - π` radians.
    #[inline]
    fn sine_or_cosine(self, at_low: F, at_high: F, is_monotone: bool, top: F) -> Self {
        let one = F::of(1.0);
        let Self { low, high } = Self::around(at_low.min(at_high), at_low.max(at_high));
        if is_monotone {
            return Self { low: low.max(-one), high: high.min(one) };
        }
        Self {
            low: if self.holds_angle(top - F::PI) { -one } else { low.max(-one) },
            high: if self.holds_angle(top) { one } else { high.min(one) },
        }
    }
}

impl<F: Float> Interval<F> {
    /// Returns the square, which is not negative.
    #[inline(always)]
    fn square(self) -> Self {
        let zero = F::of(0.0);
        let (low, high) = (self.low * self.low, self.high * self.high);
        let (least, most) = if low < high { (low, high) } else { (high, low) };
        let least = if self.low > zero || self.high < zero { least } else { zero };
        let square = Self::outward(least, most);
        Self { low: if square.low > zero { square.low } else { zero }, high: square.high }
    }

    /// Returns a power with an integer exponent other than 2.
    #[inline(never)]
    fn power(self, exponent: i32) -> Self {
        if exponent < 0 {
            return Self::constant(1.0) / self.powi(-exponent);
        }
        match exponent {
            0 => return Self::constant(1.0),
            1 => return self,
            _ => {}
        }
        let base = if exponent % 2 == 0 { self.abs() } else { self };
        let mut power = base;
        for _ in 1..exponent {
            let next = power * base;
            // This happens after an underflow, and such numbers are also slow.
            if next.low == power.low && next.high == power.high {
                break;
            }
            power = next;
        }
        if exponent % 2 == 0 { Self { low: power.low.max(F::of(0.0)), high: power.high } } else { power }
    }
}

impl<F: Float> Interval<F> {
    /// Widens computed angles by twice the bound of other functions, because the documentation of `libm` states an
    /// error of up to 2 ulps.
    fn around_angle(self) -> Self {
        let Self { low, high } = Self::around(self.low, self.high);
        Self::around(low, high)
    }
}

impl<F: Float> Scalar for Interval<F> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::point(F::of(value))
    }

    #[inline(always)]
    fn about(value: f64, error: f64) -> Self {
        apart_if!(F::IS_LONG, {
            let (value, error) = (F::of(value), F::of(error));
            Self::outward_sum(value - error, value + error)
        })
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        let Interval { low, high } = self.coarse();
        [low, high]
    }

    fn sin_cos(self) -> (Self, Self) {
        // Not widened: the seams of surfaces of u and v are often in a plane that rays lie in, too.
        if self.is_zero() {
            return (self, Self::constant(1.0));
        }
        let half_turn = F::PI;
        if !self.is_narrower(half_turn + half_turn) {
            let any = Self { low: F::of(-1.0), high: F::of(1.0) };
            return (any, any);
        }
        let ([sin_low, sin_high], [cos_low, cos_high]) = F::sines([self.low, self.high]);
        let zero = F::of(0.0);
        (
            self.sine_or_cosine(
                sin_low,
                sin_high,
                self.is_monotone([cos_low, cos_high]),
                F::of(0.5) * half_turn,
            ),
            self.sine_or_cosine(cos_low, cos_high, self.is_monotone([sin_low, sin_high]), zero),
        )
    }

    fn tan(self) -> Self {
        let quarter = F::of(0.5) * F::PI;
        if !self.is_narrower(F::PI) || self.holds_angle(quarter) || self.holds_angle(-quarter) {
            return Self::whole();
        }
        Self::around(self.low.tan(), self.high.tan())
    }

    fn exp(self) -> Self {
        let (low, high) = F::exps(self.low, self.high);
        // A power that overflows is a finite number all the same.
        let Self { low, high } = Self::around(low.min(F::MAX), high);
        Self { low: low.max(F::of(0.0)), high }
    }

    fn ln(self) -> Self {
        let zero = F::of(0.0);
        if self.low > zero {
            let (low, high) = F::lns(self.low, self.high);
            Self::around(low, high)
        } else if self.low == zero && self.high > zero {
            Self { low: -F::INFINITY, ..Self::around(zero, self.high.ln()) }
        } else {
            Self::whole()
        }
    }

    fn atan2(self, x: Self) -> Self {
        let (half_turn, zero) = (Self::pi(), F::of(0.0));
        // The angle jumps from -π to π at y = 0 and negative x.
        if !(self.low > zero || self.high < zero || x.low > zero) {
            return Self { low: -half_turn.high, high: half_turn.high };
        }
        // Points with the same angle lie on a straight line, and so the minimum and maximum angles are at corners.
        let angles = [(self.low, x.low), (self.low, x.high), (self.high, x.low), (self.high, x.high)]
            .map(|(y, x)| Self::point(y.atan2(x)));
        angles.into_iter().reduce(Self::hull).map_or(Self::whole(), Self::around_angle)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        apart_if!(F::IS_LONG, {
            let zero = F::of(0.0);
            // The comparison keeps a NaN.
            let root = |of: F| (if of < zero { zero } else { of }).sqrt();
            let root = Self::outward(root(self.low), root(self.high));
            Self { low: root.low.max(zero), high: root.high }
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        apart_if!(F::IS_LONG, {
            let zero = F::of(0.0);
            if self.low >= zero {
                self
            } else if self.high <= zero {
                -self
            } else {
                Self { low: zero, high: self.magnitude() }
            }
        })
    }

    fn floor(self) -> Self {
        Self { low: self.low.floor(), high: self.high.floor() }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        apart_if!(F::IS_LONG, Self { low: self.low.min(other.low), high: self.high.min(other.high) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        apart_if!(F::IS_LONG, Self { low: self.low.max(other.low), high: self.high.max(other.high) })
    }

    fn pow(self, exponent: Self) -> Self {
        let zero = F::of(0.0);
        if let Some(exponent) = exponent.whole() {
            self.powi(exponent)
        } else if self.is_zero() && exponent.low > zero {
            Self::constant(0.0)
        } else if self.low >= zero {
            (exponent * self.ln()).exp()
        } else if self.high >= zero && exponent.has_no_integer() {
            // Of negative numbers there is no such power, as there is no root.
            Self { low: zero, ..self }.pow(exponent)
        } else {
            Self::whole()
        }
    }

    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        if exponent == 2 { apart_if!(F::IS_LONG, self.square()) } else { self.power(exponent) }
    }

    fn whole(self) -> Option<i32> {
        let number = self.coarse();
        let is_whole = self.low == self.high && number.low.fract() == 0.0 && number.low == number.high;
        (is_whole && number.low.abs() <= MAX_WHOLE).then_some(number.low as i32)
    }

    /// Encloses the values of each overlapping piece of the spline, over its intersection with the interval.
    fn spline(self, spline: &Spline, order: usize) -> Self {
        let Interval { low, high } = self.coarse();
        let [first, last] = [low, high].map(|end| spline.piece(end));
        let part = |piece: usize| {
            let [low, high] = spline.ends(piece).map(F::of);
            let (low, high) = (self.low.max(low), self.high.min(high));
            // Only the rounding of an end may have selected the piece before.
            let y = Self { low: low.min(high), high: low.max(high) };
            of_cubic(y, spline, (piece, order), Self::of_coefficient)
        };
        (first + 1..=last).fold(part(first), |all, piece| all.hull(part(piece)))
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        super::noise::enclosed(at, orders)
    }

    #[inline(always)]
    fn step(self) -> Self {
        apart_if!(F::IS_LONG, {
            let (zero, one) = (F::of(0.0), F::of(1.0));
            Self {
                low: if self.low > zero { one } else { zero },
                high: if self.high < zero { zero } else { one },
            }
        })
    }

    fn choose(self, one: Self, other: Self) -> Self {
        let zero = F::of(0.0);
        if self.low >= zero {
            one
        } else if self.high < zero {
            other
        } else {
            one.hull(other)
        }
    }

    #[inline(always)]
    fn d_step(self) -> Self {
        if self.has_zero() { Self::whole() } else { Self::constant(0.0) }
    }

    fn d_floor(self) -> Self {
        let below = self.low.floor();
        if below == self.high.floor() && self.low > below { Self::constant(0.0) } else { Self::whole() }
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self.low == F::of(0.0) && self.high == F::of(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(crate::properties())]

        /// With a constant exponent, bounds hold all powers that are defined, of negative numbers too, and their slopes.
        #[test]
        fn powers_with_a_constant_exponent_are_enclosed(low in -3.0..3.0, width in 0.0..2.0, part in 0.0..1.0, quarters in 4..24_u32) {
            let (exponent, x) = (f64::from(quarters) / 4.0, low + part * width);
            let base: Dual<Interval> = Dual { value: Interval { low, high: low + width }, slope: Interval::constant(1.0) };
            let Dual { value, slope } = base.pow(Dual::constant(exponent));
            let power = libm::pow(x, exponent);
            if power.is_nan() {
                return Ok(());
            }
            let near = |of: Interval, number: f64| of.low - 1e-9 <= number && number <= of.high + 1e-9;
            prop_assert!(value.low.is_finite() && value.high.is_finite() && near(value, power), "{value:?} {power}");
            let steep = exponent * libm::pow(x, exponent - 1.0);
            prop_assert!(slope.low.is_finite() && slope.high.is_finite() && near(slope, steep), "{slope:?} {steep}");
        }
    }
}
