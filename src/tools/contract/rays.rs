//! An object, tried with rays: where they are sent, and in which order what they show is looked at.

use super::draw::Draw;
use super::looks::shader;
use super::promise::Fault;
use super::shape::{GRAZING, Tried};
use crate::geometry::ray::{MISS, Ray, RayRange, Side};
use crate::scene::model::Object;
use crate::scene::value::Datum;
use glam::DVec3;

/// The first rays, which go exactly to what may be a corner or a middle.
const EXACT: usize = 3;

/// What lies farther away than this is not aimed at: there is nothing but limits.
const FAR: f64 = 1e4;

/// What comes of trying a shape.
pub struct Outcome {
    /// How many rays met it.
    pub hits: usize,
    /// The gravest fault.
    pub gravest: Option<Fault>,
}

/// Sends rays at an object.
pub fn try_object(object: &Object, draw: &mut Draw, rays: usize) -> Outcome {
    let mut aims = aims(object);
    let mut outcome = Outcome { hits: 0, gravest: None };
    for index in 0..rays {
        let ray = ray(&aims, draw, index);
        let tried = try_ray(&Tried { shape: &object.shape, ray, is_exact: index < EXACT }, draw);
        let tried = tried.and_then(|hit| match hit {
            Some(at) => shader(&*object.shader, at).map(|()| Some(at)),
            None => Ok(None),
        });
        match tried {
            // What is met once is aimed at again: it may be small.
            Ok(Some(at)) => {
                outcome.hits += 1;
                aims.push(at);
            }
            Ok(None) => {}
            Err(fault) => {
                if outcome.gravest.as_ref().is_none_or(|gravest| fault.promise < gravest.promise) {
                    outcome.gravest = Some(fault);
                }
            }
        }
    }
    outcome
}

/// Where an object may be: every three of the numbers that it is made of may be a point.
fn aims(object: &Object) -> Vec<DVec3> {
    let mut aims = vec![DVec3::ZERO];
    for (_, datum) in object.args.values() {
        if let Datum::Numbers(numbers) = datum {
            aims.extend(numbers.as_chunks::<3>().0.iter().map(|point| DVec3::from(*point)));
        }
    }
    aims.extend(object.shape.bounds().map(|bounds| bounds.middle()));
    aims.retain(|aim| aim.abs().max_element() <= FAR);
    aims
}

/// A ray toward a place near one of these; at first along the axes, and exactly at them.
fn ray(aims: &[DVec3], draw: &mut Draw, index: usize) -> Ray {
    let aim = aims[(draw.part() * aims.len() as f64) as usize % aims.len()];
    if index < EXACT {
        return Ray { origin: aim - 10.0 * DVec3::AXES[index], dir: DVec3::AXES[index] };
    }
    // From far to close by, evenly over the powers of 10.
    let off = draw.direction() * libm::exp10(draw.part() * 3.0 - 2.0);
    let from = draw.direction() * (0.5 + 20.0 * draw.part());
    let dir = (off - from).normalize();
    Ray { origin: aim + from, dir }
}

/// Tries a shape with a ray; where it is met, if it is.
fn try_ray(tried: &Tried, draw: &mut Draw) -> Result<Option<DVec3>, Fault> {
    let distance = tried.in_span(&tried.ray, &RayRange::ALL)?;
    tried.repeats(distance)?;
    tried.packets_agree(distance)?;
    tried.keeps_to_spans(distance)?;
    tried.agrees_with_its_proof(distance)?;
    if distance == MISS {
        return Ok(None);
    }
    let met = tried.met(distance)?;
    tried.is_held(met.at)?;
    if !tried.is_exact {
        tried.is_met_from_elsewhere(&met, draw)?;
    }
    if !tried.is_exact && met.normal.dot(tried.ray.dir).abs() >= GRAZING {
        tried.stands_upright(&met)?;
        if !tried.shape.can_hit_itself(Side::Outside) {
            tried.is_convex(&met)?;
        }
        tried.leaves(&met, draw)?;
        tried.is_touched(&met, draw)?;
    }
    Ok(Some(met.at))
}
