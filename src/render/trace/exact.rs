//! Decisions about single rays where rounding leaves the hits of a packet in doubt: whether a ray hits a shape, which
//! of two shapes it hits first, and which hits 237 bits leave undecided.

use super::context::{Tracer, UndecidedPixel, UndecidedRay};
use super::ray_group::{HitRecord, RayGroup};
use crate::observer::Count;
use std::cmp::Ordering;
use std::mem::take;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_world::any_shape::AnyShape;
use tabray_world::certify::{self, Doubt, Enclosure, Precision};
use tabray_world::coincidence::{CLOSE, MIN_COSINE, SAME, close};
use tabray_world::geometry::aabb::larger;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use tabray_world::geometry::sight::Sight;

/// A rounded ray, and the bounds of the true ray that it stands for.
pub(super) struct RoundedRay {
    pub ray: Ray,
    /// A bound on the error of the origin, in world units.
    pub error: f64,
    /// The unrounded ray, if it is a primary ray.
    pub sight: Option<Sight>,
}

impl RoundedRay {
    /// Returns the side of a shape that the ray leaves, if the ray starts on the shape. `own` is that side if the shape
    /// belongs to the object that the ray leaves. Another shape that passes through the same point is left, too.
    pub fn leaves(&self, shape: &AnyShape, own: Option<Side>) -> Option<Side> {
        let Ray { origin, dir } = self.ray;
        let touched = || Side::seen_along(dir, shape.normal(origin)).opposite();
        own.or_else(|| (self.error > 0.0 && shape.is_on_surface(origin, self.error)).then(touched))
    }
}

/// A ray's hit of a shape.
pub(super) struct Located {
    /// The exact distance, in world units, or [`MISS`].
    pub distance: f64,
    /// A bracket of that distance and of the distance along the unrounded ray.
    pub bracket: Bracket,
    /// If 237 bits do not decide whether the ray hits the shape: the least distance of a possible hit, as a multiple
    /// of the length of the unrounded ray's direction.
    pub open: Option<Fraction>,
}

impl Located {
    /// Returns a hit at a known distance.
    fn known(distance: f64) -> Self {
        Self { distance, bracket: Bracket::exactly(distance), open: None }
    }

    /// No hit.
    const MISS: Self = Self { distance: MISS, bracket: Bracket::MISS, open: None };
}

/// Returns the distance, in world units, of a primary ray's hit of a shape, as the tracer decides it if a packet
/// leaves it in doubt, or [`MISS`]. `ray` is the rounded ray, and `sight` the unrounded one.
pub fn primary_distance(shape: &AnyShape, ray: Ray, sight: &Sight) -> f64 {
    exact(shape, &RoundedRay { ray, error: 0.0, sight: Some(sight.clone()) }, None, MISS)
}

/// Returns the exact distance of one ray's hit of a shape before `far`, in world units, or [`MISS`]. `origin_side` is
/// the side of the shape that the ray leaves, if the shape belongs to the object that the packet leaves.
pub(super) fn exact(shape: &AnyShape, start: &RoundedRay, origin_side: Option<Side>, far: f64) -> f64 {
    located(shape, start, origin_side, far).distance
}

/// Returns the hit whose distance [`exact`] returns.
pub(super) fn located(shape: &AnyShape, start: &RoundedRay, origin_side: Option<Side>, far: f64) -> Located {
    match start.leaves(shape, origin_side) {
        Some(side) if !shape.can_hit_itself(side) => return Located::MISS,
        None => {}
        origin_side => {
            let range = RayRange { far, origin_side, origin_error: start.error, ..RayRange::ALL };
            return Located::known(shape.distance(&start.ray, &range));
        }
    }
    let range = RayRange { far, ..RayRange::ALL };
    let Some(sight) = &start.sight else { return Located::known(shape.distance(&start.ray, &range)) };
    let bracket = shape.t_bounds(&start.ray, &RayRange::ALL);
    // A bracket of width 0 is the distance itself.
    let is_known = bracket.near == bracket.far;
    let distance = if is_known { range.keep(bracket.near) } else { shape.distance(&start.ray, &range) };
    // Where the rounding of the ray may decide whether it hits the shape, the unrounded ray decides.
    if bracket.is_doubtful() {
        decided(shape, sight, distance)
    } else {
        Located { distance, bracket, open: None }
    }
}

/// An enclosure of a distance wider than this fraction of the distance is too wide to be that of a point.
const WIDE: f64 = 64.0 * f64::EPSILON;

/// Returns a hit at this distance if the unrounded ray hits the shape, as far as a proof with 237 bits tells, and
/// none otherwise.
fn decided(shape: &AnyShape, sight: &Sight, distance: f64) -> Located {
    let enclosure = match shape.certify(sight, Precision::Double) {
        Enclosure::Edge(_) | Enclosure::Doubtful(_) => shape.certify(sight, Precision::Octuple),
        // An example is a ray that passes near the edge of a face that it grazes: much of the ray is near the face.
        Enclosure::Hits(at) if at.width().to_f64() > WIDE * at.high.to_f64() => {
            shape.certify(sight, Precision::Octuple)
        }
        certain => certain,
    };
    match enclosure {
        Enclosure::Misses => Located::MISS,
        // Edges belong to their surfaces.
        Enclosure::Hits(at) | Enclosure::Edge(at) => {
            let Interval { low, high } = certify::bounds_in_world_units(at, sight);
            let bracket = Bracket { near: low, far: high };
            Located { distance: distance.clamp(low, high), bracket, open: None }
        }
        // What is undecided lies beyond the computed distance, as for a ray that is parallel to a plane up to rounding.
        Enclosure::Doubtful(from) if in_world_units(from, sight) * (1.0 - CLOSE) > distance => {
            Located { open: Some(from), ..Located::MISS }
        }
        Enclosure::Doubtful(from) => Located { open: Some(from), ..Located::known(distance) },
    }
}

/// Converts a distance from lengths of a sight's direction to world units.
pub(super) fn in_world_units(distance: Fraction, sight: &Sight) -> f64 {
    certify::in_world_units(Wide::point(distance), sight).high
}

/// A bound on the error that the rounding of a copy's matrix causes in the distance of a hit at a right angle, as a
/// fraction of the coordinates: 512 units of 2^-53.
const COPIED: f64 = 256.0 * f64::EPSILON;

/// Tells whether a ray hits one shape before another, given their approximate distances in world units. Returns
/// `None` where the ray is not known well enough to tell. Its origin may be off by `origin_error` world units.
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
    let size =
        ray.origin.abs().max_element() + distance + one.facts().max_coordinate + other.facts().max_coordinate;
    if let (Some(fine), Some(fine_far)) =
        (one.packets().fine_distance(ray, distance), other.packets().fine_distance(ray, far))
    {
        let apart = (fine - fine_far).high;
        return (apart.abs() > lost + SAME * size / cosine).then_some(apart < 0.0);
    }
    // A copy's distance is off by the rounding of its matrix, and has no more digits.
    (apart > lost + COPIED * size / cosine).then_some(distance < far)
}

/// How fast two surfaces diverge near the point where a ray hits them.
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
    Divergence { per_shift, cosine: larger(cosine.abs().min(other_cosine.abs()), MIN_COSINE) }
}

/// Returns how far the rounding of its direction shifts a ray sideways at a distance: two ulps in each of three
/// components are less than 4 ulps in length.
fn shift(distance: f64) -> f64 {
    4.0 * f64::EPSILON * distance
}

/// Tells whether two distances may be equal up to rounding, with no further digits to decide: one of them is a
/// copy's, or the ray grazes a surface, and its own rounding moves the hit by more than their difference.
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

/// Returns the order in which a ray hits two shapes, by a proof with 237 bits: distances that these do not tell apart
/// are equal. `None` where the proof decides nothing.
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

impl Tracer<'_, '_> {
    /// Notes the pixels of a packet with undecided hits no farther than their rays' certain hits. For a shape without
    /// an equation, nothing is decided, and its own distance counts.
    #[cold]
    pub(super) fn note_undecided(&mut self, group: &RayGroup, hits: &HitRecord) {
        let rays = take(&mut self.scratch.undecided.rays);
        if !group.looks || self.scratch.are_probes {
            return;
        }
        for UndecidedRay { lane, object, from } in rays {
            let shape = &self.model.objects[object].shape;
            let Some(sight) = self.start(group, lane).sight else { continue };
            if let Some(proven) = shape.proven()
                && shape.is_certified()
                && (hits.hit_ids[lane] == object as u64 + 1 || in_world_units(from, &sight) <= hits.far[lane])
            {
                let (number, doubt) = (self.pixel_of(lane), Doubt::of(proven, &sight, from));
                let at = sight.line::<f64>().at(from.to_f64()).into();
                self.scratch.undecided.pixels.push(UndecidedPixel { number, object, doubt, at });
            }
        }
    }

    /// Returns the number of the pixel of a primary ray.
    fn pixel_of(&self, lane: usize) -> u32 {
        let [x, y] = &self.scratch.places;
        match self.scratch.samples.get(lane) {
            Some(sample) => sample.pixel,
            None => self.plan.camera.seed(x[lane] as i64, y[lane] as i64),
        }
    }

    /// Reports each pixel that has been noted, once.
    #[cold]
    pub(super) fn report_undecided(&mut self) {
        let mut pixels = take(&mut self.scratch.undecided.pixels);
        pixels.sort_by(|one, other| {
            let key = |of: &UndecidedPixel| (of.number, of.object);
            key(one).cmp(&key(other)).then_with(|| one.doubt.cmp(&other.doubt))
        });
        pixels.dedup_by_key(|pixel| pixel.number);
        for UndecidedPixel { object, doubt, at, .. } in pixels {
            self.observer.count(Count::Undecided(object, doubt, at));
        }
    }
}
