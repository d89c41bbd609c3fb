//! Tries objects where their boxes end: with rays along the axes through their extremes, which a box that is too small
//! cuts off. What is inside of a shape is told by its equation alone, which knows no box.

use super::promise::{Fault, Promise};
use super::shape::{RayTrial, describe_ray, in_range};
use glam::{DVec2, DVec3};
use tabray_core::geometry::aabb::Aabb;
use tabray_core::geometry::ray::{MISS, Ray, RayRange};
use tabray_core::geometry::sight::Sight;
use tabray_core::scene::model::Object;
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::certify::{HitProofs, ProofMethods};
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::constants;

/// The number of places before a ray's first hit that are tried.
const PLACES: u32 = 32;

/// Other scenes with the object `tried`: its copies, and a union with one of them.
pub const VARIANTS: [&str; 3] = [
    "place copy { object tried scale 0.3 1.7 0.9 rotation 20 -35 50 translation 3 -1 2 }",
    "place copy { object tried scale 3 3 3 translation 100.1 -0.3 0.7 }",
    "place copy { object tried translation 0.1 0.2 -0.3 }\nunion whole { objects tried copy }",
];

/// Tries the objects of a scene.
///
/// # Errors
/// Fails if a ray takes long, hits an object outside of its bounds, or is inside of a closed object before its first hit of any.
pub fn try_objects(objects: &[Object]) -> Result<(), Fault> {
    for object in objects {
        let shape = &object.shape;
        let Some(Aabb { low, high }) = shape.facts().bounds else { continue };
        let length = (high - low).length();
        if length >= MISS || length.is_nan() {
            continue;
        }
        let middle = low.midpoint(high);
        let mut aims = vec![middle];
        for side in [low, high] {
            for axis in 0..3 {
                aims.push(extreme(shape, middle, 0.5 * (high - low), (axis, side[axis]))?);
            }
        }
        for aim in aims {
            for dir in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
                let ray = Ray { origin: aim - (1.5 * length + 1.0) * dir, dir };
                let tried = RayTrial { shape, ray, is_exact: true };
                let distance = in_range(tried.distance_in_time()?, &ray, &RayRange::ALL)?;
                if distance < MISS {
                    tried.check_bounds(ray.at(distance))?;
                }
                let distance = |object: &Object| object.shape.distance(&ray, &RayRange::ALL);
                let first = objects.iter().map(distance).fold(MISS, f64::min);
                check_before(shape, &ray, first)?;
            }
        }
    }
    Ok(())
}

/// Returns the point on a side of a box where the shape comes nearest to it or, if the shape is closed, where its
/// equation is least, which must not be below 0.
fn extreme(shape: &AnyShape, middle: DVec3, half: DVec3, (axis, side): (usize, f64)) -> Result<DVec3, Fault> {
    let (across, up) = ((axis + 1) % 3, (axis + 2) % 3);
    let on_side = |part: DVec2| {
        let mut at = middle;
        (at[axis], at[across], at[up]) =
            (side, middle[across] + part.x * half[across], middle[up] + part.y * half[up]);
        at
    };
    let outward = DVec3::AXES[axis] * if side > middle[axis] { 1.0 } else { -1.0 };
    let depth = |part: DVec2| {
        let origin = on_side(part) + (half.max_element() + 1.0) * outward;
        RayTrial { shape, ray: Ray { origin, dir: -outward }, is_exact: true }.distance_in_time()
    };
    let Some(proven) = of_closed(shape) else { return Ok(on_side(least(depth)?)) };
    let value = |part: DVec2| value(proven, constants(on_side(part)));
    let at = least(|part| Ok(value(part).middle()))?;
    // The bounds may be off by rounding.
    let beyond = on_side(at) + 1e-9 * (middle.abs() + half).max_element() * outward;
    if self::value(proven, constants(beyond)).high < 0.0 {
        let found = format!("the side {side} of its box cuts it: by its equation, {beyond} is inside");
        return Err(Promise::BoundsHoldHits.fault(found));
    }
    Ok(on_side(at))
}

/// Checks that a ray is nowhere inside of a closed shape before a distance.
fn check_before(shape: &AnyShape, ray: &Ray, first: f64) -> Result<(), Fault> {
    let (Some(proven), Some(Aabb { low, high })) = (of_closed(shape), shape.bounds()) else { return Ok(()) };
    let line = Sight::along(ray).line::<Interval>();
    let (away, half) = (low.midpoint(high).distance(ray.origin), 0.5 * (high - low).length());
    let (from, to) = ((away - half).max(0.0), first.min(away + half));
    for part in 1..=PLACES {
        // The last place is just before the hit.
        let part = (f64::from(part) / f64::from(PLACES)).min(1.0 - 1e-6);
        let t = from + part * (to - from);
        if value(proven, line.at(Interval::point(t))).high < 0.0 {
            let found = format!(
                "by its equation, a ray is inside at {}, before its first hit at {}, {}",
                ray.at(t),
                ray.at(first),
                describe_ray(ray)
            );
            return Err(Promise::BoundsHoldHits.fault(found));
        }
    }
    Ok(())
}

/// Returns the proofs of a closed shape with a single equation.
fn of_closed(shape: &AnyShape) -> Option<&dyn ProofMethods> {
    let proven = shape.proven().filter(|_| shape.is_certified())?;
    let proofs: &dyn HitProofs<f64> = proven;
    let is_single = proofs.has_equation(0) && proofs.face_of(0).is_none();
    (is_single && shape.why_not_closed().is_none()).then_some(proven)
}

/// Encloses the value of a shape's equation.
fn value(proven: &dyn ProofMethods, at: [Interval; 3]) -> Interval {
    HitProofs::<f64>::slope(proven, at.map(Dual::fixed), 0).value
}

/// Returns where a function on the square from -1 to 1 is least, or nearly so: the best place of a grid, improved by
/// smaller and smaller steps.
fn least(of: impl Fn(DVec2) -> Result<f64, Fault>) -> Result<DVec2, Fault> {
    let (mut best, mut at) = (MISS, DVec2::ZERO);
    let mut try_place = |place: DVec2| {
        let value = of(place)?;
        let is_better = value < best;
        if is_better {
            (best, at) = (value, place);
        }
        Ok(is_better.then_some(place))
    };
    let mut middle = DVec2::ZERO;
    for cell in 0..25 {
        let place = 0.4 * DVec2::new(f64::from(cell % 5) - 2.0, f64::from(cell / 5) - 2.0);
        middle = try_place(place)?.unwrap_or(middle);
    }
    let mut step = 0.2;
    while step > 1e-9 {
        let mut next = None;
        for aside in [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y] {
            let place = middle + step * aside;
            if place.abs().max_element() <= 1.0 {
                next = try_place(place)?.or(next);
            }
        }
        step *= if next.is_some() { 1.0 } else { 0.5 };
        middle = next.unwrap_or(middle);
    }
    Ok(at)
}
