//! Copies of shapes in other places: rays in a shape's own coordinates.

use super::dyadic::Dyadic;
use super::number::Number;
use super::ray::{Ray, minus};
use super::text::Vector;
use super::wide::Wide;

/// The significant bits of sines, cosines, roots and quotients. Of a rotation by other than right angles, nothing is exact,
/// and a ray that meets an edge to within 2^-300 is taken to pass on one side.
pub const BITS: i64 = 400;

/// A scaling along the axes, then rotations around x, y and z, then a translation.
pub struct Place {
    pub scale: Vector,
    /// The sines and the cosines of the angles.
    turns: [[Dyadic; 2]; 3],
    pub translation: Vector,
}

impl Place {
    /// `rotation` is in degrees.
    pub fn new(scale: Vector, rotation: &Vector, translation: Vector) -> Self {
        Self { scale, turns: [0, 1, 2].map(|axis| sin_cos(&rotation[axis])), translation }
    }

    /// Returns a ray in the shape's own coordinates. Its places are those of the ray in the world.
    pub fn own(&self, ray: &Ray) -> Ray {
        let origin = self.own_vector(minus(&ray.origin, &self.translation));
        Ray { origin, dir: self.own_vector(ray.dir.clone()), length: Wide::int(1), ..ray.clone() }
    }

    fn own_vector(&self, mut of: Vector) -> Vector {
        for (axis, [sin, cos]) in self.turns.iter().enumerate().rev() {
            let (one, other) = ((axis + 1) % 3, (axis + 2) % 3);
            let (a, b) = (of[one].clone(), of[other].clone());
            of[one] = cos.mul(&a).add(&sin.mul(&b));
            of[other] = cos.mul(&b).sub(&sin.mul(&a));
        }
        [0, 1, 2].map(|axis| of[axis].divided(&self.scale[axis], BITS, false))
    }

    /// Takes a normal from the shape's own coordinates to the world, roughly and up to its length.
    pub fn world_normal(&self, normal: [f64; 3]) -> [f64; 3] {
        let mut of = [0, 1, 2].map(|axis| normal[axis] / self.scale[axis].to_f64(false));
        for (axis, turn) in self.turns.iter().enumerate() {
            let [sin, cos] = turn.each_ref().map(|of| of.to_f64(false));
            let (one, other) = ((axis + 1) % 3, (axis + 2) % 3);
            (of[one], of[other]) = (cos * of[one] - sin * of[other], cos * of[other] + sin * of[one]);
        }
        of
    }
}

/// Returns the sine and the cosine of an angle in degrees.
pub fn sin_cos(degrees: &Dyadic) -> [Dyadic; 2] {
    let quarters = degrees.to_f64(false) / 90.0;
    let exact = |sin, cos| [Dyadic::int(sin), Dyadic::int(cos)];
    if quarters.fract() == 0.0 {
        return match quarters.rem_euclid(4.0) as u8 {
            0 => exact(0, 1),
            1 => exact(1, 0),
            2 => exact(0, -1),
            _ => exact(-1, 0),
        };
    }
    let radians = Wide::half_turn().mul(&Wide::exact(degrees)).div(&Wide::int(180));
    let (sin, cos) = radians.sin_cos();
    [sin.low_end(), cos.low_end()]
}
