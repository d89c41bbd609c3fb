//! Roots of quadratic equations, without cancellation.

use crate::twofold::{Twofold, two_product};

/// The roots of `a t^2 + 2 b t + c`, the lesser first; NaN where there is none. One that is twice there is there
/// twice, and an equation that is straight has one.
///
/// The root that the well-known formula would cancel comes from the product of both, `c / a`; a discriminant that
/// rounding could turn is taken in twice the precision.
#[inline(always)]
pub fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    if a == 0.0 {
        return [-c / (2.0 * b), f64::NAN];
    }
    let (square, product) = (b * b, a * c);
    let mut discriminant = square - product;
    if discriminant.abs() <= 8.0 * f64::EPSILON * square {
        let twofold = |(high, low)| Twofold { high, low };
        discriminant = (twofold(two_product(b, b)) - twofold(two_product(a, c))).high;
    }
    // The root of a negative number is NaN, and so are then both.
    let root = discriminant.sqrt();
    let larger = if b > 0.0 { -b - root } else { root - b };
    let (one, other) = (larger / a, c / larger);
    // Both are 0 where b and c are.
    let other = if larger == 0.0 { 0.0 } else { other };
    if one < other { [one, other] } else { [other, one] }
}

/// The roots by the well-known formula, which the notes have: it loses digits, and double roots.
#[inline(always)]
pub fn classic_roots(a: f64, half_b: f64, c: f64) -> [f64; 2] {
    let b = 2.0 * half_b;
    if a == 0.0 {
        return [-c / b, f64::NAN];
    }
    let root = (b * b - 4.0 * a * c).sqrt();
    let (one, other) = ((-b - root) / (2.0 * a), (-b + root) / (2.0 * a));
    [one.min(other), one.max(other)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_roots_keep_all_their_digits() {
        // (t - 1e-8) (t - 1e8): the well-known formula gives 1.49e-8 for the first.
        let [near, far] = roots(1.0, -0.5 * (1e8 + 1e-8), 1.0);
        assert!((near - 1e-8).abs() < 1e-23 && (far - 1e8).abs() < 1e-7, "{near:e} {far:e}");
        let [near, _] = classic_roots(1.0, -0.5 * (1e8 + 1e-8), 1.0);
        assert!((near - 1e-8).abs() > 1e-9, "{near:e}");
        assert_eq!(roots(2.0, 0.0, -8.0), [-2.0, 2.0]);
        assert_eq!(roots(1.0, -3.0, 9.0), [3.0, 3.0]);
        assert_eq!(roots(1.0, 0.0, 0.0), [0.0, 0.0]);
        assert_eq!(roots(-1.0, 2.0, 0.0), [0.0, 4.0]);
        assert!(roots(1.0, 0.0, 1.0).iter().all(|root| root.is_nan()));
        assert_eq!(roots(0.0, 2.0, -8.0)[0], 2.0);
        assert!(roots(0.0, 0.0, 1.0).iter().all(|root| !root.is_finite()));
    }

    #[test]
    fn near_double_roots_are_there() {
        // b^2 and a c agree in all the digits that one of them has.
        let b = 94_906_267.0; // b^2 - 1 is no f64 any more
        let [near, far] = roots(1.0, -b, b * b - 1.0);
        assert!(near.is_finite() && far.is_finite());
    }
}
