//! Integers times powers of two.

use crate::interval::Wide;
use dashu_int::IBig;
use dashu_int::ops::BitTest;
use f256::f256;

/// The integer `digits` times 2 to the power `exponent`.
#[derive(Clone, Debug)]
pub struct Dyadic {
    /// The integer.
    pub digits: IBig,
    /// The power of two.
    pub exponent: i64,
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Self) -> bool {
        self.plus(&other.negated()).digits.is_zero()
    }
}

impl From<f64> for Dyadic {
    fn from(value: f64) -> Self {
        let bits = value.abs().to_bits();
        let (exponent, digits) = ((bits >> 52) as i64, bits & ((1 << 52) - 1));
        let (digits, exponent) =
            if exponent == 0 { (digits, -1074) } else { (digits | 1 << 52, exponent - 1075) };
        let digits = IBig::from(digits);
        Self::new(if value < 0.0 { -digits } else { digits }, exponent)
    }
}

impl Dyadic {
    /// Makes a number, with odd digits unless it is 0.
    pub fn new(mut digits: IBig, mut exponent: i64) -> Self {
        match digits.trailing_zeros() {
            None => exponent = 0,
            Some(zeros) => {
                digits >>= zeros;
                exponent += zeros as i64;
            }
        }
        Self { digits, exponent }
    }

    /// Returns the number with the opposite sign.
    pub fn negated(&self) -> Self {
        Self { digits: -self.digits.clone(), exponent: self.exponent }
    }

    /// Returns the sum.
    pub fn plus(&self, other: &Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let scaled = |of: &Self| &of.digits << (of.exponent - exponent) as usize;
        Self::new(scaled(self) + scaled(other), exponent)
    }

    /// Returns the product.
    pub fn times(&self, other: &Self) -> Self {
        Self::new(&self.digits * &other.digits, self.exponent + other.exponent)
    }

    /// Returns the midpoint of this and another number.
    pub fn middle(&self, other: &Self) -> Self {
        let sum = self.plus(other);
        Self::new(sum.digits, sum.exponent - 1)
    }

    /// Encloses the number in 237-bit numbers.
    pub fn wide(&self) -> Wide {
        let length = self.digits.bit_len() as i64;
        let less = (length - 236).max(0);
        let below = &self.digits >> less as usize;
        // A shift rounds down.
        let above = if less > 0 { &below + IBig::ONE } else { below.clone() };
        let number = |digits: IBig| {
            let is_negative = digits < IBig::ZERO;
            let limbs = if is_negative { -digits } else { digits };
            let mut sum = f256::ZERO;
            let mask = IBig::from(u64::MAX >> 12);
            for part in (0..5).rev() {
                let limb = (&limbs >> (52 * part)) & &mask;
                let limb = u64::try_from(limb).unwrap_or(0) as f64;
                sum = sum * f256::from(crate::double_double::power_of_two(52)) + f256::from(limb);
            }
            let sum = if is_negative { -sum } else { sum };
            scaled(sum, self.exponent + less)
        };
        let (low, high) = (number(below), number(above));
        let is_finite = low.is_finite() && high.is_finite();
        if is_finite { Wide { low: low.into(), high: high.into() } } else { Wide::whole() }
    }
}

/// Returns a number times a power of two.
fn scaled(of: f256, exponent: i64) -> f256 {
    let (mut of, mut left) = (of, exponent);
    while left != 0 {
        let step = left.clamp(-1000, 1000);
        of *= f256::from(crate::double_double::power_of_two(step as i32));
        left -= step;
    }
    of
}

/// Converts an `f256` exactly.
impl From<f256> for Dyadic {
    fn from(value: f256) -> Self {
        let (sign, exponent, (high, low)) = value.as_sign_exp_signif();
        let digits = (IBig::from(high) << 128) + IBig::from(low);
        Self::new(if sign == 1 { -digits } else { digits }, i64::from(exponent))
    }
}
