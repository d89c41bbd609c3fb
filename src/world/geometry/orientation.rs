//! Decisions on which side of a plane, or of a line in it, a point lies. They are exact if no product of the
//! coordinates' differences, scaled to about 1, underflows.

use glam::DVec3;
use std::cmp::Ordering;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::double_double::vectors::{cross, product, scaled_to_one, triple_product};

/// A bound of the rounding error of a component of the cross product of two vectors between points, as a fraction of
/// the product of their largest components. In units of 2^-53: 2 * (3 + 1), less than 16.
const CROSS_ERROR: f64 = 8.0 * f64::EPSILON;

/// A bound of the rounding error of the triple product of three such vectors, as a fraction of the product of their
/// largest components. In units of 2^-53: 3 * (8 + 2 * 2) + 2 * 6 = 48, less than 64.
const TRIPLE_ERROR: f64 = 32.0 * f64::EPSILON;

/// Far more than the loss of products that are too small to have all digits.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// Returns the side of the plane through three points on which another point lies: `Less` if the three run
/// counterclockwise as seen from it, and `Equal` if all four are in one plane.
#[inline]
pub fn side_of_plane(plane: [DVec3; 3], at: DVec3) -> Ordering {
    let [a, b, c] = plane.map(|corner| corner - at);
    // All four are in one plane across an axis, like the corners of a box's side.
    if (0..3).any(|axis| a[axis] == 0.0 && b[axis] == 0.0 && c[axis] == 0.0) {
        return Ordering::Equal;
    }
    let size = |of: DVec3| of.abs().max_element();
    let error = TRIPLE_ERROR * size(a) * size(b) * size(c) + UNDERFLOW * (1.0 + size(c));
    known(a.cross(b).dot(c), error).unwrap_or_else(|| {
        let [a, b, c] = plane.map(|corner| between(at, corner));
        // Double-double arithmetic nearly always decides. The sums have a few products of numbers up to 1, each with an
        // error of 2^-100.
        let part = |one: usize, other: usize| a[one] * b[other] - a[other] * b[one];
        let about = product([part(1, 2), part(2, 0), part(0, 1)], c);
        sign(if about.high.abs() > 1e-28 { about } else { triple_product(a, b, c) })
    })
}

/// Returns the direction in which three points turn as seen along an axis, given by its index, or `Equal` if they lie
/// on one line.
#[inline]
pub fn turn([from, to]: [DVec3; 2], at: DVec3, axis: usize) -> Ordering {
    let (a, b) = (from - at, to - at);
    if (1..3).map(|next| (axis + next) % 3).any(|axis| a[axis] == 0.0 && b[axis] == 0.0) {
        return Ordering::Equal;
    }
    let error = CROSS_ERROR * a.abs().max_element() * b.abs().max_element() + UNDERFLOW;
    known(a.cross(b)[axis], error).unwrap_or_else(|| sign(cross(between(at, from), between(at, to))[axis]))
}

/// Returns the index of an axis along which three points that do not lie on one line do not appear on one line.
pub fn axis_across([a, b, c]: [DVec3; 3]) -> usize {
    let normal = cross(between(a, b), between(a, c)).map(|part| part.high.abs());
    (0..3).max_by(|one, other| normal[*one].total_cmp(&normal[*other])).unwrap_or(0)
}

fn between(from: DVec3, to: DVec3) -> [DoubleDouble; 3] {
    scaled_to_one([0, 1, 2].map(|axis| DoubleDouble::difference(to[axis], from[axis])))
}

fn known(value: f64, error: f64) -> Option<Ordering> {
    (value.abs() > error).then(|| value.total_cmp(&0.0))
}

fn sign(of: DoubleDouble) -> Ordering {
    if of.high > 0.0 {
        Ordering::Greater
    } else if of.high < 0.0 {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_one_digit_off_a_plane_is_off_it() {
        // x + y + z = 3
        let plane = [DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 0.0), DVec3::new(0.0, 0.0, 3.0)];
        assert_eq!(side_of_plane(plane, DVec3::new(1.5, 0.25, 1.25)), Ordering::Equal);
        assert_eq!(side_of_plane(plane, DVec3::new(1.5, 0.25_f64.next_up(), 1.25)), Ordering::Less);
        assert_eq!(side_of_plane(plane, DVec3::new(1.5, 0.25_f64.next_down(), 1.25)), Ordering::Greater);
        assert_eq!(side_of_plane(plane, DVec3::splat(1e150)), Ordering::Less);
    }

    #[test]
    fn a_point_one_digit_off_a_line_is_off_it() {
        let line = [DVec3::new(0.1, 0.1, 7.0), DVec3::new(12.3, 12.3, -5.0)];
        let axis = axis_across([line[0], line[1], DVec3::ZERO]);
        assert_ne!(turn(line, DVec3::ZERO, axis), Ordering::Equal);
        assert_eq!(turn(line, DVec3::new(0.7, 0.7, 0.0), 2), Ordering::Equal);
        assert_eq!(turn(line, DVec3::new(0.7, 0.7_f64.next_up(), 0.0), 2), Ordering::Greater);
        assert_eq!(turn(line, DVec3::new(0.7, 0.7_f64.next_down(), 0.0), 2), Ordering::Less);
    }
}
