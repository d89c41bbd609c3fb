//! Flat parts of surfaces, compared by the numbers of the scene to decide whether two of them lie exactly in one plane.

use crate::geometry::placement::{Placement, Rotation};
use glam::DVec3;
use tabray_exact::double_double::two_sum;

/// The plane that contains all of a closed shape's surface near a point, and the side of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    plane: Plane,
    /// Whether the shape's outward normal points in the direction of the plane's coordinate or height.
    is_upward: bool,
    /// The placement of the plane, or `None` if its numbers are world coordinates.
    placement: Option<Placement>,
}

/// A plane, described by unrounded numbers. Different numbers may describe the same plane.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Plane {
    /// The points with this coordinate along an axis of the world: the exact sum of two numbers. The first is this sum,
    /// rounded.
    Across { axis: usize, at: (f64, f64) },
    /// The points at a height above a point, along a direction of any length.
    Above { base: DVec3, direction: DVec3, height: f64 },
}

impl Facet {
    /// Returns the facet of a triangle with this outward normal, which may be rounded, or `None` if the triangle is not
    /// perpendicular to an axis.
    pub fn of_triangle([a, b, c]: [DVec3; 3], normal: DVec3) -> Option<Self> {
        let axis = (0..3).find(|axis| a[*axis] == b[*axis] && b[*axis] == c[*axis])?;
        Some(Self::across(axis, (a[axis], 0.0), normal[axis] > 0.0))
    }

    /// Returns the facet at a height above a point, along a direction of any length.
    pub fn above(base: DVec3, direction: DVec3, height: f64, is_upward: bool) -> Self {
        let mut along = (0..3).filter(|axis| direction[*axis] != 0.0);
        if let (Some(axis), None) = (along.next(), along.next()) {
            let is_forward = direction[axis] > 0.0;
            let height = if is_forward { height } else { -height };
            return Self::across(axis, two_sum(base[axis], height), is_upward == is_forward);
        }
        Self { plane: Plane::Above { base, direction, height }, is_upward, placement: None }
    }

    fn across(axis: usize, at: (f64, f64), is_upward: bool) -> Self {
        Self { plane: Plane::Across { axis, at }, is_upward, placement: None }
    }

    /// Returns the facet of a copy, or `None` if the copy needs more than one placement.
    pub fn placed(self, placement: Placement) -> Option<Self> {
        let Self { plane, is_upward, placement: None } = self else { return None };
        if let Plane::Across { axis, at: (high, low) } = plane
            && placement.rotation == Rotation::NONE
            && placement.scale[axis] == 1.0
        {
            let (sum, rest) = two_sum(high, placement.translation[axis]);
            let (rest, lost) = two_sum(rest, low);
            if lost == 0.0 {
                return Some(Self::across(axis, two_sum(sum, rest), is_upward));
            }
        }
        Some(Self { placement: Some(placement), ..self })
    }

    /// Tells whether the shape of this facet contains the space on the outer and on the inner side of another facet
    /// through the same point. Returns `None` if the two may lie in different planes.
    pub fn beside(&self, other: &Self) -> Option<[bool; 2]> {
        let is_same = self.plane == other.plane && self.placement == other.placement;
        is_same.then_some(if self.is_upward == other.is_upward { [false, true] } else { [true, false] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn top(base: DVec3, height: f64) -> Facet {
        Facet::above(base, DVec3::Y, height, true)
    }

    fn moved(by: DVec3) -> Placement {
        Placement { scale: DVec3::ONE, rotation: Rotation::NONE, translation: by }
    }

    #[test]
    fn a_plane_is_the_same_from_both_sides() {
        let [low, high] = [DVec3::ZERO, 3.0 * DVec3::Y];
        let bottom = Facet::above(high, 2.0 * DVec3::Y, 0.0, false);
        assert_eq!(top(low, 3.0).beside(&bottom), Some([true, false]));
        assert_eq!(Facet::above(high, -DVec3::Y, 0.0, true).beside(&bottom), Some([false, true]));
        let side = [DVec3::new(1.0, 3.0, 0.0), DVec3::new(0.0, 3.0, 1.0), DVec3::new(0.0, 3.0, 0.0)];
        let side = Facet::of_triangle(side, DVec3::Y).expect("it is across y");
        assert_eq!(side.beside(&bottom), Some([true, false]));
    }

    #[test]
    fn planes_that_rounding_makes_one_are_two() {
        let base = DVec3::new(0.0, 1.0, 0.0);
        assert_eq!(top(base, 1e-20).beside(&top(base, 0.0)), None);
        assert_eq!(top(base, 1e-20).beside(&top(base, 1e-20)), Some([false, true]));
        // 0.1 + 0.2 is not 0.3, and not the number nearest to their sum.
        let sum = 0.2 * DVec3::Y;
        assert_eq!(top(sum, 0.1).beside(&top(DVec3::ZERO, 0.3)), None);
        assert_eq!(top(sum, 0.1).beside(&top(DVec3::ZERO, 0.1 + 0.2)), None);
        assert_eq!(top(sum, 0.1).beside(&top(0.1 * DVec3::Y, 0.2)), Some([false, true]));
    }

    #[test]
    fn copies_lie_where_they_are_moved_to() {
        let by = moved(DVec3::new(0.0, 0.1, 0.0));
        let [one, other] =
            [top(0.2 * DVec3::Y, 0.0).placed(by), top(0.1 * DVec3::Y, 0.2).placed(moved(DVec3::ZERO))]
                .map(|facet| facet.expect("it is moved once"));
        assert_eq!(one.beside(&other), Some([false, true]));
        assert_eq!(one.beside(&top(0.2 * DVec3::Y, 0.1)), Some([false, true]));
        assert_eq!(one.beside(&top(0.2 * DVec3::Y, 0.0)), None);
    }

    #[test]
    fn what_is_turned_is_compared_with_what_is_turned_alike() {
        let turned = Placement { rotation: Rotation::Angles(30.0 * DVec3::X), ..moved(DVec3::ZERO) };
        let facet = top(DVec3::ZERO, 2.0);
        let copy = facet.placed(turned).expect("it is placed once");
        assert_eq!(copy.beside(&facet), None);
        assert_eq!(copy.beside(&copy), Some([false, true]));
        assert_eq!(copy.beside(&top(DVec3::ZERO, 1.0).placed(turned).expect("it is placed once")), None);
        assert_eq!(copy.placed(turned), None);
    }
}
