//! What can be checked of hits that cannot be proven: whether they agree with those of other rays along the same line.
//!
//! A ray that starts nearer to a hit, or beyond it and comes back, meets the same point. A plugin that loses digits to
//! cancellation, or steps over its surface, contradicts itself.

use crate::sampling::places;
use std::collections::BTreeMap;
use std::fmt;
use tabray_core::geometry::ray::{MISS, Ray, RayRange};
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Object;
use tabray_core::text::{count, short};
use tabray_core::world::certify::Premise;
use tabray_core::world::coincidence;

/// The number of pixels through whose centres rays go.
const RAYS: usize = 4096;

/// The parts of the distance of a hit by which a ray starts nearer to it.
const NEARER: [f64; 3] = [0.25, 0.5, 0.9375];

/// The part of the distance of a hit by which a ray that comes back starts beyond it.
const BEYOND: f64 = 1.0 / 64.0;

/// The ratio of a difference to the error that any hit may have from which on hits differ: both have errors.
const DIFFER: f64 = 4.0;

/// An entity type whose hits cannot be proven.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unchecked {
    /// The name of the type.
    pub of: &'static str,
    /// The number of hits that were compared with those of other rays.
    pub hits: usize,
    /// The number of hits that other rays do not meet.
    pub differ: usize,
    /// The largest difference, in world units, where other rays meet the shape at all.
    pub most: f64,
}

/// Lists the entity types of a plan's scene that have no equation, by name.
pub fn of(plan: &Plan) -> Vec<Unchecked> {
    let mut found: BTreeMap<&'static str, Unchecked> = BTreeMap::new();
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

/// Compares the hits of an object on the rays of some pixels with those of other rays along the same lines.
fn compare(plan: &Plan, object: &Object) -> Unchecked {
    let mut found = Unchecked::default();
    let max_coordinate = object.shape.facts().max_coordinate;
    for [x, y] in places::spread(plan.camera.pixels, RAYS) {
        let ray = plan.camera.ray(x as f64, y as f64);
        let distance = object.shape.distance(&ray, &RayRange::ALL);
        if distance == MISS {
            continue;
        }
        let normal = object.shape.normal(ray.at(distance));
        let allowed = DIFFER * coincidence::error(&ray, distance, normal, max_coordinate);
        let nearer = NEARER.map(|part| {
            let from = Ray { origin: ray.at(part * distance), dir: ray.dir };
            (object.shape.distance(&from, &RayRange::ALL) - (1.0 - part) * distance).abs()
        });
        let back = Ray { origin: ray.at((1.0 + BEYOND) * distance), dir: -ray.dir };
        // Another part of the shape may be met first.
        let beyond = (object.shape.distance(&back, &RayRange::ALL) - BEYOND * distance).max(0.0);
        let off = nearer.into_iter().chain([beyond]);
        found.hits += 1;
        found.differ += usize::from(off.clone().any(|off| off > allowed));
        found.most = off.filter(|off| *off < f64::INFINITY).fold(found.most, f64::max);
    }
    found
}

impl fmt::Display for Unchecked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, hits, differ, most } = self;
        write!(f, "not checked: `{of}` has no equation; ")?;
        let hits = count(*hits, "hit");
        match differ {
            0 => write!(f, "{hits} agree with those of rays that start nearer or come back"),
            _ => write!(
                f,
                "{differ} of {hits} differ from those of rays that start nearer or come back, by up to {} world units",
                short(*most)
            ),
        }
    }
}
