//! Tries an object with rays: how they are aimed, and the order in which promises are checked.

use super::draw::Draw;
use super::looks::shader;
use super::promise::{Fault, Promise};
use super::shape::{GRAZING, RayTrial, in_range};
use glam::DVec3;
use tabray_core::geometry::ray::{MISS, Ray, RayRange, Side};
use tabray_core::scene::model::Object;
use tabray_core::scene::value::Datum;
use tabray_core::simd::cpu::Cpu;

/// The number of first rays that are aimed exactly at a point, which may be a corner or the centre of an object.
const EXACT: usize = 6;

/// The greatest distance from the origin of a point that rays are aimed at, in world units: numbers beyond are limits,
/// not positions.
const FAR: f64 = 1e4;

/// The result of trying a shape.
pub struct Outcome {
    /// The number of rays that hit the shape.
    pub hits: usize,
    /// The gravest fault that was found.
    pub gravest: Option<Fault>,
}

/// Traces rays at an object.
pub fn try_object(object: &Object, draw: &mut Draw, rays: usize) -> Outcome {
    let mut aims = aims(object);
    let mut outcome = Outcome { hits: 0, gravest: None };
    for index in 0..rays {
        let ray = ray(&aims, draw, index);
        let tried = try_ray(&RayTrial { shape: &object.shape, ray, is_exact: index < EXACT }, index, draw);
        let tried = tried.and_then(|hit| match hit {
            Some(at) => {
                let side = Side::seen_along(ray.dir, object.shape.normal(at));
                shader(&*object.shader, &object.surface_point(at, side)).map(|()| Some(at))
            }
            None => Ok(None),
        });
        match tried {
            // Each hit becomes a new aim, as the object may be small.
            Ok(Some(at)) => {
                outcome.hits += 1;
                aims.push(at);
            }
            Ok(None) => {}
            Err(fault) => {
                let ends = fault.promise == Promise::RayIsQuick;
                if outcome.gravest.as_ref().is_none_or(|gravest| fault.promise < gravest.promise) {
                    outcome.gravest = Some(fault);
                }
                // Hundreds of rays would take long.
                if ends {
                    break;
                }
            }
        }
    }
    outcome
}

/// Returns points where the object may be: any three numbers of an attribute may be a point.
fn aims(object: &Object) -> Vec<DVec3> {
    let mut aims = vec![DVec3::ZERO];
    for (_, datum) in object.args.args().values() {
        if let Datum::Numbers(numbers) = datum {
            aims.extend(numbers.as_chunks::<3>().0.iter().map(|point| DVec3::from(*point)));
        }
    }
    aims.extend(object.shape.facts().bounds.map(|bounds| bounds.middle()));
    aims.retain(|aim| aim.abs().max_element() <= FAR);
    aims
}

/// Makes a ray toward a point near one of the aims; the first rays are parallel to the axes and aimed exactly.
fn ray(aims: &[DVec3], draw: &mut Draw, index: usize) -> Ray {
    let aim = aims[(draw.part() * aims.len() as f64) as usize % aims.len()];
    if index < EXACT {
        let axis = DVec3::AXES[index % 3];
        let dir = if index < 3 { axis } else { -axis };
        return Ray { origin: aim - 10.0 * dir, dir };
    }
    // The offset is from 0.01 to 10 world units, evenly distributed over its logarithm.
    let off = draw.direction() * libm::exp10(draw.part() * 3.0 - 2.0);
    let from = draw.direction() * (0.5 + 20.0 * draw.part());
    let dir = (off - from).normalize();
    Ray { origin: aim + from, dir }
}

/// Checks a shape with one ray, the given number of its rays; returns the point of the hit, if there is one.
fn try_ray(tried: &RayTrial, number: usize, draw: &mut Draw) -> Result<Option<DVec3>, Fault> {
    let distance = in_range(tried.distance_in_time()?, &tried.ray, &RayRange::ALL)?;
    tried.check_repeats(distance)?;
    let levels: Vec<_> = Cpu::all().collect();
    tried.check_packets(distance, levels[number % levels.len()])?;
    tried.check_drift()?;
    tried.check_ranges(distance)?;
    tried.check_proof(distance)?;
    tried.check_beside(distance)?;
    if distance == MISS {
        return Ok(None);
    }
    let met = tried.hit_at(distance)?;
    tried.check_bounds(met.at)?;
    if !tried.is_exact {
        tried.check_from_elsewhere(&met, draw)?;
    }
    if !tried.is_exact && met.normal.dot(tried.ray.dir).abs() >= GRAZING {
        tried.check_off(&tried.ray, distance)?;
        tried.check_from_afar(&met)?;
        tried.check_normal(&met)?;
        if !tried.shape.can_hit_itself(Side::Outside) {
            tried.check_convex(&met)?;
        }
        tried.check_leaving(&met, draw)?;
        tried.is_touched(&met, draw)?;
    }
    // After all these rays, the first one has the same hit.
    tried.check_repeats(distance)?;
    Ok(Some(met.at))
}
