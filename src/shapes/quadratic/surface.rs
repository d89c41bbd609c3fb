//! A quadric scaled for the solver, and rays in its coordinates.

use glam::{DMat3, DVec3};
use tabray_exact::double_double::{DoubleDouble, exponent_to_one, times_power_of_two, two_sum};
use tabray_exact::scalar::per_axis;

/// The part of the quadric `p·Sp + l·p + c = 0` in a box, scaled.
///
/// Lengths are multiplied by one power of two and the equation by another, which brings its numbers to about 1. This
/// loses no digits, and keeps squares from overflow and underflow.
#[derive(Clone, Debug)]
pub struct Quadratic {
    pub(super) square: DMat3,
    pub(super) linear: DVec3,
    pub(super) constant: f64,
    /// The sums of the magnitudes of each row, or column, of `square`: `|x|·|S||y|` is at most the square root of the
    /// product of the sums of `size x^2` and of `size y^2`.
    pub(super) sizes: DVec3,
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    /// The exponent of `scale`.
    pub(super) exponent: i32,
    /// The power of two that converts lengths from world units, and its reciprocal.
    pub(super) scale: f64,
    pub(super) unscale: f64,
}

/// A ray in the quadric's own unit of length, relative to its center.
#[derive(Clone, Copy, Debug)]
pub struct OwnRay {
    pub(super) from: [DoubleDouble; 3],
    pub(super) dir: DVec3,
}

/// A bound of the relative error of about ten operations in double-double arithmetic. The error of each is less than
/// 2^-102 of its terms.
pub(super) const DD_ERROR: f64 = 1.0 / (1_u128 << 98) as f64;

impl Quadratic {
    /// Returns the quadric `Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J`, clipped by a box.
    pub fn new(coefficients: [f64; 10], low: DVec3, high: DVec3) -> Self {
        let exponent_of = |of: &[f64]| {
            let largest = of.iter().fold(0.0, |largest: f64, part| largest.max(part.abs()));
            (largest != 0.0).then(|| -exponent_to_one(largest))
        };
        let (square, linear) = (exponent_of(&coefficients[..6]), exponent_of(&coefficients[6..9]));
        let constant = exponent_of(&coefficients[9..]);
        // At this length, two of the three terms are about equal.
        let length = match (square, linear, constant) {
            (Some(square), linear, constant) => {
                let of_linear = linear.map(|linear| linear - square);
                of_linear.max(constant.map(|constant| (constant - square) / 2))
            }
            (None, Some(linear), Some(constant)) => Some(constant - linear),
            _ => None,
        };
        // Lengths of 1e150 and 1e-150 become numbers of 1e90 and 1e-90, and their squares neither overflow nor
        // underflow.
        let length = length.unwrap_or(0).clamp(-200, 200);
        let sizes = [square.map(|of| of + 2 * length), linear.map(|of| of + length), constant];
        let factor = -sizes.into_iter().flatten().max().unwrap_or(0);
        let of_square = |index: usize| times_power_of_two(coefficients[index], factor + 2 * length);
        let half_of_square = |index: usize| times_power_of_two(coefficients[index], factor + 2 * length - 1);
        let of_linear = |index: usize| times_power_of_two(coefficients[index], factor + length);
        let square = DMat3::from_cols(
            DVec3::new(of_square(0), half_of_square(3), half_of_square(4)),
            DVec3::new(half_of_square(3), of_square(1), half_of_square(5)),
            DVec3::new(half_of_square(4), half_of_square(5), of_square(2)),
        );
        let own = |of: DVec3| DVec3::from(of.to_array().map(|part| times_power_of_two(part, -length)));
        Self {
            square,
            linear: DVec3::new(of_linear(6), of_linear(7), of_linear(8)),
            constant: -times_power_of_two(coefficients[9], factor),
            sizes: square.x_axis.abs() + square.y_axis.abs() + square.z_axis.abs(),
            low: own(low),
            high: own(high),
            exponent: -length,
            scale: times_power_of_two(1.0, -length),
            unscale: times_power_of_two(1.0, length),
        }
    }

    /// Converts a ray in world space to the quadric's own unit of length, relative to its center.
    #[inline(always)]
    pub fn own(&self, origin: DVec3, dir: DVec3, center: DVec3) -> OwnRay {
        let from = per_axis(|axis| {
            let (high, low) = two_sum(origin[axis], -center[axis]);
            DoubleDouble { high: high * self.scale, low: low * self.scale }
        });
        OwnRay { from, dir }
    }
}
