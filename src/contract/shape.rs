//! The contract of [`Hittable`], tried with rays.

use super::draw::Draw;
use super::looks::{same_bits, shader};
use super::promise::{Fault, Promise};
use crate::bounds::Bounds;
use crate::certify::Enclosure;
use crate::cpu::Cpu;
use crate::geometry::{Hittable, MISS, Ray, Side, Span};
use crate::model::Object;
use crate::packet::{Rays, STEP, Vectors};
use crate::value::Datum;
use glam::DVec3;

/// How far off a distance may be, as a part of the numbers that it is computed from.
const SLACK: f64 = 1e-7;

/// A step that is far longer than that, and far shorter than what is to be seen.
const STRIDE: f64 = 1e-4;

/// Rays that meet a surface at a smaller cosine graze it: rounding tells how they fare.
const GRAZING: f64 = 0.05;

/// The first rays, which go exactly to what may be a corner or a middle.
const EXACT: usize = 3;

/// What lies farther away than this is not aimed at: there is nothing but limits.
const FAR: f64 = 1e4;

/// What comes of trying a shape.
pub struct Outcome {
    /// How many rays met it.
    pub hits: usize,
    /// The gravest fault.
    pub faults: Option<Fault>,
}

/// Sends rays at an object.
pub fn faults(object: &Object, draw: &mut Draw, rays: usize) -> Outcome {
    let mut aims = aims(object);
    let mut outcome = Outcome { hits: 0, faults: None };
    for index in 0..rays {
        let ray = ray(&aims, draw, index);
        let tried = try_ray(&Tried { shape: &*object.shape, ray, is_exact: index < EXACT }, draw);
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
                if outcome.faults.as_ref().is_none_or(|gravest| fault.promise < gravest.promise) {
                    outcome.faults = Some(fault);
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

/// A shape and a ray that it is tried with.
struct Tried<'s> {
    shape: &'s dyn Hittable,
    ray: Ray,
    /// Whether it may meet an edge or a corner, where rounding tells what is met from elsewhere.
    is_exact: bool,
}

/// A hit that rounding does not blur.
struct Met {
    distance: f64,
    at: DVec3,
    normal: DVec3,
}

/// Tries a shape with a ray; where it is met, if it is.
fn try_ray(tried: &Tried, draw: &mut Draw) -> Result<Option<DVec3>, Fault> {
    let distance = tried.in_span(&tried.ray, &Span::RAY)?;
    tried.repeats(distance)?;
    tried.packets_agree(distance)?;
    tried.keeps_to_spans(distance)?;
    tried.agrees_with_its_proof(distance)?;
    if distance == MISS {
        return Ok(None);
    }
    let met = tried.met(distance)?;
    tried.is_held(met.at)?;
    if !tried.is_exact && met.normal.dot(tried.ray.dir).abs() >= GRAZING {
        tried.is_met_from_elsewhere(&met, draw)?;
        tried.stands_upright(&met)?;
        if tried.shape.is_convex() {
            tried.is_convex(&met, draw)?;
        } else {
            tried.leaves(&met, draw)?;
        }
    }
    Ok(Some(met.at))
}

impl Tried<'_> {
    /// How exact distances are where the ray is.
    fn size(&self, distance: f64) -> f64 {
        1.0 + self.ray.origin.abs().max_element() + distance
    }

    /// The distance along a ray, which is a sound one.
    fn in_span(&self, ray: &Ray, within: &Span) -> Result<f64, Fault> {
        let distance = self.shape.distance(ray, within);
        if distance == MISS || (within.near < distance && distance < within.far) {
            return Ok(distance);
        }
        let Span { near, far, .. } = within;
        Err(Promise::DistanceIsInItsSpan
            .fault(format!("`distance` gives {distance} between {near} and {far}, {}", told(ray))))
    }

    fn repeats(&self, distance: f64) -> Result<(), Fault> {
        let again = self.shape.distance(&self.ray, &Span::RAY);
        if again.to_bits() == distance.to_bits() {
            return Ok(());
        }
        Err(Promise::DistanceIsTheSameAgain
            .fault(format!("first {distance}, then {again}, {}", told(&self.ray))))
    }

    fn packets_agree(&self, distance: f64) -> Result<(), Fault> {
        let Self { shape, ray, .. } = self;
        let fault = |found: String| Err(Promise::PacketsAgree.fault(format!("{found}, {}", told(ray))));
        let bracket = shape.bracket(ray, &Span::RAY);
        if bracket.near.is_nan() || bracket.far.is_nan() || bracket.near > distance || distance > bracket.far
        {
            return fault(format!("`distance` gives {distance}, and `bracket` {bracket:?}"));
        }
        let quick = shape.quick_distance(ray, &Span::RAY);
        if !quick.is_nan() && quick.to_bits() != distance.to_bits() {
            return fault(format!("`distance` gives {distance}, and `quick_distance` {quick}"));
        }
        let at = ray.at(if distance == MISS { 1.0 } else { distance });
        let lanes = |of: DVec3| Vectors::<STEP> { x: [of.x; STEP], y: [of.y; STEP], z: [of.z; STEP] };
        let (origin, dir, points) = (lanes(ray.origin), lanes(ray.dir), lanes(at));
        for cpu in Cpu::all() {
            let (mut many, mut normals) = ([0.0; STEP], Vectors::<STEP>::ZERO);
            shape.distances(cpu, Rays { origin: origin.view(STEP), dir: dir.view(STEP) }, None, &mut many);
            if many[0].to_bits() != quick.to_bits() && !(many[0].is_nan() && quick.is_nan()) {
                return fault(format!("{quick} in single rays, and {} in packets ({cpu})", many[0]));
            }
            if distance != MISS {
                shape.normals(cpu, points.view(STEP), normals.view_mut(STEP));
                let (one, many) = (shape.normal(at), normals.get(0));
                if !same_bits(one, many) && one.is_finite() {
                    return fault(format!("the normal {one} in single rays, and {many} in packets ({cpu})"));
                }
            }
        }
        Ok(())
    }

    /// What lies outside of a span is no hit.
    fn keeps_to_spans(&self, distance: f64) -> Result<(), Fault> {
        let slack = SLACK * self.size(if distance == MISS { 0.0 } else { distance });
        let middle = if distance == MISS { 5.0 } else { distance };
        for within in [
            Span { far: middle - slack, ..Span::RAY },
            Span { near: middle + slack, ..Span::RAY },
            Span { near: 0.5 * middle, far: 0.5 * middle + slack, ..Span::RAY },
        ] {
            self.in_span(&self.ray, &within)?;
        }
        let until = self.in_span(&self.ray, &Span { far: middle + slack, ..Span::RAY })?;
        if distance != MISS && (until - distance).abs() > slack {
            return Err(Promise::HitIsOnTheSurface.fault(format!(
                "`distance` gives {distance}, and {until} where the span ends behind that, {}",
                told(&self.ray)
            )));
        }
        Ok(())
    }

    fn agrees_with_its_proof(&self, distance: f64) -> Result<(), Fault> {
        let proven = self.shape.certify(&self.ray);
        let slack = SLACK * self.size(if distance == MISS { 0.0 } else { distance });
        let agrees = match proven {
            Enclosure::Misses => distance == MISS,
            Enclosure::Hits(hit) => hit.low - slack <= distance && distance <= hit.high + slack,
            Enclosure::Doubtful(from) => from - slack <= distance,
        };
        if agrees {
            return Ok(());
        }
        let found = format!("`distance` gives {distance}, and `certify` {proven:?}, {}", told(&self.ray));
        Err(Promise::AgreesWithItsProof.fault(found))
    }

    /// The hit at a distance, whose normal is a unit vector.
    fn met(&self, distance: f64) -> Result<Met, Fault> {
        let at = self.ray.at(distance);
        let normal = self.shape.normal(at);
        if (normal.length() - 1.0).abs() <= 1e-9 {
            return Ok(Met { distance, at, normal });
        }
        let found = format!("at {at} the normal is {normal}, of length {}", normal.length());
        Err(Promise::NormalIsUnit.fault(found))
    }

    fn is_held(&self, at: DVec3) -> Result<(), Fault> {
        let around = Bounds { low: at - STRIDE, high: at + STRIDE };
        if self.shape.is_clear_of(&around) {
            let found = format!("it says that it is clear of {around:?}, and is hit at {at}");
            return Err(Promise::BoundsHoldHits.fault(found));
        }
        match self.shape.bounds() {
            Some(bounds) if !bounds.with_slack(100.0).overlaps(&Bounds { low: at, high: at }) => {
                Err(Promise::BoundsHoldHits.fault(format!("it is hit at {at}, outside of {bounds:?}")))
            }
            _ => Ok(()),
        }
    }

    /// The point of a hit is one for rays from nearer, from behind and from any side.
    fn is_met_from_elsewhere(&self, met: &Met, draw: &mut Draw) -> Result<(), Fault> {
        let (Ray { dir, .. }, stride) = (self.ray, STRIDE * self.size(met.distance));
        let mut origins = vec![self.ray.at(0.75 * met.distance), met.at + stride * dir];
        for _ in 0..4 {
            let from = draw.direction();
            if met.normal.dot(from).abs() >= GRAZING {
                origins.push(met.at + 3.0 * draw.part() * from + stride * from);
            }
        }
        for origin in origins {
            let way = met.at - origin;
            let ray = Ray { origin, dir: way.normalize() };
            let distance = self.in_span(&ray, &Span::RAY)?;
            if distance > way.length() + SLACK * self.size(met.distance) {
                return Err(Promise::HitIsOnTheSurface.fault(format!(
                    "it is hit at {}, {}; but `distance` gives {distance} for that point, which is {} away, {}",
                    met.at,
                    told(&self.ray),
                    way.length(),
                    told(&ray)
                )));
            }
        }
        Ok(())
    }

    /// Where the surface is smooth its normal is upright on it, and points to the side that those beside it point to.
    fn stands_upright(&self, met: &Met) -> Result<(), Fault> {
        let (across, up) = self.ray.dir.any_orthonormal_pair();
        let stride = STRIDE * self.size(met.distance).min(10.0);
        for aside in [stride * across, stride * up] {
            let beside = |aside: DVec3| {
                let ray = Ray { origin: self.ray.origin + aside, ..self.ray };
                let distance = self.shape.distance(&ray, &Span::RAY);
                (distance != MISS).then(|| ray.at(distance))
            };
            let (Some(one), Some(other)) = (beside(aside), beside(-aside)) else { continue };
            let between = other - one;
            // A bend, an edge or another part of the shape.
            if (one + other - 2.0 * met.at).length() > 1e-3 * between.length() {
                continue;
            }
            let lean = met.normal.dot(between.normalize());
            if lean.abs() > 0.01 {
                let found = format!(
                    "at {} it leans: {} instead of 90 degrees",
                    met.at,
                    libm::acos(lean).to_degrees()
                );
                return Err(Promise::NormalIsUpright.fault(found));
            }
            let (a, b) = (self.shape.normal(one), self.shape.normal(other));
            if a.dot(b) < 0.0 {
                return Err(Promise::NormalsAgree.fault(format!("{a} at {one}, and {b} at {other}")));
            }
        }
        Ok(())
    }

    /// What is convex is met by no ray that leaves it; a ray that goes through it comes in from outside.
    fn is_convex(&self, met: &Met, draw: &mut Draw) -> Result<(), Fault> {
        let (Ray { dir, .. }, stride) = (self.ray, STRIDE * self.size(met.distance));
        let beyond = Ray { origin: met.at + stride * dir, dir };
        let through = self.in_span(&beyond, &Span::RAY)?;
        if through != MISS {
            let at = beyond.at(through);
            let behind = Ray { origin: at + stride * dir, dir };
            let sides = [(met.at, met.normal), (at, self.shape.normal(at))];
            let ends = self.in_span(&behind, &Span::RAY)? == MISS;
            match sides.map(|(_, normal)| Side::seen_along(dir, normal)) {
                // Too thin to be told from a touch.
                _ if through <= 10.0 * stride => {}
                [Side::Outside, Side::Inside] if ends => {}
                [Side::Inside, Side::Outside] if ends => {
                    let found =
                        format!("a ray goes through, and the normals are {sides:?}, {}", told(&self.ray));
                    return Err(Promise::NormalsPointOut.fault(found));
                }
                _ => {
                    let found = format!("a ray goes in or comes out twice, {}", told(&self.ray));
                    return Err(Promise::ConvexIsNotMetAgain.fault(found));
                }
            }
        }
        for _ in 0..4 {
            let dir = draw.direction();
            let dir = if dir.dot(met.normal) < 0.0 { -dir } else { dir };
            let ray = Ray { origin: met.at + stride * dir, dir };
            if dir.dot(met.normal) >= GRAZING && self.in_span(&ray, &Span::RAY)? != MISS {
                let found =
                    format!("`is_convex` says so, and a ray that leaves it meets it again, {}", told(&ray));
                return Err(Promise::ConvexIsNotMetAgain.fault(found));
            }
        }
        Ok(())
    }

    /// A ray that leaves the surface meets what it meets from a little farther.
    fn leaves(&self, met: &Met, draw: &mut Draw) -> Result<(), Fault> {
        let stride = STRIDE * self.size(met.distance);
        for _ in 0..4 {
            let dir = draw.direction();
            let cos = dir.dot(met.normal);
            if cos.abs() < GRAZING {
                continue;
            }
            let side = if cos > 0.0 { Side::Outside } else { Side::Inside };
            let ray = Ray { origin: met.at, dir };
            let leaving = self.in_span(&ray, &Span { leaves: Some(side), ..Span::RAY })?;
            let ahead = Ray { origin: ray.at(stride), dir };
            let from_ahead = self.in_span(&ahead, &Span::RAY)? + stride;
            let found = |what: String| Err(Promise::StartIsNoHit.fault(format!("{what}, {}", told(&ray))));
            if leaving <= SLACK * self.size(met.distance) {
                return found(format!("on leaving its {side:?} `distance` gives {leaving}"));
            }
            // What lies closer by than the step, and what is only grazed, is left alone.
            let is_near = |distance: f64| distance < 3.0 * stride;
            let grazes = |distance: f64| {
                distance != MISS && dir.dot(self.shape.normal(ray.at(distance))).abs() < GRAZING
            };
            let differ = leaving != from_ahead
                && (leaving - from_ahead).abs() > SLACK * self.size(from_ahead.min(leaving));
            let is_told =
                ![leaving, from_ahead].iter().any(|distance| is_near(*distance) || grazes(*distance));
            if differ && is_told {
                return found(format!(
                    "on leaving its {side:?} `distance` gives {leaving}, and from a little farther {from_ahead}"
                ));
            }
        }
        Ok(())
    }
}

/// A ray, in words.
fn told(Ray { origin, dir }: &Ray) -> String {
    format!("from {origin} along {dir}")
}
