//! Flat panels that shine: rectangles and discs, and the points of them that are seen.

use crate::directions::from_square;
use crate::number::Number;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use tabray_exact::scalar::{constants, cross, dot, per_axis, unit};

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
    /// nearly the same, by area. Near a disc, the point is chosen in the square around it.
    ///
    /// Returns the vector to the point, in world units, and the reciprocal of the density per unit of solid angle, which is
    /// at most 2 pi, and 0 if the point lies beside the disc. `None` where the point is open, and in plain numbers if the
    /// place lies in the panel's plane.
    pub fn sample<N: Number>(&self, at: [N; 3], numbers: DVec2) -> Option<([N; 3], N)> {
        let n = N::constant;
        let between = per_axis(|axis| n(self.middle[axis]) - at[axis]);
        // The rounding of the distance is less than this part of it.
        let far = N::about(self.far(), 1e-12 * self.far());
        if is_negative(far - dot(between, between).sqrt())? {
            let place = match self.is_round {
                true => from_square(numbers),
                false => [numbers.x, numbers.y].map(|number| n(2.0) * n(number) - n(1.0)),
            };
            return Some(self.by_area(between, place));
        }
        let seen = SphericalRectangle::new(between, self.half)?;
        let toward = seen.place(numbers)?;
        let off: [N; 3] = per_axis(|axis| toward[axis] - between[axis]);
        let half: [N; 3] = constants(self.half[0]);
        let is_beside = self.is_round && is_negative(dot(half, half) - dot(off, off))?;
        Some((toward, if is_beside { n(0.0) } else { seen.solid_angle }))
    }

    /// Returns the vector to the point at two coordinates, from -1 to 1, and the reciprocal of the density of points that are
    /// chosen by area, per unit of solid angle. `between` leads to the middle.
    pub fn by_area<N: Number>(&self, between: [N; 3], [x, y]: [N; 2]) -> ([N; 3], N) {
        let n = N::constant;
        let toward = per_axis(|axis| between[axis] + x * n(self.half[0][axis]) + y * n(self.half[1][axis]));
        let square = dot(toward, toward);
        // The rounding of its area and of its direction is less than the tolerance with which colours are compared.
        let leaving = (dot(toward, constants(self.facing())) / square.sqrt()).abs();
        (toward, n(self.area()) * leaving / square)
    }

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses the point that is seen
    /// from a place along a unit vector, at a distance in world units; `None` if the place lies in the panel's plane.
    pub fn density(&self, at: DVec3, toward: DVec3, distance: f64) -> Option<f64> {
        let between = self.middle - at;
        if between.length() > self.far() {
            let leaving = toward.dot(self.facing()).abs();
            return (leaving > 0.0).then(|| distance * distance / (self.area() * leaving));
        }
        let seen = SphericalRectangle::new(between.to_array(), self.half)?;
        (seen.solid_angle > 0.0).then(|| 1.0 / seen.solid_angle)
    }
}

/// A rectangle as seen from a point: the part of a unit sphere that it covers.
///
/// From Ureña, Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles", 2013.
struct SphericalRectangle<N> {
    /// The unit vectors along the sides, and toward the rectangle's plane, reversed.
    axes: [[N; 3]; 3],
    /// The coordinates of the sides and of the plane, in world units from the point.
    from: [N; 2],
    to: [N; 2],
    plane: N,
    /// The constants for the choice of a place, with the paper's names.
    b: [N; 2],
    k: N,
    /// The solid angle that the rectangle covers, in steradians.
    solid_angle: N,
}

impl<N: Number> SphericalRectangle<N> {
    /// Returns a rectangle as seen from a point. `between` leads from the point to the rectangle's middle. `None` if
    /// the point lies in the rectangle's plane, or that is open.
    fn new(between: [N; 3], half: [DVec3; 2]) -> Option<Self> {
        let [right, up]: [[N; 3]; 2] = [constants(half[0]), constants(half[1])];
        let (x_axis, y_axis) = (unit(right), unit(up));
        let facing = cross(x_axis, y_axis);
        let height = dot(between, facing);
        let sign = -height.sign()?;
        let plane = sign * height;
        let (width, height) = (dot(right, right).sqrt(), dot(up, up).sqrt());
        let (x, y) = (dot(between, x_axis), dot(between, y_axis));
        let (from, to) = ([x - width, y - height], [x + width, y + height]);
        let is_finite = |of: N| of.plain().is_none_or(f64::is_finite);
        let are_finite = |of: [N; 2]| is_finite(of[0]) && is_finite(of[1]);
        if plane.is_zero() || !(is_finite(plane) && are_finite(from) && are_finite(to)) {
            return None;
        }
        // The z of the unit normals of the planes through the point and each side.
        let inward = |side: N| side / (plane * plane + side * side).sqrt();
        let [low, right, high, left] = [-inward(from[1]), inward(to[0]), inward(to[1]), -inward(from[0])];
        // The angles between neighbours, less a right angle.
        let (g0, g1, g2, g3) =
            ((low * right).asin(), (right * high).asin(), (high * left).asin(), (left * low).asin());
        Some(Self {
            axes: [x_axis, y_axis, per_axis(|axis| sign * facing[axis])],
            from,
            to,
            plane,
            b: [low, high],
            k: N::pi() - g2 - g3,
            solid_angle: (g0 + g1 + g2 + g3).max(N::constant(0.0)),
        })
    }

    /// Chooses a point of the rectangle by two numbers from 0 to 1, evenly by solid angle. Returns the vector to it,
    /// in world units; `None` where it is open.
    fn place(&self, numbers: DVec2) -> Option<[N; 3]> {
        let ([low, high], [x_axis, y_axis, z_axis], n) = (self.b, self.axes, N::constant);
        let (sin, cos) = (n(numbers.x) * self.solid_angle + self.k).sin_cos();
        let rise = cos * low - high;
        let u = sin / (rise * rise + low * low * sin * sin).sqrt();
        let u = (rise.sign()? * u).max(n(-1.0)).min(n(1.0));
        let x = -(u * self.plane) / (n(1.0) - u * u).max(n(f64::MIN_POSITIVE)).sqrt();
        let x = x.max(self.from[0]).min(self.to[0]);
        let square = x * x + self.plane * self.plane;
        let height = |y: N| y / (square + y * y).sqrt();
        let (low, high) = (height(self.from[1]), height(self.to[1]));
        let part = low + n(numbers.y) * (high - low);
        let rest = (n(1.0) - part * part).max(n(1e-12));
        let y = (part * square.sqrt() / rest.sqrt()).max(self.from[1]).min(self.to[1]);
        Some(per_axis(|axis| x * x_axis[axis] + y * y_axis[axis] + self.plane * z_axis[axis]))
    }
}

/// Tells whether a number is negative; `None` where that is open.
fn is_negative<N: Number>(of: N) -> Option<bool> {
    Some(of.sign()? != N::constant(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spherical_rectangle_has_its_solid_angle_and_even_samples() {
        // A face of a cube around the point covers a sixth of all directions.
        let half = [DVec3::X, DVec3::Y];
        let seen = SphericalRectangle::<f64>::new([0.0, 0.0, -1.0], half).expect("a face");
        assert!((seen.solid_angle - 4.0 * PI / 6.0).abs() < 1e-12, "{}", seen.solid_angle);
        // The mean of a direction over it is that of the integral of the cosine: the form factor, times pi.
        let count = 256;
        let mut sum = 0.0;
        for index in 0..count * count {
            let place = |part: i32| (f64::from(part) + 0.5) / f64::from(count);
            let toward = DVec3::from(
                seen.place(DVec2::new(place(index % count), place(index / count))).expect("a place"),
            );
            assert!(toward.x.abs() <= 1.0 && toward.y.abs() <= 1.0 && (toward.z + 1.0).abs() < 1e-12);
            sum += -toward.normalize().z;
        }
        let cosine = sum / f64::from(count * count) * seen.solid_angle;
        let root = 2.0_f64.sqrt();
        let expected = 4.0 / root * (1.0 / root).atan();
        assert!((cosine - expected).abs() < 1e-5, "{cosine}, {expected}");
    }
}
