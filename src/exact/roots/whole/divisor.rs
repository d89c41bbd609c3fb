//! The greatest common divisor of a polynomial and its derivative, which contains its repeated factors.

use super::polynomial::Whole;
use dashu_int::ops::{Abs, DivRem, Gcd};
use dashu_int::{IBig, UBig};

/// A prime, 2^61 - 1.
const PRIME: u64 = (1 << 61) - 1;

impl Whole {
    /// Returns the polynomial with the same roots, all of them simple.
    pub(super) fn without_repeated_factors(&self) -> Self {
        if self.degree() < 2 || self.has_no_repeated_factor() {
            return self.clone();
        }
        let divisor = self.primitive().divisor(self.derivative().primitive());
        self.divided(&divisor).unwrap_or_else(|| self.clone())
    }

    /// Tells whether a polynomial certainly has no repeated factor, by arithmetic modulo a prime.
    pub fn has_no_repeated_factor(&self) -> bool {
        let remainders = |of: &Self| of.coefficients.iter().map(remainder).collect::<Vec<_>>();
        let (mut one, mut other) = (remainders(self), remainders(&self.derivative()));
        // A lower degree modulo the prime is inconclusive.
        if one.last() == Some(&0) || other.last() == Some(&0) {
            return false;
        }
        while other.len() > 1 {
            let inverse = power(other[other.len() - 1], PRIME - 2);
            while one.len() >= other.len() {
                let factor = times(one[one.len() - 1], inverse);
                let shift = one.len() - other.len();
                for (index, of) in other.iter().enumerate() {
                    let product = times(factor, *of);
                    one[shift + index] = (one[shift + index] + (PRIME - product)) % PRIME;
                }
                one.pop();
                while one.len() > 1 && one.last() == Some(&0) {
                    one.pop();
                }
            }
            if one == [0] {
                return false;
            }
            std::mem::swap(&mut one, &mut other);
        }
        true
    }

    /// Divides by the common divisor of the coefficients.
    pub(super) fn primitive(&self) -> Self {
        let content = self.coefficients.iter().fold(UBig::ZERO, |content, of| {
            let of = of.unsigned_abs_clone();
            if content.is_zero() {
                of
            } else if of.is_zero() {
                content
            } else {
                content.gcd(of)
            }
        });
        let content = IBig::from(content);
        if content.is_zero() {
            return self.clone();
        }
        Self::new(self.coefficients.iter().map(|of| of / &content).collect())
    }

    /// Returns the greatest common divisor with a polynomial of at most the same degree.
    pub fn divisor(&self, other: Self) -> Self {
        let (mut one, mut other) = (self.clone(), other);
        let (mut scale, mut height) = (IBig::ONE, IBig::ONE);
        loop {
            let drop = one.degree() - other.degree();
            let rest = one.remainder(&other);
            if rest.is_zero() {
                return other.primitive();
            }
            if rest.degree() == 0 {
                return Self::new(vec![IBig::ONE]);
            }
            let by = scale * height.pow(drop);
            one = std::mem::replace(
                &mut other,
                Self::new(rest.coefficients.into_iter().map(|of| of / &by).collect()),
            );
            scale = one.leading().clone();
            height = match drop {
                0 => height,
                1 => scale.clone(),
                _ => scale.pow(drop) / height.pow(drop - 1),
            };
        }
    }

    fn leading(&self) -> &IBig {
        &self.coefficients[self.degree()]
    }

    /// Returns the remainder of the division by another polynomial, times a power of its leading coefficient, which
    /// makes it integer.
    fn remainder(&self, other: &Self) -> Self {
        let (mut rest, lead) = (self.coefficients.clone(), other.leading());
        for shift in (0..=self.degree() - other.degree()).rev() {
            let factor = rest[shift + other.degree()].clone();
            rest.iter_mut().for_each(|of| *of *= lead);
            for (index, of) in other.coefficients.iter().enumerate() {
                rest[shift + index] -= &factor * of;
            }
        }
        rest.truncate(other.degree().max(1));
        Self::new(rest)
    }

    /// Returns the quotient by another polynomial, if its coefficients are integers and the remainder is 0.
    pub fn divided(&self, other: &Self) -> Option<Self> {
        if self.degree() < other.degree() || other.is_zero() {
            return None;
        }
        let (mut rest, count) = (self.coefficients.clone(), self.degree() - other.degree() + 1);
        let mut quotient = vec![IBig::ZERO; count];
        for shift in (0..count).rev() {
            let (factor, left) = (&rest[shift + other.degree()]).div_rem(other.leading());
            if !left.is_zero() {
                return None;
            }
            for (index, of) in other.coefficients.iter().enumerate() {
                rest[shift + index] -= &factor * of;
            }
            quotient[shift] = factor;
        }
        rest.iter().all(IBig::is_zero).then(|| Self::new(quotient))
    }
}

/// Returns the remainder of the division by [`PRIME`], from 0 on.
fn remainder(of: &IBig) -> u64 {
    let rest = u64::try_from(of.clone().abs() % IBig::from(PRIME)).unwrap_or(0);
    if *of < IBig::ZERO && rest > 0 { PRIME - rest } else { rest }
}

fn times(a: u64, b: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64
}

fn power(mut of: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = times(result, of);
        }
        of = times(of, of);
        exponent >>= 1;
    }
    result
}

/// The magnitude of an integer.
trait Magnitude {
    fn unsigned_abs_clone(&self) -> UBig;
}

impl Magnitude for IBig {
    fn unsigned_abs_clone(&self) -> UBig {
        use dashu_int::ops::UnsignedAbs;
        self.clone().unsigned_abs()
    }
}
