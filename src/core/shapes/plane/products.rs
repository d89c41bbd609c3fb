//! The quotients of dot products that cancel, and what rounding makes of them.

use crate::geometry::ray::MISS;

/// The dot products whose quotient is the distance of an intersection, in plain arithmetic.
pub(super) struct Products {
    /// The dot product of the normal and the vector from the ray's origin to the plane's point, and the sum of the
    /// absolute values of its terms.
    pub away: f64,
    pub away_size: f64,
    /// The dot product of the normal and the ray's direction, and the sum of the absolute values of its terms.
    pub toward: f64,
    pub toward_size: f64,
}

/// Returns the quotient of two dot products computed by [`dot`](tabray_exact::double_double::dot), each given with the
/// size of its terms. The result is [`MISS`] where the divisor is 0, and NaN where a dot product is less than 2^-44 of
/// its terms: it could then be off by more than half an ulp, or have the other sign.
#[inline(always)]
pub(super) fn quotient((away, away_size): (f64, f64), (toward, toward_size): (f64, f64)) -> f64 {
    const MAX_RATIO: f64 = (1_u64 << 44) as f64;
    let is_doubtful = (away_size > MAX_RATIO * away.abs()) | (toward_size > MAX_RATIO * toward.abs());
    let distance = if toward == 0.0 { MISS } else { away / toward };
    if is_doubtful { f64::NAN } else { distance }
}

impl Products {
    /// Returns the [`quotient`] of dot products computed with compensation.
    #[inline(always)]
    pub fn quotient(&self, away: f64, toward: f64) -> f64 {
        quotient((away, self.away_size), (toward, self.toward_size))
    }

    /// Returns the quotient of the dot products in plain arithmetic; NaN where one is less than 1/64 of its terms.
    #[inline(always)]
    pub fn plain_quotient(&self) -> f64 {
        const MAX_RATIO: f64 = 64.0;
        let is_doubtful = (self.away_size > MAX_RATIO * self.away.abs())
            | (self.toward_size > MAX_RATIO * self.toward.abs());
        let distance = if self.toward == 0.0 { MISS } else { self.away / self.toward };
        if is_doubtful { f64::NAN } else { distance }
    }

    /// Returns whether so much of `away` cancels that it should be computed with compensation.
    #[inline(always)]
    pub fn away_cancels(&self) -> bool {
        self.away_size > 1.3 * self.away.abs()
    }

    /// Returns whether so much of `toward` cancels that it should be computed with compensation.
    #[inline(always)]
    pub fn toward_cancels(&self) -> bool {
        self.toward_size > 1.3 * self.toward.abs()
    }
}

/// The `toward` below which a ray is parallel to the plane to within rounding: 34 units of 2^-53, more than three times
/// the error of 9 that [`rough`](super::Plane::rough) derives.
pub(super) const MIN_TOWARD: f64 = 17.0 * f64::EPSILON;

/// A bound of the relative error of [`reciprocal`]. The initial guess is off by at most 2^-23, two roundings to single
/// precision; a step of Newton's method squares that.
pub(super) const RECIPROCAL_ERROR: f64 = 1.0 / (1_u64 << 44) as f64;

/// Returns the reciprocal of a number in the range of single precision, to within a few ulps: one step of Newton's
/// method from the reciprocal in single precision, which takes a third of the time of a division.
#[inline(always)]
pub(super) fn reciprocal(of: f64) -> f64 {
    let start = f64::from(1.0 / of as f32);
    start * (2.0 - of * start)
}
