//! Which of two surfaces a ray meets first, where rounding does not tell.

use crate::geometry::aabb::larger;
use crate::geometry::ray::Ray;
use crate::geometry::sight::Sight;
use crate::world::any_shape::AnyShape;
use crate::world::certify::{Enclosure, Precision};
use crate::world::coincidence::{CLOSE, LEAST_COSINE, SAME};

/// Whether a ray meets one shape before another, which both lie about so far away; nothing where they lie in one place
/// as far as the ray is known, whose origin may be off by an error.
///
/// Where two surfaces cross, a ray that is moved aside meets them in the other order. How far a ray may be aside follows
/// from what rounding makes of its direction, two units in the last place in each part, and from its origin's error.
pub(super) fn is_before(
    ray: &Ray,
    origin_error: f64,
    (one, distance): (&AnyShape, f64),
    (other, far): (&AnyShape, f64),
) -> Option<bool> {
    let size = ray.origin.abs().max_element() + distance;
    if (distance - far).abs() <= CLOSE * size
        && let (Some(fine), Some(fine_far)) =
            (one.packets().fine_distance(ray, distance), other.packets().fine_distance(ray, far))
    {
        let apart = (fine - fine_far).high;
        let normals = [one, other].map(|shape| shape.normal(ray.at(distance)));
        let [cosine, other_cosine] = normals.map(|normal| ray.dir.dot(normal));
        // How fast the distances part where the ray moves aside.
        let parting = (normals[0] / cosine - normals[1] / other_cosine).length();
        let aside = 4.0 * f64::EPSILON * distance + origin_error;
        let least = larger(cosine.abs().min(other_cosine.abs()), LEAST_COSINE);
        let same = aside * parting + SAME * (size + one.reach() + other.reach()) / least;
        return (apart.abs() > same).then_some(apart < 0.0);
    }
    (distance != far).then_some(distance < far)
}

/// Whether a ray meets one shape before another, with 237 bits; nothing where these do not tell.
pub(super) fn is_certainly_before(one: &AnyShape, other: &AnyShape, sight: &Sight) -> Option<bool> {
    let distance = |shape: &AnyShape| match shape.certify(sight, Precision::Octuple) {
        Enclosure::Hits(at) | Enclosure::Edge(at) => Some(at),
        Enclosure::Misses | Enclosure::Doubtful(_) => None,
    };
    let (one, other) = (distance(one)?, distance(other)?);
    (one.high < other.low || other.high < one.low).then_some(one.high < other.low)
}
