//! Vectors of double-double numbers, and their products.

use super::exact::exact_sum;
use super::{DoubleDouble, exponent_to_one, power_of_two, times_power_of_two, two_product, two_sum};

/// Returns the dot product of two vectors.
#[inline(always)]
pub fn product(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the cross product of two vectors. Each component is rounded once, regardless of cancellation.
#[inline]
pub fn cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    quick_cross(a, b).unwrap_or_else(|| exact_cross(a, b))
}

/// Returns the cross product of two vectors of plain numbers if each component is exactly a double-double, the common
/// case, and otherwise `None`.
#[inline]
fn quick_cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> Option<[DoubleDouble; 3]> {
    let is_plain = |of: [DoubleDouble; 3]| (of[0].low == 0.0) & (of[1].low == 0.0) & (of[2].low == 0.0);
    if !is_plain(a) | !is_plain(b) {
        return None;
    }
    let (product, lost) = plain_cross([a[0].high, a[1].high, a[2].high], [b[0].high, b[1].high, b[2].high]);
    (lost == 0.0).then_some(product)
}

/// Returns the cross product of two vectors, and the sum of the magnitudes of the errors of its components. If that sum
/// is 0, each component is exactly a double-double.
#[inline(always)]
pub fn plain_cross(a: [f64; 3], b: [f64; 3]) -> ([DoubleDouble; 3], f64) {
    let part = |one: usize, other: usize| {
        let (plus, plus_low) = two_product(a[one], b[other]);
        let (minus, minus_low) = two_product(-a[other], b[one]);
        let (sum, of_sum) = two_sum(plus, minus);
        let (lows, of_lows) = two_sum(plus_low, minus_low);
        let (low, of_low) = two_sum(of_sum, lows);
        let (high, low) = two_sum(sum, low);
        (DoubleDouble { high, low }, of_lows.abs() + of_low.abs())
    };
    let ((x, x_lost), (y, y_lost), (z, z_lost)) = (part(1, 2), part(2, 0), part(0, 1));
    ([x, y, z], x_lost + y_lost + z_lost)
}

#[inline(never)]
fn exact_cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let parts = |of: DoubleDouble, with: DoubleDouble| {
        let pairs = [(of.high, with.high), (of.high, with.low), (of.low, with.high), (of.low, with.low)];
        pairs.into_iter().flat_map(|(one, other)| <[f64; 2]>::from(two_product(one, other)))
    };
    [(1, 2), (2, 0), (0, 1)].map(|(one, other)| {
        let (plus, minus) = (parts(a[one], b[other]), parts(-a[other], b[one]));
        exact_sum(plus.chain(minus))
    })
}

/// Returns the triple product of three vectors, rounded once. Its sign gives their orientation, and it is 0 exactly if
/// they are coplanar.
pub fn triple_product(a: [DoubleDouble; 3], b: [DoubleDouble; 3], c: [DoubleDouble; 3]) -> DoubleDouble {
    let parts = |of: DoubleDouble, with: DoubleDouble, factor: DoubleDouble| {
        let pairs = [(of.high, with.high), (of.high, with.low), (of.low, with.high), (of.low, with.low)];
        let products = pairs.into_iter().flat_map(|(one, other)| <[f64; 2]>::from(two_product(one, other)));
        products.flat_map(move |product| {
            let factors = [factor.high, factor.low].into_iter().filter(|factor| *factor != 0.0);
            factors.flat_map(move |factor| <[f64; 2]>::from(two_product(product, factor)))
        })
    };
    exact_sum([(1, 2, 0), (2, 0, 1), (0, 1, 2)].into_iter().flat_map(|(one, other, last)| {
        parts(a[one], b[other], c[last]).chain(parts(-a[other], b[one], c[last]))
    }))
}

/// Returns a vector scaled by a power of two to a largest component between 1/2 and 1.
#[inline]
pub fn scaled_to_one(vector: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let exponent = exponent_to_one(vector.iter().fold(0.0, |largest, part| part.high.abs().max(largest)));
    let scaled = |DoubleDouble { high, low }: DoubleDouble| DoubleDouble {
        high: times_power_of_two(high, exponent),
        low: times_power_of_two(low, exponent),
    };
    [scaled(vector[0]), scaled(vector[1]), scaled(vector[2])]
}

/// Returns the unit vector along a vector with components of magnitudes around 1.
pub fn unit(vector: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let length = product(vector, vector).sqrt();
    vector.map(|part| part / length)
}

/// Returns the components of [`unit()`], each rounded to a plain number.
#[inline]
pub fn rounded_unit(vector: [DoubleDouble; 3]) -> [f64; 3] {
    let length = product(vector, vector).sqrt();
    let inverse = reciprocal(length);
    let rounded = |part: DoubleDouble| {
        let DoubleDouble { high, low } = part * inverse;
        // The errors of the product and of the inverse are a few 2^-104, and so is that of the quotient. If this error
        // does not change the rounding of either, both are rounded to the same number.
        let error = power_of_two(-98) * high.abs();
        let is_certain = high + (low - error) == high && high + (low + error) == high;
        if is_certain && part.high.abs() > 1e-200 { high } else { (part / length).high }
    };
    [rounded(vector[0]), rounded(vector[1]), rounded(vector[2])]
}

/// Returns the reciprocal of a length, with a relative error of a few 2^-104.
#[inline(always)]
fn reciprocal(length: DoubleDouble) -> DoubleDouble {
    let first = 1.0 / length.high;
    let rest = DoubleDouble::from(1.0) - length * DoubleDouble::from(first);
    DoubleDouble::normal(first, rest.high * first)
}

/// Computes [`rounded_unit`] without branches, and returns whether the result is certain.
#[inline(always)]
pub fn quick_unit(vector: [DoubleDouble; 3]) -> ([f64; 3], bool) {
    let square = product(vector, vector);
    let root = DoubleDouble::from(square.high.sqrt());
    let rest = square - root * root;
    let inverse = reciprocal(root + DoubleDouble::from(rest.high / (2.0 * root.high)));
    let rounded = |part: DoubleDouble| {
        let DoubleDouble { high, low } = part * inverse;
        let error = power_of_two(-98) * high.abs();
        let is_certain = (high + (low - error) == high) & (high + (low + error) == high);
        (high, is_certain & (part.high.abs() > 1e-200))
    };
    let ((x, is_x), (y, is_y), (z, is_z)) = (rounded(vector[0]), rounded(vector[1]), rounded(vector[2]));
    ([x, y, z], is_x & is_y & is_z & (square.high > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a pseudorandom number from -1 to 1, with zeros and few digits among them.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let number = (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        match *state >> 32 & 7 {
            0 => 0.0,
            1 => f64::from(number as f32),
            2 => 1e-9 * number,
            _ => number,
        }
    }

    #[test]
    fn quick_cross_products_are_the_exact_ones() {
        let (mut state, mut quick) = (1, 0);
        for _ in 0..10_000 {
            let a = [(); 3].map(|()| DoubleDouble::from(random(&mut state)));
            let mut b = [(); 3].map(|()| DoubleDouble::from(random(&mut state)));
            if state >> 40 & 1 == 0 {
                // Nearly all cancels.
                b = a.map(|part| DoubleDouble::from(3.0 * part.high));
            }
            if let Some(product) = quick_cross(a, b) {
                assert_eq!(product, exact_cross(a, b), "{a:?} x {b:?}");
                quick += 1;
            }
        }
        assert!(quick > 5000, "{quick}");
    }

    #[test]
    fn rounded_units_are_units_that_are_rounded() {
        let mut state = 7;
        for _ in 0..10_000 {
            let vector = [(); 3].map(|()| {
                let (high, low) = two_sum(random(&mut state), 1e-17 * random(&mut state));
                DoubleDouble { high, low }
            });
            if vector.iter().any(|part| part.high != 0.0) {
                assert_eq!(rounded_unit(vector), unit(vector).map(|part| part.high), "{vector:?}");
            }
        }
    }
}
