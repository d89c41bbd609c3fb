//! Which of two surfaces a ray hits first, where rounded distances do not tell.

use crate::geometry::aabb::larger;
use crate::geometry::ray::Ray;
use crate::geometry::sight::Sight;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Enclosure, Precision};
use crate::world::coincidence::{LEAST_COSINE, SAME, close};
use std::cmp::Ordering;

/// Tells whether a ray hits one shape before another, given their approximate distances in world units. Returns `None`
/// where they coincide as far as the ray is known, whose origin may be off by `origin_error` world units.
///
/// Where two surfaces cross, a ray that is shifted sideways hits them in the other order. How far the ray may be
/// shifted follows from the rounding of its direction, two ulps in each component, and from the error of its origin.
pub(super) fn is_before(
    ray: &Ray,
    origin_error: f64,
    (one, distance): (&AnyShape, f64),
    (other, far): (&AnyShape, f64),
) -> Option<bool> {
    let size = ray.origin.abs().max_element() + distance;
    if (distance - far).abs() <= close(ray, distance)
        && let (Some(fine), Some(fine_far)) =
            (one.packets().fine_distance(ray, distance), other.packets().fine_distance(ray, far))
    {
        let apart = (fine - fine_far).high;
        let normals = [one, other].map(|shape| shape.normal(ray.at(distance)));
        let [cosine, other_cosine] = normals.map(|normal| ray.dir.dot(normal));
        // The change of the distances' difference per unit of sideways shift.
        let divergence = (normals[0] / cosine - normals[1] / other_cosine).length();
        // Two ulps in each of three components are less than 4 ulps in length.
        let shift = 4.0 * f64::EPSILON * distance + origin_error;
        let min_cosine = larger(cosine.abs().min(other_cosine.abs()), LEAST_COSINE);
        let same = shift * divergence + SAME * (size + one.reach() + other.reach()) / min_cosine;
        return (apart.abs() > same).then_some(apart < 0.0);
    }
    (distance != far).then_some(distance < far)
}

/// Tells whether two distances may be equal up to rounding, and one of them has no more digits, as in a copy.
pub(super) fn is_unclear(
    ray: &Ray,
    (one, distance): (&AnyShape, f64),
    (other, far): (&AnyShape, f64),
) -> bool {
    let has_digits = |shape: &AnyShape, at: f64| shape.packets().fine_distance(ray, at).is_some();
    (distance - far).abs() <= close(ray, distance) && !(has_digits(one, distance) && has_digits(other, far))
}

/// Returns the order in which a ray hits two shapes, by a proof with 237 bits, up to which equal distances are the same;
/// `None` where that decides nothing.
pub(super) fn certain_order(one: &AnyShape, other: &AnyShape, sight: &Sight) -> Option<Ordering> {
    let distance = |shape: &AnyShape| match shape.certify(sight, Precision::Octuple) {
        Enclosure::Hits(at) | Enclosure::Edge(at) => Some(at),
        Enclosure::Misses | Enclosure::Doubtful(_) => None,
    };
    let (one, other) = (distance(one)?, distance(other)?);
    Some(match (one.high < other.low, other.high < one.low) {
        (true, _) => Ordering::Less,
        (_, true) => Ordering::Greater,
        _ => Ordering::Equal,
    })
}
