//! The placement of a mesh: scale, rotation and translation.

use glam::{DMat3, DVec3};
use tabray_world::geometry::placement::{Placement, Rotation};

/// A scaling along the axes, followed by a rotation and a translation.
#[derive(Clone, Copy, Debug)]
pub struct ToWorld {
    /// Rotation and scale.
    linear: DMat3,
    /// The inverse transpose of `linear`, times a number.
    of_normals: DMat3,
    translation: DVec3,
    /// Whether there is neither a rotation nor a scale, and coordinates keep their digits.
    is_plain: bool,
}

impl ToWorld {
    /// Makes a placement.
    pub fn new(scale: DVec3, rotation: Rotation, translation: DVec3) -> Self {
        let (rotation, least) = (turned(rotation), scale.abs().min_element());
        let linear = rotation * DMat3::from_diagonal(scale);
        let of_normals = rotation * DMat3::from_diagonal(least / scale);
        Self { linear, of_normals, translation, is_plain: linear == DMat3::IDENTITY }
    }

    /// Transforms a point of a file to world coordinates.
    pub fn place(&self, at: DVec3) -> DVec3 {
        let turned = if self.is_plain { at } else { self.linear * at };
        // The sum turns -0 into 0, which gives equal coordinates equal bits.
        turned + self.translation + 0.0
    }

    /// Transforms a normal of a file to world coordinates, with another length.
    pub fn place_normal(&self, normal: DVec3) -> DVec3 {
        self.of_normals * normal
    }

    /// Tells whether points stay where they are.
    pub fn is_identity(&self) -> bool {
        self.is_plain && self.translation == DVec3::ZERO
    }

    /// Tells whether the mesh is mirrored, which reverses its faces.
    pub fn is_mirrored(&self) -> bool {
        self.linear.determinant() < 0.0
    }
}

/// Returns the matrix of a rotation.
fn turned(rotation: Rotation) -> DMat3 {
    let Some(angles) = rotation.angles() else {
        let placement = Placement { scale: DVec3::ONE, rotation, translation: DVec3::ZERO };
        return placement.to_object_space().transpose();
    };
    let [x, y, z] = angles.to_array().map(sin_cos);
    let around_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, x.1, x.0), DVec3::new(0.0, -x.0, x.1));
    let around_y = DMat3::from_cols(DVec3::new(y.1, 0.0, -y.0), DVec3::Y, DVec3::new(y.0, 0.0, y.1));
    let around_z = DMat3::from_cols(DVec3::new(z.1, z.0, 0.0), DVec3::new(-z.0, z.1, 0.0), DVec3::Z);
    around_z * around_y * around_x
}

/// Returns the sine and the cosine of an angle in degrees, exact for multiples of 90.
fn sin_cos(degrees: f64) -> (f64, f64) {
    let turned = degrees.rem_euclid(360.0);
    match turned {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => (libm::sin(turned.to_radians()), libm::cos(turned.to_radians())),
    }
}
