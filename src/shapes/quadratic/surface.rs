//! The surface, and a ray that is counted as it is.

use crate::numeric::double_double::{DoubleDouble, exponent_to_one, times_power_of_two, two_sum};
use glam::{DMat3, DVec3};

/// The part in a box of what solves `p·Sp + l·p + c = 0`.
///
/// Lengths are counted in a power of two of the world's, and the equation is multiplied by one, both such that its
/// numbers are around 1: that loses nothing, and their squares are neither too large nor too small.
#[derive(Clone, Debug)]
pub struct Quadratic {
    pub(super) square: DMat3,
    pub(super) linear: DVec3,
    pub(super) constant: f64,
    /// The sums of the magnitudes of each row of `square`, or column: `|x|·|S||y|` is at most the root of the sums of
    /// `size x^2` and of `size y^2`, multiplied.
    pub(super) sizes: DVec3,
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    /// The power of two that a length of the world is multiplied by, as its exponent.
    pub(super) exponent: i32,
    /// That power of two, and one over it.
    pub(super) scale: f64,
    pub(super) unscale: f64,
}

/// A ray, in the surface's own lengths and counted from its centre.
#[derive(Clone, Copy, Debug)]
pub struct OwnRay {
    pub(super) from: [DoubleDouble; 3],
    pub(super) dir: DVec3,
}

/// What a number is off at most after about ten operations in twice the precision, against the size of its parts: each
/// makes less than 2^-102.
pub(super) const FINE: f64 = 1.0 / (1_u128 << 98) as f64;

impl Quadratic {
    /// The surface with `Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J`, kept in a box.
    pub fn new(coefficients: [f64; 10], low: DVec3, high: DVec3) -> Self {
        let exponent_of = |of: &[f64]| {
            let most = of.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
            (most != 0.0).then(|| -exponent_to_one(most))
        };
        let (square, linear) = (exponent_of(&coefficients[..6]), exponent_of(&coefficients[6..9]));
        let constant = exponent_of(&coefficients[9..]);
        // The lengths at which two of the three parts are about the same.
        let length = match (square, linear, constant) {
            (Some(square), linear, constant) => {
                let of_linear = linear.map(|linear| linear - square);
                of_linear.max(constant.map(|constant| (constant - square) / 2))
            }
            (None, Some(linear), Some(constant)) => Some(constant - linear),
            _ => None,
        };
        // Of a length of 1e150 the square of what is left is still a number, and of one of 1e-150.
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

    /// A ray of the world in the surface's own lengths, from its centre.
    #[inline(always)]
    pub fn own(&self, origin: DVec3, dir: DVec3, center: DVec3) -> OwnRay {
        let from = [0, 1, 2].map(|axis| {
            let (high, low) = two_sum(origin[axis], -center[axis]);
            DoubleDouble { high: high * self.scale, low: low * self.scale }
        });
        OwnRay { from, dir }
    }
}
