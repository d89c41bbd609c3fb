//! Several surfaces through one point: which of them a ray sees, and which it leaves when it starts there.
//!
//! A point where a ray comes to a surface is rounded. A surface that lies no farther from it than that holds it, too, and
//! what starts there leaves both: a rug on a floor has no shadow of the floor on it, and a floor and a wall have no dots
//! where they meet. How far off the point is follows from the numbers that it was computed from; nothing is chosen.

use crate::geometry::bounds::larger;
use crate::geometry::ray::{Bracket, MISS, Ray, Span};
use crate::geometry::sight::{Line, Sight};
use crate::numeric::dual::Dual;
use crate::numeric::interval::Interval;
use crate::numeric::number::Number;
use crate::numeric::twofold::Twofold;
use crate::simd::cpu::kernels;
use crate::simd::soa::View;
use crate::world::certify::Equation;
use crate::world::hittable::Hittable;
use glam::DVec3;

/// What rounding may make of a point, as a part of the coordinates that it is computed from: 8 units in the last place
/// for its distance along the ray, and one and a half for each of the two operations that lead there, each way.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The least cosine that counts: at the square root of the rounding, a curved surface is met within that of where it is.
const LEAST_COSINE: f64 = 1.0 / (1 << 26) as f64;

/// Distances that differ by less than this part of them may be the same but for rounding.
const CLOSE: f64 = 1.0 / (1 << 30) as f64;

/// What is left of the difference of two distances in twice the precision where they are the same, as a part of the
/// coordinates: a few thousand of its last places.
const SAME: f64 = 1e-28;

/// How far the computed point of a hit may be from the true one, in world units: the error of a distance is that of a
/// place upright on the surface, divided by the cosine. `reach` is [`Hittable::reach`].
#[inline(always)]
pub fn error(ray: &Ray, distance: f64, normal: DVec3, reach: f64) -> f64 {
    let origin = ray.origin.abs();
    let size = larger(larger(origin.x, origin.y), origin.z) + distance + reach;
    ROUNDING * size / larger(ray.dir.dot(normal).abs(), LEAST_COSINE)
}

kernels! {
    /// Bounds of the errors of points that rays come to, as [`error`] has them, and the greatest of them. `reach` is that
    /// of the shape and of the viewer together: no ray starts farther from the viewer than its light has `travelled`.
    pub(crate) fn errors(dir: View, normals: View, travelled: &[f64], reach: f64, out: &mut [f64]) -> f64 {
        let count = out.len();
        let (dir, normals, travelled) = (dir.first(count), normals.first(count), &travelled[..count]);
        let mut most = 0;
        for lane in 0..count {
            let cosine = larger(dir.get(lane).dot(normals.get(lane)).abs(), LEAST_COSINE);
            // A division of single precision takes a third of the time, and what it rounds is nothing to a bound.
            out[lane] = ROUNDING * (travelled[lane] + reach) * f64::from(1.0 / cosine as f32);
            // None is below 0, and so their bits are in their order.
            most = most.max(out[lane].to_bits() as i64);
        }
        f64::from_bits(most as u64)
    }
}

/// The bracket of a shape that has no quicker one than its distance.
#[inline(always)]
pub(crate) fn bracket<T: Hittable + ?Sized>(shape: &T, ray: &Ray, within: &Span) -> Bracket {
    let Span { far, leaves, origin_error, .. } = *within;
    if leaves.is_none() && origin_error > 0.0 && shape.touches(ray.origin, origin_error) {
        return Bracket::UNKNOWN;
    }
    let close = if far < MISS { CLOSE * far } else { 0.0 };
    let distance = shape.distance(ray, &Span { far: far + close, ..*within });
    // At the distance of another surface, more digits tell which comes first.
    if (distance - far).abs() <= close {
        return Bracket { near: distance - close, far: distance + close };
    }
    Bracket::exactly(distance)
}

/// Whether a short ray through a point, upright on a shape, meets the shape within an error.
pub(crate) fn is_met_within<T: Hittable + ?Sized>(shape: &T, at: DVec3, error: f64) -> bool {
    let dir = shape.normal(at);
    let short = 2.0 * error + ROUNDING * at.abs().max_element();
    let ray = Ray { origin: at - short * dir, dir };
    shape.distance(&ray, &Span { far: 2.0 * short, ..Span::RAY }) < MISS
}

/// Whether a surface comes into the box of so many world units around a point: [`Hittable::touches`] of a shape that has
/// an equation.
pub fn touches(shape: &impl Equation, at: DVec3, error: f64) -> bool {
    let origin = at.to_array().map(|place| Interval { low: place - error, high: place + error });
    let point = Line { origin, dir: [Interval::constant(0.0); 3] };
    shape.value(shape.own(point).origin).has_zero()
}

/// The distance of a hit by Newton's method in twice the precision: [`Hittable::fine_distance`] of a shape that has an
/// equation. Nothing where that does not settle, as at a graze.
pub fn distance(shape: &impl Equation, ray: &Ray, near: f64) -> Option<Twofold> {
    let (mut at, mut moved) = (Twofold::from(near), f64::INFINITY);
    let line = shape.own(Sight::along(ray).line::<Twofold>());
    for _ in 0..4 {
        let Dual { value, slope } = shape.value(line.along(Dual::variable(at)));
        let step = value / slope;
        at = at - step;
        moved = step.high.abs();
    }
    let size = ray.origin.abs().max_element() + near;
    let is_settled = moved <= SAME * size && (at.high - near).abs() <= CLOSE * size;
    is_settled.then_some(at)
}

/// Whether a ray meets one shape before another, which both lie about so far away; nothing where they lie in one place
/// as far as the ray is known, whose origin may be off by an error.
///
/// Where two surfaces cross, a ray that is moved aside meets them in the other order. How far a ray may be aside follows
/// from what rounding makes of its direction, two units in the last place in each part, and from its origin's error.
pub(crate) fn is_before(
    ray: &Ray,
    origin_error: f64,
    (one, distance): (&dyn Hittable, f64),
    (other, far): (&dyn Hittable, f64),
) -> Option<bool> {
    let size = ray.origin.abs().max_element() + distance;
    if (distance - far).abs() <= CLOSE * size
        && let (Some(fine), Some(fine_far)) =
            (one.fine_distance(ray, distance), other.fine_distance(ray, far))
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
