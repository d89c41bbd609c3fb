//! The search for bounds that satisfy the inequalities of a scene.

use super::branch::ContinuationBounds;
use super::sides::{SIDES, Sides, above, gain};
use super::surface::SurfaceLight;
use crate::limits::MAX_DIST;
use glam::DVec3;
use tabray_world::geometry::aabb::SLACK;
use tabray_world::geometry::ray::Side;
use tabray_world::rules::Rules;
use tabray_world::scene::model::{Model, Object};

/// The number of iterations after which the search for bounds is given up.
const ROUNDS: usize = 50;

/// The maximum number of reflecting and transmitting objects for which the plan determines which objects lie behind
/// which.
const PAIRS: usize = 64;

/// The surfaces of a scene, and which others the rays from each may hit.
pub(super) struct VisibleSurfaces {
    surfaces: Vec<SurfaceLight>,
    /// The indices of the surfaces from which rays continue, and whether rays that leave one on a side may hit it
    /// again.
    shiny: Vec<(usize, Sides<bool>)>,
    /// For each pair of shiny surfaces, the sides of the one on which the other lies; empty for more than [`PAIRS`]
    /// surfaces.
    lies: Vec<Sides<bool>>,
    /// For each shiny surface and side, the largest light of the background and of the matt surfaces that may be hit
    /// from there.
    matt_light: Vec<Sides<f64>>,
}

impl VisibleSurfaces {
    /// Prepares a model's surfaces. `background` bounds the light of rays that hit nothing, times their path length:
    /// no ray starts where that is more than [`MAX_DIST`].
    pub fn new(model: &Model, surfaces: Vec<SurfaceLight>, background: f64) -> Self {
        let objects = &model.objects;
        let (shiny, matt): (Vec<_>, Vec<_>) =
            (0..surfaces.len()).partition(|index| surfaces[*index].goes_on());
        let is_few = shiny.len() <= PAIRS;
        let farthest = match model.camera.value.rules {
            Rules::Notes => MAX_DIST,
            // The coordinates of the scene's points bound the part of a path's length that matters.
            Rules::Free => model.camera.value.max_coordinate(),
        };
        let lies = |of: usize, object: usize| {
            if is_few { lies(&objects[of], &objects[object], farthest) } else { [true; 2] }
        };
        let matt_light = |of: usize| {
            let sent = matt
                .iter()
                .map(|object| lies(of, *object).map(|lies| if lies { surfaces[*object].own } else { 0.0 }));
            sent.fold([background; 2], |[one, other], [outside, inside]| {
                [above(one, outside), above(other, inside)]
            })
        };
        let matt_light = match shiny.first() {
            // Where it is not determined what lies behind what, each surface may be lit by all others.
            Some(first) if !is_few => vec![matt_light(*first); shiny.len()],
            _ => shiny.iter().map(|of| matt_light(*of)).collect(),
        };
        let pairs = shiny.iter().flat_map(|of| shiny.iter().map(|object| lies(*of, *object)));
        let lies = if is_few { pairs.collect() } else { Vec::new() };
        let meets = |index: usize| (index, SIDES.map(|side| can_hit_itself(&objects[index], side)));
        Self { shiny: shiny.into_iter().map(meets).collect(), lies, matt_light, surfaces }
    }

    /// Returns a bound on the light of primary rays, times the path length, and for each object how rays continue
    /// from it. `cuts` tells whether branches are cut at all.
    pub fn bounds(&self, cuts: bool) -> (f64, Vec<ContinuationBounds>) {
        let infinite = || vec![[f64::INFINITY; 2]; self.shiny.len()];
        let own = |surface: &SurfaceLight| surface.own;
        let beyond = self.solve(&self.matt_light, own).unwrap_or_else(infinite);
        let one = |light: f64| if light > 0.0 { 1.0 } else { 0.0 };
        let matt_light: Vec<_> = self.matt_light.iter().map(|matt_light| matt_light.map(one)).collect();
        let shares = self.solve(&matt_light, SurfaceLight::unit).unwrap_or_else(infinite);
        let hits = |own: &dyn Fn(&SurfaceLight) -> f64, beyond: &[Sides<f64>]| {
            let mut met: Vec<_> = self.surfaces.iter().map(own).collect();
            for ((index, _), beyond) in self.shiny.iter().zip(beyond) {
                let surface = &self.surfaces[*index];
                let [outside, inside] = surface.met(own(surface), *beyond);
                met[*index] = above(outside, inside);
            }
            met
        };
        let whole = hits(&SurfaceLight::unit, &shares).into_iter().fold(0.0, above);
        let hits = hits(&own, &beyond);
        let none = |(surface, hit): (&SurfaceLight, &f64)| ContinuationBounds {
            own: surface.own,
            hit: *hit,
            ..ContinuationBounds::NONE
        };
        let mut objects: Vec<_> = self.surfaces.iter().zip(&hits).map(none).collect();
        for (((index, _), beyond), shares) in self.shiny.iter().zip(&beyond).zip(&shares) {
            let continuation = self.surfaces[*index].continuation(*beyond, *shares, whole, cuts);
            objects[*index] = ContinuationBounds { hit: hits[*index], ..continuation };
        }
        (hits.into_iter().fold(0.0, above), objects)
    }

    /// Bounds the light of rays that leave each side of the surfaces from which rays continue; infinite where there
    /// is no bound.
    pub fn beyond(&self) -> impl Iterator<Item = (usize, Sides<f64>)> {
        let beyond = self.solve(&self.matt_light, |surface| surface.own);
        let beyond = beyond.unwrap_or_else(|| vec![[f64::INFINITY; 2]; self.shiny.len()]);
        self.shiny.iter().map(|(index, _)| *index).zip(beyond)
    }

    /// Bounds the light of rays that leave each shiny surface, given the surfaces' own light and, in `matt_light`,
    /// that of the others. Returns `None` where no bounds are found.
    fn solve(
        &self,
        matt_light: &[Sides<f64>],
        own: impl Fn(&SurfaceLight) -> f64,
    ) -> Option<Vec<Sides<f64>>> {
        let mut bounds = vec![[0.0; 2]; self.shiny.len()];
        let mut before: Option<Vec<Sides<f64>>> = None;
        for _ in 0..ROUNDS {
            // Two steps at once: then the bounds grow steadily where light goes back and forth between two kinds of
            // objects.
            let better = self.step(matt_light, &own, &self.step(matt_light, &own, &bounds));
            let gained = each(&better, &bounds, |better, bound| better - bound);
            if let Some(before) = before {
                // Extrapolates the gains as a geometric series with the largest ratio so far, plus 1%. The factor need
                // not be proven: the result is checked below.
                let ratios = each(
                    &gained,
                    &before,
                    |gained, before| if gained == 0.0 { 0.0 } else { gained / before },
                );
                let ratio = ratios.into_iter().flatten().fold(0.0, above);
                let rest = 1.01 * ratio / (1.0 - ratio);
                let beyond = each(&better, &gained, |better, gained| better + gain(rest, gained));
                let next = self.step(matt_light, &own, &beyond);
                let is_above =
                    next.iter().flatten().zip(beyond.iter().flatten()).all(|(next, beyond)| next <= beyond);
                if ratio < 1.0 && is_above {
                    return Some(beyond);
                }
            }
            before = Some(gained);
            bounds = better;
        }
        None
    }

    /// Bounds the light of rays that leave each shiny surface, given bounds on the rays that continue from their
    /// hits.
    fn step(
        &self,
        matt_light: &[Sides<f64>],
        own: impl Fn(&SurfaceLight) -> f64,
        beyond: &[Sides<f64>],
    ) -> Vec<Sides<f64>> {
        let met = self.shiny.iter().zip(beyond).map(|((index, _), beyond)| {
            let surface = &self.surfaces[*index];
            surface.met(own(surface), *beyond)
        });
        let met: Vec<_> = met.collect();
        if self.lies.is_empty() {
            return self.step_among_many(matt_light, &met);
        }
        let lies = |of: usize, object: usize| self.lies[of * met.len() + object];
        let of = |index: usize, side: usize| {
            met.iter().enumerate().fold(matt_light[index][side], |most, (other, [outside, inside])| {
                let comes = if other == index {
                    [self.shiny[index].1[side]; 2]
                } else if lies(index, other)[side] {
                    lies(other, index)
                } else {
                    [false; 2]
                };
                let most = if comes[0] { above(most, *outside) } else { most };
                if comes[1] { above(most, *inside) } else { most }
            })
        };
        (0..met.len()).map(|index| [of(index, 0), of(index, 1)]).collect()
    }

    /// Implements [`step`](Self::step) for many surfaces, each of which may be hit from each side of the others.
    /// `met` bounds the light of rays that hit each shiny surface.
    fn step_among_many(&self, matt_light: &[Sides<f64>], met: &[Sides<f64>]) -> Vec<Sides<f64>> {
        let met: Vec<_> = met.iter().map(|[outside, inside]| above(*outside, *inside)).collect();
        let brighter =
            |one: usize, other: usize| if above(met[other], met[one]) > met[one] { other } else { one };
        let Some(brightest) = (0..met.len()).reduce(brighter) else { return Vec::new() };
        let others = (0..met.len()).filter(|index| *index != brightest);
        let rest = others.map(|index| met[index]).fold(0.0, above);
        let of = |index: usize, side: usize| {
            let is_left = index == brightest && !self.shiny[index].1[side];
            above(matt_light[index][side], if is_left { rest } else { met[brightest] })
        };
        (0..met.len()).map(|index| [of(index, 0), of(index, 1)]).collect()
    }
}

/// Combines two bounds for each object and side.
fn each(one: &[Sides<f64>], other: &[Sides<f64>], of: impl Fn(f64, f64) -> f64) -> Vec<Sides<f64>> {
    one.iter().zip(other).map(|(one, other)| [of(one[0], other[0]), of(one[1], other[1])]).collect()
}

/// Tells whether a ray that leaves an object on a side may hit it again.
fn can_hit_itself(object: &Object, side: Side) -> bool {
    object.shape.can_hit_itself(side)
}

/// Tells on which sides of the plane that contains an object, if there is one, another object may be hit. `farthest`
/// is the length of a path whose rounding is allowed for.
fn lies(of: &Object, object: &Object, farthest: f64) -> Sides<bool> {
    let Some([point, normal]) = of.shape.facts().plane else { return [true; 2] };
    let size = |at: DVec3| at.abs().max_element();
    let (middle, reach) = match (object.shape.culling_bounds(), object.shape.facts().plane) {
        (Some(bounds), _) => (bounds.middle(), bounds.half_size()),
        (None, Some([other, its_normal])) if its_normal == normal || its_normal == -normal => {
            (other, DVec3::ZERO)
        }
        _ => return [true; 2],
    };
    let distance = normal.dot(middle - point);
    // The margin is tens of thousands of ulps of the coordinates and of the farthest path length.
    let reach =
        normal.abs().dot(reach) + 10.0 * SLACK * (size(middle) + size(reach) + size(point) + farthest);
    [distance > -reach, distance < reach]
}
