//! Coordinates u and v on surfaces, for shaders.

use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Returns how far around the y axis a point lies, from 0 to 1: 0.5 toward +z, and more toward +x.
pub fn turn(at: DVec3) -> f64 {
    0.5 + libm::atan2(at.x, at.z) / TAU
}

/// Returns the longitude and the latitude of a point of the unit sphere around the origin, from 0 to 1: the latitude is 0
/// at -y and 1 at +y.
pub fn on_sphere(at: DVec3) -> DVec2 {
    DVec2::new(turn(at), libm::acos(-at.y.clamp(-1.0, 1.0)) / PI)
}

/// Returns how far around the y axis a point lies, and how high of a height from y = 0 up, from 0 to 1.
pub fn on_height(at: DVec3, height: f64) -> DVec2 {
    DVec2::new(turn(at), at.y / height)
}

/// Returns the barycentric coordinates of a point of a triangle: the weights of its second and its third corner, from 0 to
/// 1.
pub fn on_triangle([a, b, c]: [DVec3; 3], at: DVec3) -> DVec2 {
    let (first, second, from) = (b - a, c - a, at - a);
    let upright = first.cross(second);
    let area = upright.length_squared();
    let weights = DVec2::new(from.cross(second).dot(upright), first.cross(from).dot(upright)) / area;
    // Of a triangle so small that its area underflows, there is one point.
    if weights.is_finite() { weights } else { DVec2::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uv_of_a_sphere_is_longitude_and_latitude() {
        for (at, uv) in [
            (DVec3::Z, [0.5, 0.5]),
            (DVec3::X, [0.75, 0.5]),
            (-DVec3::X, [0.25, 0.5]),
            (DVec3::Y, [0.5, 1.0]),
        ] {
            assert!((on_sphere(at) - DVec2::from(uv)).length() < 1e-15, "{at}: {}", on_sphere(at));
        }
    }

    #[test]
    fn uv_of_a_triangle_is_barycentric() {
        let corners = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 0.0, 2.0)];
        let uv = on_triangle(corners, DVec3::new(1.0, 0.0, 1.0));
        assert!((uv - DVec2::new(0.25, 0.5)).length() < 1e-15, "{uv}");
        assert_eq!(on_triangle([DVec3::ONE; 3], DVec3::ONE), DVec2::ZERO);
    }
}
