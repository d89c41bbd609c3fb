//! Integers times powers of two: sums and products of `f64` numbers without any rounding.

use dashu_int::ops::{BitTest, DivEuclid, SquareRoot};
use dashu_int::{IBig, Sign, UBig};
use std::cmp::Ordering;

/// The number `whole * 2^power`.
#[derive(Clone, Debug)]
pub struct Dyadic {
    whole: IBig,
    power: i64,
}

impl Dyadic {
    pub fn zero() -> Self {
        Self { whole: IBig::ZERO, power: 0 }
    }

    pub fn int(number: i64) -> Self {
        Self { whole: IBig::from(number), power: 0 }
    }

    pub fn parts(whole: IBig, power: i64) -> Self {
        Self { whole, power }
    }

    /// Returns the exact value of a finite number.
    pub fn from(number: f64) -> Self {
        assert!(number.is_finite(), "{number} is no number");
        if number == 0.0 {
            return Self::zero();
        }
        let bits = number.to_bits();
        let field = (bits >> 52 & 0x7ff) as i64;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, power) =
            if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
        let low = mantissa.trailing_zeros();
        let whole = (mantissa >> low) as i64;
        Self { whole: IBig::from(if number < 0.0 { -whole } else { whole }), power: power + i64::from(low) }
    }

    pub fn sign(&self) -> Ordering {
        if self.whole.is_zero() {
            Ordering::Equal
        } else if self.whole.sign() == Sign::Negative {
            Ordering::Less
        } else {
            Ordering::Greater
        }
    }

    pub fn is_zero(&self) -> bool {
        self.whole.is_zero()
    }

    /// Returns the exponent of the smallest power of two above the number's magnitude. For 0 it is very small.
    pub fn size(&self) -> i64 {
        if self.is_zero() { i64::MIN / 4 } else { self.whole.bit_len() as i64 + self.power }
    }

    pub fn neg(&self) -> Self {
        Self { whole: -&self.whole, power: self.power }
    }

    pub fn add(&self, other: &Self) -> Self {
        if self.is_zero() {
            return other.clone();
        }
        if other.is_zero() {
            return self.clone();
        }
        let power = self.power.min(other.power);
        let lift = |of: &Self| match (of.power - power) as usize {
            0 => of.whole.clone(),
            more => &of.whole << more,
        };
        Self { whole: lift(self) + lift(other), power }
    }

    pub fn sub(&self, other: &Self) -> Self {
        self.add(&other.neg())
    }

    pub fn mul(&self, other: &Self) -> Self {
        Self { whole: &self.whole * &other.whole, power: self.power + other.power }
    }

    pub fn square(&self) -> Self {
        self.mul(self)
    }

    /// Returns the number times 2^`power`.
    pub fn shifted(&self, power: i64) -> Self {
        Self { whole: self.whole.clone(), power: self.power + power }
    }

    pub fn compare(&self, other: &Self) -> Ordering {
        match (self.sign(), other.sign()) {
            (one, two) if one != two => one.cmp(&two),
            (Ordering::Equal, _) => Ordering::Equal,
            (sign, _) if self.size() != other.size() => {
                let larger = self.size().cmp(&other.size());
                if sign == Ordering::Greater { larger } else { larger.reverse() }
            }
            _ => self.sub(other).sign(),
        }
    }

    /// Rounds to at most `bits` significant bits, toward plus infinity if `up` and toward minus infinity otherwise.
    pub fn rounded(self, bits: i64, up: bool) -> Self {
        let extra = self.whole.bit_len() as i64 - bits;
        if extra <= 0 {
            return self;
        }
        // A shift to the right rounds down.
        let mut whole = self.whole >> extra as usize;
        if up {
            whole += IBig::from(1);
        }
        Self { whole, power: self.power + extra }
    }

    /// Returns the quotient to about `bits` significant bits, rounded toward plus infinity if `up` and toward minus
    /// infinity otherwise.
    pub fn divided(&self, by: &Self, bits: i64, up: bool) -> Self {
        assert!(!by.is_zero(), "division by 0");
        if self.is_zero() {
            return Self::zero();
        }
        let (top, bottom) = match by.sign() {
            Ordering::Less => (-&self.whole, -&by.whole),
            _ => (self.whole.clone(), by.whole.clone()),
        };
        let more = (bits + bottom.bit_len() as i64 - top.bit_len() as i64 + 1).max(0);
        let top = top << more as usize;
        let mut whole = (&top).div_euclid(&bottom);
        if up && &whole * &bottom != top {
            whole += IBig::from(1);
        }
        Self { whole, power: self.power - by.power - more }.rounded(bits, up)
    }

    /// Returns the square root of a number that is not negative, to about `bits` significant bits, rounded toward plus
    /// infinity if `up` and toward minus infinity otherwise.
    pub fn root(&self, bits: i64, up: bool) -> Self {
        assert!(self.sign() != Ordering::Less, "a root of a negative number");
        if self.is_zero() {
            return Self::zero();
        }
        let mut more = (2 * bits - self.whole.bit_len() as i64 + 2).max(0);
        if (self.power - more) % 2 != 0 {
            more += 1;
        }
        let square = &self.whole << more as usize;
        let square: UBig = square.into_parts().1;
        let mut root = square.sqrt();
        if up && &root * &root != square {
            root += UBig::from(1_u8);
        }
        Self { whole: root.into(), power: (self.power - more) / 2 }.rounded(bits, up)
    }

    /// Returns the number in units of 2^-`bits`, rounded down to an integer.
    pub fn fixed(&self, bits: i64) -> IBig {
        let shift = self.power + bits;
        if shift >= 0 { &self.whole << shift as usize } else { &self.whole >> (-shift) as usize }
    }

    /// Returns an `f64` near the number: not below it if `up`, and not above it otherwise. Numbers of magnitude below
    /// 2^-1001 become 0 or that.
    pub fn to_f64(&self, up: bool) -> f64 {
        let size = self.size();
        if self.is_zero() {
            return 0.0;
        }
        if size > 1024 {
            return match (self.sign(), up) {
                (Ordering::Less, true) => f64::MIN,
                (Ordering::Less, false) => f64::NEG_INFINITY,
                (_, true) => f64::INFINITY,
                (_, false) => f64::MAX,
            };
        }
        if size < -1000 {
            let tiny = 2_f64.powi(-1001);
            return match (self.sign(), up) {
                (Ordering::Less, true) => 0.0,
                (Ordering::Less, false) => -tiny,
                (_, true) => tiny,
                (_, false) => 0.0,
            };
        }
        let Self { whole, power } = self.clone().rounded(53, up);
        // The integer has at most 53 bits, or 54 of which the last is 0.
        let value = whole.to_f64().value();
        let half = (power / 2) as i32;
        value * 2_f64.powi(half) * 2_f64.powi(power as i32 - half)
    }
}
