//! Quotients of dot products that may cancel, and their rounding errors.

use tabray_world::geometry::ray::MISS;

/// Two dot products in plain arithmetic. Their quotient is the distance of a hit.
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
/// size of its terms. The result is [`MISS`] if the divisor is 0. It is NaN if a dot product is less than 2^-44 of its
/// terms, because its error may exceed half an ulp, or its sign may be wrong.
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

    /// Returns the quotient of the dot products in plain arithmetic, or NaN if one is less than 1/64 of its terms.
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

/// The minimum `toward` for a ray that is not parallel to the plane up to rounding: 34 units of 2^-53, more than three
/// times the error of 9 that [`rough_crossing`](super::Plane::rough_crossing) derives.
pub(super) const MIN_TOWARD: f64 = 17.0 * f64::EPSILON;

/// A bound of the relative error of [`reciprocal`]. The error of the initial guess is at most 2^-23, two roundings to
/// single precision. A Newton step squares it.
pub(super) const RECIPROCAL_ERROR: f64 = 1.0 / (1_u64 << 44) as f64;

/// Returns the reciprocal of a number in the range of single precision, with an error of a few ulps: a Newton step from
/// the reciprocal in single precision. This takes a third of the time of a division.
#[inline(always)]
pub(super) fn reciprocal(of: f64) -> f64 {
    let start = f64::from(1.0 / of as f32);
    start * (2.0 - of * start)
}
