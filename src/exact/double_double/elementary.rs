//! The functions of formulas in double-double arithmetic, by their series. They decide cases that `f64` leaves
//! undecided, and compute the true hits for tests.

use super::{DoubleDouble, power_of_two, two_product};
use crate::scalar::{Scalar, of_cubic, of_noise, per_axis};
use crate::spline::Spline;

/// π / 2 as an unevaluated sum. Each part has the next 53 bits.
const HALF_PI: [f64; 4] = [
    std::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
    5.562_271_104_316_826e-50,
];

/// ln 2 as an unevaluated sum. Each part has the next 53 bits.
const LN_2: [f64; 3] = [std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17, 5.707_708_438_416_212e-34];

impl DoubleDouble {
    const ZERO: Self = Self { high: 0.0, low: 0.0 };
    const ONE: Self = Self { high: 1.0, low: 0.0 };

    /// Returns whether the number is negative.
    pub fn is_negative(self) -> bool {
        self < Self::ZERO
    }

    /// Returns the number times 2^`exponent`, exactly.
    fn scaled(self, exponent: i32) -> Self {
        let factor = power_of_two(exponent);
        Self { high: self.high * factor, low: self.low * factor }
    }

    /// Returns the number minus `times` a constant, given as an unevaluated sum.
    fn without(self, times: f64, parts: &[f64]) -> Self {
        parts.iter().fold(self, |left, part| {
            let (high, low) = two_product(times, *part);
            left - Self { high, low }
        })
    }

    /// Returns the sine and cosine of an angle of at most π / 4 radians, by their Taylor series.
    fn sin_cos_of_small(self) -> (Self, Self) {
        // The last term is (π / 4)^28 / 28! = 4e-33.
        const LAST: i32 = 28;
        let square = self * self;
        let (mut sin, mut cos) = (Self::ONE, Self::ONE);
        for order in (1..=LAST / 2).rev() {
            let order = f64::from(2 * order);
            sin = Self::ONE - square * sin / Self::constant(order * (order + 1.0));
            cos = Self::ONE - square * cos / Self::constant(order * (order - 1.0));
        }
        (self * sin, cos)
    }

    /// Returns the sine and cosine of an angle in radians, after reduction by multiples of π / 2.
    fn reduced_sin_cos(self) -> (Self, Self) {
        let quarters = (self.high / HALF_PI[0]).round();
        let (sin, cos) = self.without(quarters, &HALF_PI).sin_cos_of_small();
        match quarters.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
}

impl Scalar for DoubleDouble {
    fn constant(value: f64) -> Self {
        value.into()
    }

    #[inline(always)]
    fn bounds(self) -> [f64; 2] {
        [self.high.next_down(), self.high.next_up()]
    }

    fn sin_cos(self) -> (Self, Self) {
        self.reduced_sin_cos()
    }

    fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        sin / cos
    }

    fn exp(self) -> Self {
        // The result underflows to 0 below the first bound, and overflows above the second.
        if self.high < -745.2 {
            return Self::ZERO;
        }
        if self.high > 709.8 {
            return f64::INFINITY.into();
        }
        const HALVINGS: i32 = 8;
        const TERMS: i32 = 13; // (ln 2 / 2 / 2^8)^13 / 13! = 1e-47
        let doublings = (self.high / LN_2[0]).round();
        let small = self.without(doublings, &LN_2).scaled(-HALVINGS);
        // e^x - 1 keeps small digits that e^x has no room for.
        let mut series = Self::ONE;
        for term in (2..=TERMS).rev() {
            series = Self::ONE + small * series / f64::from(term).into();
        }
        let mut less_one = small * series;
        for _ in 0..HALVINGS {
            less_one = less_one * (less_one + 2.0.into());
        }
        (less_one + Self::ONE).scaled(doublings as i32)
    }

    fn ln(self) -> Self {
        if self.is_zero() {
            return f64::NEG_INFINITY.into();
        }
        if self.is_negative() {
            return f64::NAN.into();
        }
        // For x = 2^n m with m around 1, ln m = 2 artanh((m - 1) / (m + 1)).
        let doublings = libm::log2(self.high).round();
        let m = self.scaled(-(doublings as i32));
        let ratio = (m - Self::ONE) / (m + Self::ONE);
        let square = ratio * ratio;
        const TERMS: i32 = 23; // ((sqrt 2 - 1) / (sqrt 2 + 1))^46 = 6e-36
        let mut series = Self::ZERO;
        for term in (0..TERMS).rev() {
            series = series * square + Self::ONE / f64::from(2 * term + 1).into();
        }
        (ratio * series).scaled(1).without(-doublings, &LN_2)
    }

    /// Rotates the point back by its angle in `f64`. The remaining angle is so small that it equals its tangent.
    fn atan2(self, x: Self) -> Self {
        let angle = Self::from(libm::atan2(self.high, x.high));
        let (sin, cos) = angle.sin_cos();
        let left = (self * cos - x * sin) / (x * cos + self * sin);
        if left.high.is_finite() { angle + left } else { angle }
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn abs(self) -> Self {
        if self.is_negative() { -self } else { self }
    }

    fn floor(self) -> Self {
        let high = self.high.floor();
        if high == self.high { Self::normal(high, self.low.floor()) } else { high.into() }
    }

    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    fn pow(self, exponent: Self) -> Self {
        if exponent.is_zero() {
            Self::ONE
        } else if self.is_zero() {
            if exponent.is_negative() { f64::INFINITY.into() } else { Self::ZERO }
        } else {
            (exponent * self.ln()).exp()
        }
    }

    fn powi(self, exponent: i32) -> Self {
        let power = (0..exponent.unsigned_abs()).fold(Self::ONE, |power, _| power * self);
        if exponent < 0 { Self::ONE / power } else { power }
    }

    fn spline(self, spline: &Spline, order: usize) -> Self {
        of_cubic(self, spline, (spline.piece(self.high), order), |of| Self::from(of.near) + of.rest.into())
    }

    fn noise(at: [Self; 3], orders: [u8; 3]) -> Self {
        // A corner with coordinates too large for one `f64` is slightly off, and so is its cell.
        let corner = at.map(|along| along.floor().high);
        of_noise(corner, per_axis(|axis| at[axis].shifted(-corner[axis])), orders)
    }

    fn step(self) -> Self {
        if self.is_negative() { Self::ZERO } else { Self::ONE }
    }

    fn d_step(self) -> Self {
        Self::ZERO
    }

    fn d_floor(self) -> Self {
        Self::ZERO
    }

    fn is_zero(self) -> bool {
        self == Self::ZERO
    }
}
