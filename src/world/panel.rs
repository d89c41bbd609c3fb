//! Flat panels that shine: rectangles and discs, and the points of them that are seen.

use crate::directions::from_square;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// The points `middle + x half[0] + y half[1]` of a flat panel that shines on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    /// The middle, in world coordinates.
    pub middle: DVec3,
    /// The vectors from the middle to the middles of two sides, or to the rim, in world units. They are perpendicular
    /// to each other, and have the same length if the panel `is_round`.
    pub half: [DVec3; 2],
    /// Whether x and y are within the unit circle; otherwise, both are from -1 to 1.
    pub is_round: bool,
}

impl Panel {
    /// Returns the unit normal of one of its sides.
    pub fn facing(&self) -> DVec3 {
        self.half[0].cross(self.half[1]).normalize()
    }

    /// Returns its area, in square world units.
    pub fn area(&self) -> f64 {
        let area = self.half[0].length() * self.half[1].length();
        if self.is_round { PI * area } else { 4.0 * area }
    }

    /// Returns the radius of the smallest ball around it, in world units.
    pub fn radius(&self) -> f64 {
        let [one, other] = self.half.map(|half| half.length_squared());
        if self.is_round { one.sqrt() } else { (one + other).sqrt() }
    }

    /// Returns the distance beyond which points are chosen by area, in world units.
    pub fn far(&self) -> f64 {
        if self.is_round { 4.0 * self.radius() } else { 32.0 * self.radius() }
    }

    /// Chooses a point as seen from a place by two numbers from 0 to 1: by solid angle, or, from afar, where that is
    /// nearly the same, by area. Near a disc, the point is chosen in the square around it; `None` if it lies beside
    /// the disc.
    ///
    /// Returns the vector to the point, in world units, and the reciprocal of the density per unit of solid angle,
    /// which is at most 2 pi.
    pub fn sample(&self, at: DVec3, numbers: DVec2) -> Option<(DVec3, f64)> {
        let (between, half) = (self.middle - at, self.half);
        if between.length() > self.far() {
            let place = if self.is_round { from_square(numbers).into() } else { 2.0 * numbers - 1.0 };
            let toward = between + place.x * half[0] + place.y * half[1];
            let leaving = toward.normalize().dot(self.facing()).abs();
            return Some((toward, self.area() * leaving / toward.length_squared()));
        }
        let seen = SphericalRectangle::new(between, half)?;
        let toward = seen.place(numbers);
        let is_beside = self.is_round && (toward - between).length_squared() > half[0].length_squared();
        (!is_beside).then_some((toward, seen.solid_angle))
    }

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses the point that is seen
    /// from a place along a unit vector, at a distance in world units; `None` if the place lies in the panel's plane.
    pub fn density(&self, at: DVec3, toward: DVec3, distance: f64) -> Option<f64> {
        let between = self.middle - at;
        if between.length() > self.far() {
            let leaving = toward.dot(self.facing()).abs();
            return (leaving > 0.0).then(|| distance * distance / (self.area() * leaving));
        }
        let seen = SphericalRectangle::new(between, self.half)?;
        (seen.solid_angle > 0.0).then(|| 1.0 / seen.solid_angle)
    }
}

/// A rectangle as seen from a point: the part of a unit sphere that it covers.
///
/// From Ureña, Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles", 2013.
struct SphericalRectangle {
    /// The unit vectors along the sides, and toward the rectangle's plane, reversed.
    axes: [DVec3; 3],
    /// The coordinates of the sides and of the plane, in world units from the point.
    from: DVec2,
    to: DVec2,
    plane: f64,
    /// The constants for the choice of a place, with the paper's names.
    b: [f64; 2],
    k: f64,
    /// The solid angle that the rectangle covers, in steradians.
    solid_angle: f64,
}

impl SphericalRectangle {
    /// Returns a rectangle as seen from a point. `between` leads from the point to the rectangle's middle. `None` if
    /// the point lies in the rectangle's plane.
    fn new(between: DVec3, half: [DVec3; 2]) -> Option<Self> {
        let [x_axis, y_axis] = half.map(DVec3::normalize);
        let z_axis = x_axis.cross(y_axis);
        let height = between.dot(z_axis);
        let z_axis = if height > 0.0 { -z_axis } else { z_axis };
        let (size, place) = (
            DVec2::new(half[0].length(), half[1].length()),
            DVec2::new(between.dot(x_axis), between.dot(y_axis)),
        );
        let (from, to, plane) = (place - size, place + size, -height.abs());
        if plane == 0.0 || !(plane.is_finite() && from.is_finite() && to.is_finite()) {
            return None;
        }
        // The z of the unit normals of the planes through the point and each side.
        let inward = |side: f64| side / (plane * plane + side * side).sqrt();
        let [low, right, high, left] = [-inward(from.y), inward(to.x), inward(to.y), -inward(from.x)];
        let angle = |one: f64, other: f64| libm::acos((-one * other).clamp(-1.0, 1.0));
        let [g0, g1, g2, g3] = [angle(low, right), angle(right, high), angle(high, left), angle(left, low)];
        let k = 2.0 * PI - g2 - g3;
        Some(Self {
            axes: [x_axis, y_axis, z_axis],
            from,
            to,
            plane,
            b: [low, high],
            k,
            solid_angle: (g0 + g1 - k).max(0.0),
        })
    }

    /// Chooses a point of the rectangle by two numbers from 0 to 1, evenly by solid angle. Returns the vector to it,
    /// in world units.
    fn place(&self, numbers: DVec2) -> DVec3 {
        let ([low, high], [x_axis, y_axis, z_axis]) = (self.b, self.axes);
        let (sin, cos) = libm::sincos(numbers.x * self.solid_angle + self.k);
        let along = (cos * low - high) / sin;
        let u = (1.0 / (along * along + low * low).sqrt()).copysign(along).clamp(-1.0, 1.0);
        let x = -(u * self.plane) / (1.0 - u * u).max(f64::MIN_POSITIVE).sqrt();
        let x = x.clamp(self.from.x, self.to.x);
        let distance = (x * x + self.plane * self.plane).sqrt();
        let height = |y: f64| y / (distance * distance + y * y).sqrt();
        let [low, high] = [height(self.from.y), height(self.to.y)];
        let part = low + numbers.y * (high - low);
        let rest = 1.0 - part * part;
        let y = if rest > 1e-12 { part * distance / rest.sqrt() } else { self.to.y };
        x * x_axis + y.clamp(self.from.y, self.to.y) * y_axis + self.plane * z_axis
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spherical_rectangle_has_its_solid_angle_and_even_samples() {
        // A face of a cube around the point covers a sixth of all directions.
        let half = [DVec3::X, DVec3::Y];
        let seen = SphericalRectangle::new(DVec3::NEG_Z, half).expect("a face");
        assert!((seen.solid_angle - 4.0 * PI / 6.0).abs() < 1e-12, "{}", seen.solid_angle);
        // The mean of a direction over it is that of the integral of the cosine: the form factor, times pi.
        let count = 256;
        let mut sum = 0.0;
        for index in 0..count * count {
            let place = |part: i32| (f64::from(part) + 0.5) / f64::from(count);
            let toward = seen.place(DVec2::new(place(index % count), place(index / count)));
            assert!(toward.x.abs() <= 1.0 && toward.y.abs() <= 1.0 && (toward.z + 1.0).abs() < 1e-12);
            sum += -toward.normalize().z;
        }
        let cosine = sum / f64::from(count * count) * seen.solid_angle;
        let root = 2.0_f64.sqrt();
        let expected = 4.0 / root * (1.0 / root).atan();
        assert!((cosine - expected).abs() < 1e-5, "{cosine}, {expected}");
    }
}
