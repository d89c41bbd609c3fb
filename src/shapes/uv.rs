//! Coordinates u and v on surfaces, for shaders.

use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, constants, cross, dot, per_axis};
use tabray_world::number::Number;

/// Returns the angle of a point around the y axis, as a fraction of a turn from 0 to 1: 0.5 toward +z, and more toward
/// +x.
pub fn turn(at: DVec3) -> f64 {
    0.5 + libm::atan2(at.x, at.z) / TAU
}

/// Returns the longitude and the latitude of a point of the unit sphere around the origin, both from 0 to 1. The
/// latitude is 0 at -y and 1 at +y.
pub fn on_sphere(at: DVec3) -> DVec2 {
    DVec2::new(turn(at), libm::acos(-at.y.clamp(-1.0, 1.0)) / PI)
}

/// Returns the angle of a point around the y axis, and its height as a fraction of `height`, both from 0 to 1.
pub fn on_height(at: DVec3, height: f64) -> DVec2 {
    DVec2::new(turn(at), at.y / height)
}

/// Returns the barycentric coordinates of a point of a triangle: the weights of its second and its third corner, from 0
/// to 1.
pub(crate) fn on_triangle([a, b, c]: [DVec3; 3], at: DVec3) -> DVec2 {
    let (first, second, from) = (b - a, c - a, at - a);
    let upright = first.cross(second);
    let area = upright.length_squared();
    let weights = DVec2::new(from.cross(second).dot(upright), first.cross(from).dot(upright)) / area;
    // A triangle so small that its area underflows has a single point.
    if weights.is_finite() { weights } else { DVec2::ZERO }
}

/// Encloses the exact [`turn`] for the points of a box.
fn turn_bounds([x, _, z]: [Interval; 3]) -> Interval {
    x.atan2(z) / (Interval::constant(2.0) * Interval::pi()) + Interval::constant(0.5)
}

/// Encloses the exact [`on_sphere`] for the directions of the points of a box.
pub fn bounds_on_sphere(at: [Interval; 3]) -> [Interval; 2] {
    let height = at[1] / dot(at, at).sqrt();
    [turn_bounds(at), Interval::constant(0.5) + height.asin() / Interval::pi()]
}

/// Encloses the exact [`on_height`] for the points of a box.
pub fn bounds_on_height(at: [Interval; 3], height: f64) -> [Interval; 2] {
    [turn_bounds(at), at[1] / Interval::constant(height)]
}

/// Encloses the exact [`on_triangle`] for the points of a box.
pub(crate) fn bounds_on_triangle(corners: [DVec3; 3], at: [Interval; 3]) -> [Interval; 2] {
    let [a, b, c] = corners.map(constants::<Interval>);
    let from = |to: [Interval; 3]| per_axis(|axis| to[axis] - a[axis]);
    let (first, second, at) = (from(b), from(c), from(at));
    let upright = cross(first, second);
    let weight = |one, other| dot(cross(one, other), upright) / dot(upright, upright);
    [weight(at, second), weight(first, at)]
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

    /// Returns the box of these half sizes around a point.
    fn around(at: DVec3, half: f64) -> [Interval; 3] {
        per_axis(|axis| Interval { low: at[axis] - half, high: at[axis] + half })
    }

    #[track_caller]
    fn is_within(uv: DVec2, bounds: [Interval; 2]) {
        for axis in 0..2 {
            let Interval { low, high } = bounds[axis];
            assert!(low - 1e-15 <= uv[axis] && uv[axis] <= high + 1e-15, "{uv} is not within {bounds:?}");
        }
    }

    #[test]
    fn bounds_contain_uv_and_are_close_around_it() {
        let corners = [DVec3::new(0.1, 0.0, 0.3), DVec3::new(4.0, 0.2, 0.0), DVec3::new(0.0, 1.0, 2.0)];
        for step in 0..1000 {
            let turn = 0.3 + f64::from(step);
            let at = DVec3::new(2.0 * turn.sin(), (1.7 * turn).sin(), 2.0 * turn.cos());
            let half = 10_f64.powi(-(step % 15) - 1);
            let inside = at + half * DVec3::new((5.0 * turn).sin(), (7.0 * turn).sin(), (9.0 * turn).sin());
            let near = around(at, half);
            is_within(on_sphere(inside.normalize()), bounds_on_sphere(near));
            is_within(on_height(inside, 3.0), bounds_on_height(near, 3.0));
            is_within(on_triangle(corners, inside), bounds_on_triangle(corners, near));
            if half < 1e-3 {
                let widest = |bounds: [Interval; 2]| bounds[0].width().max(bounds[1].width());
                assert!(widest(bounds_on_triangle(corners, near)) < 100.0 * half + 1e-13);
                // Except near the meridian where u wraps around.
                if at.z > 0.0 || at.x.abs() > half {
                    assert!(widest(bounds_on_sphere(near)) < 100.0 * half + 1e-13, "{at}");
                    assert!(widest(bounds_on_height(near, 3.0)) < 100.0 * half + 1e-13, "{at}");
                }
            }
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
