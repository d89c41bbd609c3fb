//! Placements: the position, size and rotation of a copy of a shape in world space.

use glam::{DMat3, DVec3};
use tabray_exact::scalar::{Scalar, cross, dot, per_axis};

/// π as the sum of four numbers, to within [`PI_ERROR`].
const PI: [f64; 4] = [
    std::f64::consts::PI,
    1.224_646_799_147_353_2e-16,
    -2.994_769_809_718_339_7e-33,
    1.112_454_220_863_365_3e-49,
];

/// A bound of the difference between π and the sum of [`PI`].
const PI_ERROR: f64 = 1e-64;

/// A rotation, counterclockwise as seen from the end of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rotation {
    /// Around x, then y, then z, by these angles in degrees.
    Angles(DVec3),
    /// Around an axis, a nonzero vector of any length, by an angle in degrees.
    Around {
        /// The axis.
        axis: DVec3,
        /// The angle.
        degrees: f64,
    },
}

impl Rotation {
    /// The rotation by 0 degrees.
    pub const NONE: Self = Self::Angles(DVec3::ZERO);

    /// Tells whether the axis has a direction, if there is one.
    pub fn has_axis(&self) -> bool {
        !matches!(self, Self::Around { axis: DVec3::ZERO, .. })
    }

    /// Returns the angles around x, y and z in degrees, if the rotation is given by them or around one of these axes.
    pub fn angles(self) -> Option<DVec3> {
        match self {
            Self::Angles(degrees) => Some(degrees),
            Self::Around { axis, degrees } => {
                let index = (0..3).find(|index| axis[*index] != 0.0)?;
                let along = DVec3::AXES[index] * axis[index];
                (along == axis).then(|| DVec3::AXES[index] * degrees * axis[index].signum())
            }
        }
    }
}

/// A scaling along the axes, then a rotation, and then a translation, in the numbers of the scene.
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
    /// Returns the rounded matrix that maps vectors from world space to the shape's own coordinates. Its transpose maps
    /// normals to world space, up to their length.
    pub fn to_object_space(&self) -> DMat3 {
        let own = |vector: DVec3| DVec3::from(self.vector::<f64>(vector.to_array()));
        DMat3::from_cols(own(DVec3::X), own(DVec3::Y), own(DVec3::Z))
    }

    /// Maps a point from world space to the shape's own coordinates.
    pub fn point<N: Scalar>(&self, at: [N; 3]) -> [N; 3] {
        self.vector(per_axis(|axis| at[axis] - N::constant(self.translation[axis])))
    }

    /// Maps a vector from world space to the shape's own coordinates.
    pub fn vector<N: Scalar>(&self, vector: [N; 3]) -> [N; 3] {
        let [x, y, z] = match (self.rotation.angles(), self.rotation) {
            (None, Rotation::Around { axis, degrees }) => turned_back_around(axis, degrees, vector),
            (angles, _) => {
                let (angles, [x, y, z]) = (angles.unwrap_or_default(), vector);
                let (x, y) = turned_back(angles.z, x, y);
                let (z, x) = turned_back(angles.y, z, x);
                let (y, z) = turned_back(angles.x, y, z);
                [x, y, z]
            }
        };
        let part = |part: N, scale: f64| if scale == 1.0 { part } else { part / N::constant(scale) };
        [part(x, self.scale.x), part(y, self.scale.y), part(z, self.scale.z)]
    }
}

/// Rotates a vector in a plane clockwise, by an angle in degrees.
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

/// Rotates a vector clockwise around an axis, a nonzero vector of any length, by an angle in degrees.
fn turned_back_around<N: Scalar>(axis: DVec3, degrees: f64, vector: [N; 3]) -> [N; 3] {
    // Scaling by a power of two keeps the squares in range.
    let exponent = libm::ilogb(axis.abs().max_element());
    let axis = per_axis(|index| N::constant(libm::scalbn(axis[index], -exponent)));
    let length = dot(axis, axis).sqrt();
    let axis = axis.map(|part| part / length);
    let (cos, sin) = turned_back(-degrees, N::constant(1.0), N::constant(0.0));
    let (along, across) = (dot(axis, vector) * (N::constant(1.0) - cos), cross(vector, axis));
    per_axis(|index| cos * vector[index] + sin * across[index] + along * axis[index])
}

/// Converts an angle from degrees to radians.
pub(crate) fn radians<N: Scalar>(degrees: f64) -> N {
    let [a, b, c, d] = PI;
    let half_turn = N::constant(a) + (N::constant(b) + (N::constant(c) + N::about(d, PI_ERROR)));
    N::constant(degrees) * half_turn / N::constant(180.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use tabray_exact::interval::{Float, Interval, Wide};

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
                rotation: Rotation::Angles(DVec3::new(0.0, 90.0 * f64::from(turns), 0.0)),
                translation: DVec3::ZERO,
            };
            let own = placement.to_object_space() * DVec3::X;
            let expected = [DVec3::X, 0.25 * DVec3::Z, -DVec3::X, -0.25 * DVec3::Z];
            assert_eq!(own, expected[turns.rem_euclid(4) as usize], "{turns}");
        }
    }

    fn around(axis: DVec3, degrees: f64) -> Placement {
        let rotation = Rotation::Around { axis, degrees };
        Placement { scale: DVec3::ONE, rotation, translation: DVec3::ZERO }
    }

    #[test]
    fn a_rotation_around_x_y_or_z_is_the_one_by_an_angle() {
        for (index, axis) in DVec3::AXES.into_iter().enumerate() {
            for (length, degrees) in [(1.0, 30.0), (-4.0, 30.0), (1e300, -123.4), (-5e-324, 90.0)] {
                let mut angles = DVec3::ZERO;
                angles[index] = degrees * f64::signum(length);
                let placement = around(length * axis, degrees);
                let expected = Placement { rotation: Rotation::Angles(angles), ..placement };
                assert_eq!(
                    placement.to_object_space(),
                    expected.to_object_space(),
                    "{axis} {length} {degrees}"
                );
            }
        }
    }

    #[test]
    fn a_rotation_around_any_axis_is_that_of_a_quaternion() {
        let mut axes = vec![DVec3::ONE, DVec3::new(1e200, 2e200, -3e200), DVec3::new(3e-310, 0.0, 4e-310)];
        axes.extend(
            (0..50).map(|n| DVec3::new(f64::from(n).sin(), f64::from(2 * n).cos(), f64::from(n % 7) - 3.0)),
        );
        for (n, axis) in axes.into_iter().enumerate() {
            let degrees = 37.0 * n as f64 - 400.0;
            let long = axis / axis.abs().max_element();
            let quaternion = DQuat::from_axis_angle(long.normalize(), degrees.to_radians());
            let to_world = around(axis, degrees).to_object_space().transpose();
            assert!(to_world.abs_diff_eq(DMat3::from_quat(quaternion), 4e-15), "{axis} {degrees}");
        }
    }

    #[test]
    fn a_rotation_around_any_axis_is_enclosed() {
        let axis = DVec3::new(1.0, -2.0, 2.0);
        let there = |vector, degrees| around(axis, degrees).vector::<Wide>(vector);
        let vector = [0.1, 0.7, -3.0].map(Wide::constant);
        // The vector is rotated by a third of a turn, three times.
        let back = (0..3).fold(vector, |vector, _| there(vector, 120.0));
        let along = there([1.0, -2.0, 2.0].map(Wide::constant), 77.0);
        for axis_of in 0..3 {
            assert!((back[axis_of] - vector[axis_of]).has_zero() && back[axis_of].width().to_f64() < 1e-58);
            assert!((along[axis_of] - Wide::constant(axis[axis_of])).has_zero(), "the axis stays");
        }
    }
}
