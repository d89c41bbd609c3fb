//! Which of two surfaces a ray hits first, where rounded distances do not tell.

use crate::geometry::aabb::larger;
use crate::geometry::ray::Ray;
use crate::geometry::sight::Sight;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Enclosure, Precision};
use crate::world::coincidence::{LEAST_COSINE, SAME, close};
use std::cmp::Ordering;

/// A bound on the error of the distance of a copy's hit by the rounding of the copy's matrix, as a fraction of the
/// coordinates, at a right angle: 512 units of 2^-53.
const COPIED: f64 = 256.0 * f64::EPSILON;

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
    let apart = (distance - far).abs();
    if apart > close(ray, distance) {
        return Some(distance < far);
    }
    let Divergence { per_shift, cosine } = divergence(ray, (one, distance), other);
    let lost = (shift(distance) + origin_error) * per_shift;
    let size = ray.origin.abs().max_element() + distance + one.facts().max_coordinate + other.facts().max_coordinate;
    if let (Some(fine), Some(fine_far)) =
        (one.packets().fine_distance(ray, distance), other.packets().fine_distance(ray, far))
    {
        let apart = (fine - fine_far).high;
        return (apart.abs() > lost + SAME * size / cosine).then_some(apart < 0.0);
    }
    // A copy's distance is off by the rounding of its matrix, and has no more digits.
    (apart > lost + COPIED * size / cosine).then_some(distance < far)
}

/// How two surfaces come apart near the point where a ray hits them.
struct Divergence {
    /// The change of the difference between their distances for each unit by which the ray is shifted sideways.
    per_shift: f64,
    /// The smaller cosine of the angles between the ray and their normals.
    cosine: f64,
}

fn divergence(ray: &Ray, (one, distance): (&AnyShape, f64), other: &AnyShape) -> Divergence {
    let normals = [one, other].map(|shape| shape.normal(ray.at(distance)));
    let [cosine, other_cosine] = normals.map(|normal| ray.dir.dot(normal));
    let per_shift = (normals[0] / cosine - normals[1] / other_cosine).length();
    Divergence { per_shift, cosine: larger(cosine.abs().min(other_cosine.abs()), LEAST_COSINE) }
}

/// Returns how far the rounding of its direction shifts a ray sideways at a distance: two ulps in each of three
/// components are less than 4 ulps in length.
fn shift(distance: f64) -> f64 {
    4.0 * f64::EPSILON * distance
}

/// Tells whether two distances may be equal up to rounding, and have no more digits that decide: one of them is a copy's, or
/// the ray grazes a surface so that its own rounding moves the hit by more than that.
pub(super) fn is_unclear(
    ray: &Ray,
    (one, distance): (&AnyShape, f64),
    (other, far): (&AnyShape, f64),
) -> bool {
    let apart = (distance - far).abs();
    if apart > close(ray, distance) {
        return apart <= shift(distance) * divergence(ray, (one, distance), other).per_shift;
    }
    let has_digits = |shape: &AnyShape, at: f64| shape.packets().fine_distance(ray, at).is_some();
    !(has_digits(one, distance) && has_digits(other, far))
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
