//! Values for the two sides of an object, and arithmetic of bounds that may be infinite.

use tabray_world::geometry::ray::Side;

/// A value for each side of an object: first the outside, to which the normal points.
pub(super) type Sides<T> = [T; 2];

pub(super) const SIDES: Sides<Side> = [Side::Outside, Side::Inside];

/// Returns the larger of two bounds; infinity if either is NaN.
pub(super) fn above(one: f64, other: f64) -> f64 {
    if one >= other {
        one
    } else if other.is_nan() || one.is_nan() {
        f64::INFINITY
    } else {
        other
    }
}

/// Multiplies a weight by an amount of light; 0 if either is 0, even if the other is infinite.
pub(super) fn gain(weight: f64, light: f64) -> f64 {
    if weight == 0.0 || light == 0.0 { 0.0 } else { weight * light }
}
