//! Where a ray meets a surface of the second degree.
//!
//! The polynomial along a ray comes from the ray's point closest to the middle of its two hits: neither the viewer nor the
//! place that the equation counts from need be near. Every number has a bound of its rounding. Where that could decide
//! whether there is a hit, which one is first or whether a box keeps it, all of it is done again in twice the precision.

mod exact;
mod fine;
mod quadric;
mod quick;
#[cfg(test)]
mod tests;

use crate::numeric::twofold::{Twofold, exponent_to_one, times_power_of_two, two_sum};
use glam::{DMat3, DVec3};
pub use quadric::Quadric;
use quick::Quick;

/// The part in a box of what solves `p·Sp + l·p + c = 0`.
///
/// Lengths are counted in a power of two of the world's, and the equation is multiplied by one, both such that its
/// numbers are around 1: that loses nothing, and their squares are neither too large nor too small.
#[derive(Clone, Debug)]
pub struct Quadratic {
    square: DMat3,
    linear: DVec3,
    constant: f64,
    /// The sums of the magnitudes of each row of `square`, or column: `|x|·|S||y|` is at most the root of the sums of
    /// `size x^2` and of `size y^2`, multiplied.
    sizes: DVec3,
    low: DVec3,
    high: DVec3,
    /// The power of two that a length of the world is multiplied by, as its exponent.
    exponent: i32,
    /// That power of two, and one over it.
    scale: f64,
    unscale: f64,
}

/// A ray, in the surface's own lengths and counted from its centre.
#[derive(Clone, Copy, Debug)]
pub struct OwnRay {
    from: [Twofold; 3],
    dir: DVec3,
}

/// What a number is off at most after about ten operations in twice the precision, against the size of its parts: each
/// makes less than 2^-102.
const FINE: f64 = 1.0 / (1_u128 << 98) as f64;

/// By what a component of a camera's direction may be off: three units of 2^-53.
const CAMERA: f64 = 1.5 * f64::EPSILON;

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
            Twofold { high: high * self.scale, low: low * self.scale }
        });
        OwnRay { from, dir }
    }

    /// The unit normal at a point of the world.
    pub fn normal(&self, at: DVec3, center: DVec3) -> DVec3 {
        let OwnRay { from, .. } = self.own(at, DVec3::ZERO, center);
        let place = DVec3::from(from.map(|part| part.high));
        let gradient = 2.0 * (self.square * place) + self.linear;
        let size = (2.0 * self.sizes * place.abs().max_element() + self.linear.abs()).max_element();
        if gradient.abs().max_element() > 1e-3 * size {
            return gradient.normalize();
        }
        // Near an apex, or between two planes that are almost one, its parts cancel.
        let turned = self.turned(from);
        let part = |axis: usize| turned[axis] + turned[axis] + Twofold::from(self.linear[axis]);
        let gradient = [part(0), part(1), part(2)].map(|part| part.high);
        let exponent = exponent_to_one(gradient.iter().fold(0.0, |most, part| part.abs().max(most)));
        let gradient = DVec3::from(gradient.map(|part| times_power_of_two(part, exponent)));
        // A cone's apex has none, and any will do; a plane that is there twice has this one.
        let longest = (0..3)
            .map(|axis| self.square.col(axis))
            .max_by(|one, other| one.length().total_cmp(&other.length()));
        gradient.try_normalize().or(longest.and_then(DVec3::try_normalize)).unwrap_or(DVec3::Y)
    }
}

/// The roots by the well-known formula, which the notes have: it loses digits, and double roots.
#[inline(always)]
fn classic_roots(a: f64, half_b: f64, c: f64) -> [f64; 2] {
    let b = 2.0 * half_b;
    if a == 0.0 {
        return [-c / b, f64::NAN];
    }
    let root = (b * b - 4.0 * a * c).sqrt();
    let (one, other) = ((-b - root) / (2.0 * a), (-b + root) / (2.0 * a));
    [one.min(other), one.max(other)]
}
