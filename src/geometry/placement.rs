//! Placements: where a copy of a shape lies in the world.

use crate::numeric::scalar::{Scalar, per_axis};
use glam::{DMat3, DVec3};

/// π as a sum: of four numbers, the last of which is known to [`PI_ERROR`].
const PI: [f64; 4] = [
    std::f64::consts::PI,
    1.224_646_799_147_353_2e-16,
    -2.994_769_809_718_339_7e-33,
    1.112_454_220_863_365_3e-49,
];

/// A bound on what [`PI`] lacks.
const PI_ERROR: f64 = 1e-64;

/// A rotation around x, then y, then z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rotation {
    /// The angles in degrees, counterclockwise as seen from the axis's end.
    pub degrees: DVec3,
}

impl Rotation {
    /// The rotation that turns nothing.
    pub const NONE: Self = Self { degrees: DVec3::ZERO };
}

/// A scaling along the axes, then a rotation around x, then y, then z, and then a translation, as the scene gives them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The scale factors along the shape's own axes, all positive.
    pub scale: DVec3,
    /// The rotation.
    pub rotation: Rotation,
    /// The position of the shape's own origin, in world coordinates.
    pub translation: DVec3,
}

impl Placement {
    /// Returns the matrix that takes a vector from the world to the shape's own coordinates, rounded. Its transpose takes
    /// normals to the world, up to their length.
    pub fn to_own(&self) -> DMat3 {
        let own = |vector: DVec3| DVec3::from(self.vector::<f64>(vector.to_array()));
        DMat3::from_cols(own(DVec3::X), own(DVec3::Y), own(DVec3::Z))
    }

    /// Takes a point from the world to the shape's own coordinates.
    pub fn point<N: Scalar>(&self, at: [N; 3]) -> [N; 3] {
        self.vector(per_axis(|axis| at[axis] - N::constant(self.translation[axis])))
    }

    /// Takes a vector from the world to the shape's own coordinates.
    pub fn vector<N: Scalar>(&self, vector: [N; 3]) -> [N; 3] {
        let [x, y, z] = vector;
        let (x, y) = turned_back(self.rotation.degrees.z, x, y);
        let (z, x) = turned_back(self.rotation.degrees.y, z, x);
        let (y, z) = turned_back(self.rotation.degrees.x, y, z);
        let part = |part: N, scale: f64| if scale == 1.0 { part } else { part / N::constant(scale) };
        [part(x, self.scale.x), part(y, self.scale.y), part(z, self.scale.z)]
    }
}

/// Rotates a vector of a plane clockwise, by an angle in degrees.
fn turned_back<N: Scalar>(degrees: f64, x: N, y: N) -> (N, N) {
    // The remainder is exact.
    let degrees = degrees % 360.0;
    match degrees.rem_euclid(360.0) {
        _ if degrees == 0.0 => (x, y),
        90.0 if degrees % 90.0 == 0.0 => (y, -x),
        180.0 if degrees % 90.0 == 0.0 => (-x, -y),
        270.0 if degrees % 90.0 == 0.0 => (-y, x),
        _ => {
            let (sin, cos) = radians::<N>(degrees).sin_cos();
            (cos * x + sin * y, cos * y - sin * x)
        }
    }
}

/// Returns an angle in radians that is given in degrees.
pub(crate) fn radians<N: Scalar>(degrees: f64) -> N {
    let [a, b, c, d] = PI;
    let half_turn = N::constant(a) + (N::constant(b) + (N::constant(c) + N::about(d, PI_ERROR)));
    N::constant(degrees) * half_turn / N::constant(180.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::interval::{Float, Interval, Wide};

    #[test]
    fn half_a_turn_is_enclosed() {
        // The sine of 30 degrees is a half.
        let (cos, sin) = turned_back(-30.0, Wide::constant(1.0), Wide::constant(0.0));
        assert!((sin - Wide::constant(0.5)).has_zero() && (cos * cos - Wide::constant(0.75)).has_zero());
        assert!(sin.width().to_f64() < 1e-60, "{sin:?}");
        let (_, sin) = turned_back(-30.0, Interval::<f64>::constant(1.0), Interval::constant(0.0));
        assert!((sin - Interval::constant(0.5)).has_zero() && sin.width() < 1e-14, "{sin:?}");
    }

    #[test]
    fn right_angles_are_exact() {
        for turns in -9..=9_i32 {
            let placement = Placement {
                scale: DVec3::new(1.0, 2.0, 4.0),
                rotation: Rotation { degrees: DVec3::new(0.0, 90.0 * f64::from(turns), 0.0) },
                translation: DVec3::ZERO,
            };
            let own = placement.to_own() * DVec3::X;
            let expected = [DVec3::X, 0.25 * DVec3::Z, -DVec3::X, -0.25 * DVec3::Z];
            assert_eq!(own, expected[turns.rem_euclid(4) as usize], "{turns}");
        }
    }
}
