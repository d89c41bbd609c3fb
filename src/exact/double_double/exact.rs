//! Exact sums and products of `f64` numbers, as sums of any number of parts.

use super::{DoubleDouble, two_product, two_sum};

/// An exact number: an unevaluated sum of parts with digits that do not overlap, smallest first (Shewchuk 1997).
#[derive(Clone, Debug, Default)]
pub struct Exact {
    parts: Vec<f64>,
}

impl Exact {
    /// Returns the exact sum of some numbers.
    pub fn sum(terms: impl IntoIterator<Item = f64>) -> Self {
        let mut sum = Self { parts: Vec::with_capacity(16) };
        sum.extend(terms);
        sum
    }

    /// Returns the parts whose sum is the number.
    pub fn parts(&self) -> &[f64] {
        &self.parts
    }

    /// Returns the terms of the exact product with another number.
    pub fn times<'e>(&'e self, other: &'e Self) -> impl Iterator<Item = f64> + 'e {
        let pairs = self.parts.iter().flat_map(|one| other.parts.iter().map(move |other| (*one, *other)));
        pairs.flat_map(|(one, other)| <[f64; 2]>::from(two_product(one, other)))
    }

    /// Returns the number rounded once to a double-double.
    pub fn rounded(&self) -> DoubleDouble {
        self.parts.iter().rev().fold(DoubleDouble::from(0.0), |sum, part| sum + DoubleDouble::from(*part))
    }
}

impl Extend<f64> for Exact {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, terms: T) {
        let parts = &mut self.parts;
        for term in terms {
            let (mut carry, mut kept) = (term, 0);
            for index in 0..parts.len() {
                let (sum, low) = two_sum(carry, parts[index]);
                if low != 0.0 {
                    parts[kept] = low;
                    kept += 1;
                }
                carry = sum;
            }
            parts.truncate(kept);
            if carry != 0.0 {
                parts.push(carry);
            }
        }
    }
}

/// Returns a sum, rounded once to a double-double. It is 0 only if the sum is exactly 0, regardless of cancellation.
pub fn exact_sum(terms: impl IntoIterator<Item = f64>) -> DoubleDouble {
    Exact::sum(terms).rounded()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_sums_lose_nothing() {
        assert_eq!(exact_sum([1e200, 1.0, -1e200, 1e-200, -1.0]), DoubleDouble::from(1e-200));
        assert_eq!(exact_sum([0.1, 0.2, -0.2, -0.1]), DoubleDouble::from(0.0));
        let DoubleDouble { high, low } = exact_sum([1e-40, 1e-20, 1.0, 1e40, -1e40]);
        assert_eq!((high, low), (1.0, 1e-20));
    }
}
