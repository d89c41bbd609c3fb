//! What can be checked of hits without a proof of each: whether they agree with those of other rays, and how far they are
//! off the surface where it has an equation.
//!
//! A ray that starts nearer to a hit, or beyond it and comes back, meets the same point, and its neighbours meet points
//! beside it. A plugin that loses digits to cancellation, or steps over its surface, contradicts itself.

use crate::off_surface;
use crate::sampling::places;
use std::collections::BTreeMap;
use std::fmt;
use tabray_core::geometry::ray::{MISS, Ray, RayRange};
use tabray_core::render::plan::Plan;
use tabray_core::render::trace;
use tabray_core::scene::model::Object;
use tabray_core::text::{count, short};
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::certify::Premise;
use tabray_core::world::coincidence::{self, ROUNDING};

/// The number of pixels through whose centres rays go.
const RAYS: usize = 4096;

/// The parts of the distance of a hit by which a ray starts nearer to it.
const NEARER: [f64; 3] = [0.25, 0.5, 0.9375];

/// The part of the distance of a hit by which a ray that comes back starts beyond it.
const BEYOND: f64 = 1.0 / 64.0;

/// The ratio of a difference to the error that any hit may have from which on hits differ: both have errors.
const DIFFER: f64 = 4.0;

/// The distance to rays on all sides of one that misses, and the greatest difference of their hits for which these are of
/// one surface, which then lacks a hit: as fractions of the numbers that a distance is computed from.
const ASIDE: f64 = 1e-10;
const EVEN: f64 = 10.0 * ASIDE;

/// An entity type whose hits cannot be proven, or are off the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unchecked {
    /// The name of the type.
    pub of: &'static str,
    /// Whether its surface has an equation.
    pub has_equation: bool,
    /// The number of hits that were looked at.
    pub hits: usize,
    /// The number of hits that other rays do not meet or, with an equation, that are off the surface.
    pub differ: usize,
    /// The largest difference, in world units, where other rays meet the shape at all.
    pub most: f64,
}

/// Lists the entity types of a plan's scene that have no equation, and those with hits that are off the surface, by name.
pub fn of(plan: &Plan) -> Vec<Unchecked> {
    let mut found: BTreeMap<&'static str, Unchecked> = BTreeMap::new();
    // The others promise no more than 1/1000 of a world unit.
    if matches!(plan.camera.accuracy, Accuracy::Exact | Accuracy::Strict) {
        found = off(plan);
    }
    for object in &plan.model.objects {
        let mut types = Vec::new();
        object.shape.premises(object.args.entity().name, &mut |of, premise| {
            if premise == Premise::NoEquation && !types.contains(&of) {
                types.push(of);
            }
        });
        if types.is_empty() {
            continue;
        }
        let own = compare(plan, object);
        for of in types {
            let all = found.entry(of).or_insert(Unchecked { of, ..Unchecked::default() });
            (all.hits, all.differ) = (all.hits + own.hits, all.differ + own.differ);
            all.most = all.most.max(own.most);
        }
    }
    found.into_values().collect()
}

/// Lists the entity types with hits of the image that are off the surface that their equation tells.
fn off(plan: &Plan) -> BTreeMap<&'static str, Unchecked> {
    let mut found: BTreeMap<&'static str, Unchecked> = BTreeMap::new();
    let sights: Vec<_> = places::spread(plan.camera.pixels, RAYS)
        .into_iter()
        .map(|[x, y]| plan.camera.sight(x as f64, y as f64))
        .collect();
    for (sight, hit) in sights.iter().zip(trace::first_hits(plan, &sights, false)) {
        let Some(hit) = hit.filter(|hit| hit.object.shape.is_certified()) else { continue };
        let of = hit.object.args.entity().name;
        let all = found.entry(of).or_insert(Unchecked { of, has_equation: true, ..Unchecked::default() });
        let allowed = DIFFER * ROUNDING * size(&sight.ray(), hit.distance, hit.object);
        all.hits += 1;
        if let Some(off) = off_surface::beyond(&hit.object.shape, sight, hit.point, allowed) {
            all.differ += 1;
            all.most = all.most.max(off);
        }
    }
    found.retain(|_, all| all.differ > 0);
    found
}

/// Returns the size of the numbers that a distance is computed from, in world units.
fn size(ray: &Ray, distance: f64, object: &Object) -> f64 {
    ray.origin.abs().max_element() + distance + object.shape.facts().max_coordinate
}

/// Compares the hits of an object on the rays of some pixels with those of other rays.
fn compare(plan: &Plan, object: &Object) -> Unchecked {
    let mut found = Unchecked::default();
    for [x, y] in places::spread(plan.camera.pixels, RAYS) {
        let ray = plan.camera.ray(x as f64, y as f64);
        let distance = object.shape.distance(&ray, &RayRange::ALL);
        if distance == MISS {
            let is_lost = is_lost(object, &ray);
            found.hits += usize::from(is_lost);
            found.differ += usize::from(is_lost);
            continue;
        }
        let normal = object.shape.normal(ray.at(distance));
        let max_coordinate = object.shape.facts().max_coordinate;
        let allowed = DIFFER * coincidence::error(&ray, distance, normal, max_coordinate);
        let nearer = NEARER.map(|part| {
            let from = Ray { origin: ray.at(part * distance), dir: ray.dir };
            (object.shape.distance(&from, &RayRange::ALL) - (1.0 - part) * distance).abs()
        });
        let back = Ray { origin: ray.at((1.0 + BEYOND) * distance), dir: -ray.dir };
        // Another part of the shape may be met first.
        let beyond = (object.shape.distance(&back, &RayRange::ALL) - BEYOND * distance).max(0.0);
        let [a, b, c, d] = beside(object, &ray, ROUNDING, size(&ray, distance, object))
            .map(|neighbour| if neighbour == distance { 0.0 } else { (neighbour - distance).abs() });
        // On one side, the surface may end.
        let off = nearer.into_iter().chain([beyond, a.min(b), c.min(d)]);
        found.hits += 1;
        found.differ += usize::from(off.clone().any(|off| off > allowed));
        found.most = off.filter(|off| *off < f64::INFINITY).fold(found.most, f64::max);
    }
    found
}

/// Returns the distances of four rays that start beside a ray and lead away from it, by a part of a size, in pairs on
/// opposite sides. Surfaces often end along axes, and the pairs do not lie along these.
fn beside(object: &Object, ray: &Ray, part: f64, size: f64) -> [f64; 4] {
    let (across, up) = ray.dir.any_orthonormal_pair();
    [across + up, -across - up, across - up, up - across].map(|aside| {
        let aside = 0.5 * part * aside;
        let neighbour = Ray { origin: ray.origin + size * aside, dir: (ray.dir + aside).normalize() };
        object.shape.distance(&neighbour, &RayRange::ALL)
    })
}

/// Tells whether a ray that misses an object falls through a gap that the rays on all its sides do not see.
fn is_lost(object: &Object, ray: &Ray) -> bool {
    let size = |distance| size(ray, distance, object);
    let found = beside(object, ray, ASIDE, size(0.0));
    let [least, most] = [found.into_iter().fold(MISS, f64::min), found.into_iter().fold(0.0, f64::max)];
    most < MISS && most - least <= EVEN * size(most)
}

impl fmt::Display for Unchecked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, has_equation, hits, differ, most } = self;
        let (hits, most) = (count(*hits, "hit"), short(*most));
        if *has_equation {
            return write!(
                f,
                "`{of}`: {differ} of {hits} are off the surface of its equation, by up to {most} world units"
            );
        }
        write!(f, "not checked: `{of}` has no equation; ")?;
        match differ {
            0 => write!(f, "{hits} agree with those of rays beside them, that start nearer or come back"),
            _ => write!(
                f,
                "{differ} of {hits} differ from those of rays beside them, that start nearer or come back, by up to \
                 {most} world units"
            ),
        }
    }
}
