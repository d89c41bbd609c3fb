//! How deep rays are followed into mirrors and glass: an upper bound on what a branch can still add to a pixel.
//!
//! **What a ray returns.** A ray that hits object `j` at a path length `d` from the viewer returns
//!
//! ```text
//! kept_j * S / d  +  tint_j * transmitted light  +  specular_j * reflected light
//! ```
//!
//! where `S` is the ambient colour plus the contribution of the lights, and the transmitted and the reflected ray
//! return the same sum for the object that they hit, farther away. So rays that leave object `i` on one side, at a path
//! length `d`, return at most `beyond / d`, where for each object `j` and side of it that they may hit
//!
//! ```text
//! beyond(i, side) >= kept_j * S_j + T_j * beyond(j, other side) + s_j * beyond(j, same side)
//! ```
//!
//! Each letter is the largest magnitude of any channel at any point: `T` of the tint, `s` of the specular colour, and
//! `S` of ambient plus, for each light, emissivity times (diffuse divided by the least distance of the object from the
//! light, plus specular if there are highlights). Cosines, their powers, and the fraction of a light that passes
//! through glass are at most 1. Rays do not hit what lies behind the plane that they leave, nor the object that they
//! leave if it cannot be hit again.
//!
//! Any solution of these inequalities is at least the least one, which is at least every sum of finitely many branches.
//! A solution is searched for by iteration from below, and accepted when it satisfies the inequalities as it stands.
//! Where mirrors and glass pass on as much light as they receive, there is none: then no branch is cut, and
//! [`MAX_RAYS`](crate::render::limits::MAX_RAYS) ends what the path length does not.
//!
//! **What is cut.** A primary ray may lose [`FAINT`] in all, 1/1024 of a level. This allowance is shared among the
//! branches. Let `P(i, side)` solve the inequalities with 1 for each `kept_j * S_j`. A ray whose share is `u * P` where
//! it leaves one object gives its transmitted ray `u * (T_j + 1/2 / P) * P`, with the `P` of the object that this ray
//! leaves and its side, and its reflected ray `u * (s_j + 1/2 / P) * P`: together `u * (T_j P + s_j P + 1)`, no more
//! than its own. Where only one of the two rays continues, it gets the other half as well. A branch is cut where
//! `weight * beyond / d < share * FAINT`, where `weight` is the product of all `T` and `s` on the path. With each step
//! a branch's weight falls by more than its share does, so each branch ends; and the cuts in a ray's colour add up to
//! less than [`FAINT`].
//!
//! Where glass and mirrors pass on nearly all that they receive, that takes very many rays. From the [`MANY`]th ray on,
//! a branch is also cut where `weight * beyond / d < FAINT` by itself.

use crate::geometry::aabb::{self, SLACK};
use crate::geometry::ray::Side;
use crate::render::culling;
use crate::render::limits::MAX_DIST;
use crate::scene::model::{Model, Object};
use crate::world::accuracy::Accuracy;
use crate::world::material::{Look, Rgb};
use glam::DVec3;

/// The most that cuts may take from a channel of a primary ray's colour: 1/1024 of a level of 1/255.
pub(crate) const FAINT: f64 = 1.0 / (1024.0 * 255.0);

/// The number of rays that a primary ray may cost before branches are cut one by one, each without regard to the
/// others.
pub(crate) const MANY: u32 = 4000;

/// A factor larger than the rounding error of a bound: that of the products along a branch, fewer than 2^15 with a
/// relative error of 2^-53 each, and of sums over as many lights; 2^16 such errors are less than 8e-12.
const ROUNDING: f64 = 1.0 + 1e-11;

/// The number of iterations after which the search for bounds is given up.
const ROUNDS: usize = 50;

/// The maximum number of reflecting and transmitting objects for which it is determined which lie behind which.
const PAIRS: usize = 64;

/// Bounds on what the branches of a scene with mirrors or glass can return.
pub(crate) struct Depth {
    /// A bound on any channel of what a primary ray returns, times the path length; infinite where there is none.
    pub most: f64,
    /// The bounds for each object, by the object's index.
    pub objects: Vec<Onward>,
}

/// Bounds on what can be returned from where rays hit an object.
#[derive(Clone, Copy)]
pub(crate) struct Onward {
    /// A bound on the light of the object's own surface, times the path length to the surface.
    pub own: f64,
    /// A bound on what rays that leave the object return, times the path length to the object.
    pub beyond: f64,
    /// How transmitted rays continue.
    pub through: Branch,
    /// How reflected rays continue.
    pub mirrored: Branch,
}

/// How rays continue in one way.
#[derive(Clone, Copy)]
pub(crate) struct Branch {
    /// The largest factor by which the rays' light is multiplied.
    pub weight: f64,
    /// The fraction of the allowance for cuts that the rays get.
    pub share: f64,
    /// The rays are cut where the path's weight times this number is less than its share times its length.
    pub faint: f64,
    /// After [`MANY`] rays, the rays are also cut where the path's weight times this number is less than its length.
    pub faint_alone: f64,
}

impl Onward {
    /// The value of an object from which no rays continue.
    pub const NONE: Self = Self { own: 0.0, beyond: 0.0, through: Branch::NONE, mirrored: Branch::NONE };
}

impl Branch {
    const NONE: Self = Self { weight: 0.0, share: 1.0, faint: 0.0, faint_alone: 0.0 };
}

impl Depth {
    /// Computes the bounds of a scene; `None` where no object reflects or transmits rays.
    pub fn new(model: &Model) -> Option<Self> {
        let looks: Vec<_> =
            model.objects.iter().map(|object| object.shader.brightest(&object.material)).collect();
        let shiny = model.objects.iter().zip(&looks).any(|(object, look)| {
            object.material.transparency != 0.0 || look.is_none_or(|look| look.specular != Rgb::ZERO)
        });
        if !shiny {
            return None;
        }
        let objects = || model.objects.iter().zip(&looks);
        let tints: Vec<_> = objects().map(|(object, look)| tint(object, look.as_ref())).collect();
        // Otherwise many panes may let through more light than is sent.
        let any_light_comes = tints.iter().all(|tint| *tint <= 1.0);
        let surfaces = objects().zip(&tints).map(|((object, look), tint)| {
            let own = look.map_or(f64::INFINITY, |look| own(model, object, &look, any_light_comes));
            Surface {
                own: gain(1.0 - object.material.transparency, own) * ROUNDING,
                through: tint * ROUNDING,
                mirrored: look.map_or(f64::INFINITY, |look| largest(look.specular)) * ROUNDING,
            }
        });
        let scene = Scene::new(model, surfaces.collect());
        let cuts = model.camera.value.accuracy != Accuracy::Classic;
        Some(scene.depth(cuts))
    }

    /// Returns a bound on what rays that leave the object of this index return, times the path length; for `None`, of
    /// what primary rays return.
    pub fn beyond(&self, leaves: Option<usize>) -> f64 {
        leaves.map_or(self.most, |index| self.objects[index].beyond)
    }

    /// Disables all cuts.
    #[cfg(test)]
    pub fn uncut(mut self) -> Self {
        for object in &mut self.objects {
            for branch in [&mut object.through, &mut object.mirrored] {
                (branch.faint, branch.faint_alone) = (f64::INFINITY, f64::INFINITY);
            }
        }
        self
    }
}

/// What an object's surface does with light: the largest magnitudes of any channel at any point.
#[derive(Clone, Copy)]
struct Surface {
    /// The surface's own light, times the path length.
    own: f64,
    /// The tint of transmitted light.
    through: f64,
    /// The specular reflectivity.
    mirrored: f64,
}

impl Surface {
    /// Tells whether rays continue from the surface.
    fn goes_on(&self) -> bool {
        self.through != 0.0 || self.mirrored != 0.0
    }

    /// Bounds what rays that hit the surface on each side return, given its own light and what rays that leave it on
    /// each side return.
    fn met(&self, own: f64, [outside, inside]: [f64; 2]) -> [f64; 2] {
        let onward =
            |through: f64, mirrored: f64| gain(self.through, through) + gain(self.mirrored, mirrored);
        [own + onward(inside, outside), own + onward(outside, inside)]
    }
}

/// A value for each side of an object: first the outside, to which the normal points.
type Sides<T> = [T; 2];

const SIDES: Sides<Side> = [Side::Outside, Side::Inside];

/// The surfaces of a scene, and which of them rays may hit from which.
struct Scene {
    surfaces: Vec<Surface>,
    /// The indices of the surfaces from which rays continue, and whether rays that leave one on a side may hit it
    /// again.
    shiny: Vec<(usize, Sides<bool>)>,
    /// On which sides of one shiny surface another one lies, for each pair; empty for more than [`PAIRS`] surfaces.
    lies: Vec<Sides<bool>>,
    /// For each shiny surface and side, the largest own light of the other surfaces that may be hit from there.
    matt_light: Vec<Sides<f64>>,
}

impl Scene {
    fn new(model: &Model, surfaces: Vec<Surface>) -> Self {
        let objects = &model.objects;
        let (shiny, matt): (Vec<_>, Vec<_>) =
            (0..surfaces.len()).partition(|index| surfaces[*index].goes_on());
        let is_few = shiny.len() <= PAIRS;
        let lies = |of: usize, object: usize| {
            if is_few { lies(&objects[of], &objects[object]) } else { [true; 2] }
        };
        let matt_light = shiny.iter().map(|of| {
            let sent = matt
                .iter()
                .map(|object| lies(*of, *object).map(|lies| if lies { surfaces[*object].own } else { 0.0 }));
            sent.fold([0.0; 2], |[one, other], [outside, inside]| [above(one, outside), above(other, inside)])
        });
        let matt_light = matt_light.collect();
        let pairs = shiny.iter().flat_map(|of| shiny.iter().map(|object| lies(*of, *object)));
        let lies = if is_few { pairs.collect() } else { Vec::new() };
        let meets = |index: usize| (index, SIDES.map(|side| can_hit_itself(&objects[index], side)));
        Self { shiny: shiny.into_iter().map(meets).collect(), lies, matt_light, surfaces }
    }

    /// Computes the bounds, and when branches are cut, if they are at all.
    fn depth(&self, cuts: bool) -> Depth {
        let infinite = || vec![[f64::INFINITY; 2]; self.shiny.len()];
        let own = |surface: &Surface| surface.own;
        let beyond = self.solve(&self.matt_light, own).unwrap_or_else(infinite);
        let one = |light: f64| if light > 0.0 { 1.0 } else { 0.0 };
        let matt_light: Vec<_> = self.matt_light.iter().map(|matt_light| matt_light.map(one)).collect();
        let shares = self.solve(&matt_light, |_| 1.0).unwrap_or_else(infinite);
        let most = |own: &dyn Fn(&Surface) -> f64, beyond: &[Sides<f64>]| {
            let mut met: Vec<_> = self.surfaces.iter().map(own).collect();
            for ((index, _), beyond) in self.shiny.iter().zip(beyond) {
                let surface = &self.surfaces[*index];
                let [outside, inside] = surface.met(own(surface), *beyond);
                met[*index] = above(outside, inside);
            }
            met.into_iter().fold(0.0, above)
        };
        let whole = most(&|_| 1.0, &shares);
        let none = |surface: &Surface| Onward { own: surface.own, ..Onward::NONE };
        let mut objects: Vec<_> = self.surfaces.iter().map(none).collect();
        for (((index, _), beyond), shares) in self.shiny.iter().zip(&beyond).zip(&shares) {
            objects[*index] = self.surfaces[*index].onward(*beyond, *shares, whole, cuts);
        }
        Depth { most: most(&own, &beyond), objects }
    }

    /// Bounds what rays that leave each shiny surface return, given the surfaces' own light, and in `matt_light` that
    /// of the others. Returns `None` where no bounds are found.
    fn solve(&self, matt_light: &[Sides<f64>], own: impl Fn(&Surface) -> f64) -> Option<Vec<Sides<f64>>> {
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

    /// Bounds what rays that leave each shiny surface return, given bounds on what the rays that continue from their
    /// hits return.
    fn step(
        &self,
        matt_light: &[Sides<f64>],
        own: impl Fn(&Surface) -> f64,
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
        let all = || met.iter().enumerate();
        let of = |index: usize, side: usize| {
            all().fold(matt_light[index][side], |most, (other, met)| {
                let comes = if other == index {
                    [self.shiny[index].1[side]; 2]
                } else if self.lies[index * met.len() + other][side] {
                    self.lies[other * met.len() + index]
                } else {
                    [false; 2]
                };
                let most = if comes[0] { above(most, met[0]) } else { most };
                if comes[1] { above(most, met[1]) } else { most }
            })
        };
        (0..met.len()).map(|index| [of(index, 0), of(index, 1)]).collect()
    }

    /// Does the work of [`step`](Self::step) where each surface may be hit from each side of each other one; `met`
    /// bounds what rays that hit each shiny surface return.
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

impl Surface {
    /// Computes how rays continue from the surface, given bounds on what they return. `whole` is the share of a primary
    /// ray, in the unit of `shares`.
    fn onward(&self, beyond: Sides<f64>, shares: Sides<f64>, whole: f64, cuts: bool) -> Onward {
        let Self { own, through, mirrored } = *self;
        let part = if through == 0.0 || mirrored == 0.0 { 1.0 } else { 0.5 };
        // The larger ratio of the two sides, since rays may leave on either. A side from which nothing is hit returns
        // nothing.
        let ratio = |side: usize| if beyond[side] == 0.0 { 0.0 } else { beyond[side] / shares[side] };
        let (ratio, most) = (above(ratio(0), ratio(1)), above(shares[0], shares[1]));
        let branch = |weight: f64| {
            let share = if most > 0.0 { weight + part / most } else { 1.0 };
            let faint = gain(weight, ratio) * whole * ROUNDING / (share * FAINT);
            let faint_alone = gain(weight, above(beyond[0], beyond[1])) * ROUNDING / FAINT;
            let [faint, faint_alone] =
                [faint, faint_alone].map(|faint| if cuts { above(0.0, faint) } else { f64::INFINITY });
            Branch { weight, share, faint, faint_alone }
        };
        Onward {
            own,
            beyond: above(beyond[0], beyond[1]),
            through: branch(through),
            mirrored: branch(mirrored),
        }
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

/// Tells on which sides of the plane that contains an object, if there is one, another object may be hit.
fn lies(of: &Object, object: &Object) -> Sides<bool> {
    let Some([point, normal]) = of.shape.plane() else { return [true; 2] };
    let size = |at: DVec3| at.abs().max_element();
    let (middle, reach) = match (culling::bounds(object), object.shape.plane()) {
        (Some(bounds), _) => (bounds.middle(), bounds.half_size()),
        (None, Some([other, its_normal])) if its_normal == normal || its_normal == -normal => {
            (other, DVec3::ZERO)
        }
        _ => return [true; 2],
    };
    let distance = normal.dot(middle - point);
    // The margin is tens of thousands of ulps of the coordinates and of the path length.
    let reach =
        normal.abs().dot(reach) + 10.0 * SLACK * (size(middle) + size(reach) + size(point) + MAX_DIST);
    [distance > -reach, distance < reach]
}

/// Returns a lower bound on the distance from a point to an object, in world units.
fn clearance(object: &Object, from: DVec3) -> f64 {
    let by_bounds =
        || aabb::clearance(from, culling::bounds(object), |region| culling::is_clear_of(object, region));
    object.shape.clearance(from).unwrap_or_else(by_bounds)
}

/// Returns the largest magnitude of a channel.
fn largest(colour: Rgb) -> f64 {
    colour.abs().max_element()
}

/// Returns the larger of two bounds; infinity if either is NaN.
fn above(one: f64, other: f64) -> f64 {
    if one >= other {
        one
    } else if other.is_nan() || one.is_nan() {
        f64::INFINITY
    } else {
        other
    }
}

/// Multiplies a weight by an amount of light; 0 if either is 0, even if the other is infinite.
fn gain(weight: f64, light: f64) -> f64 {
    if weight == 0.0 || light == 0.0 { 0.0 } else { weight * light }
}

/// Bounds the factor by which an object multiplies light that passes through it.
fn tint(object: &Object, look: Option<&Look>) -> f64 {
    let transparency = object.material.transparency;
    match (object.shader.uniform(&object.material), look) {
        _ if transparency == 0.0 => 0.0,
        (Some(_), _) => largest(object.tint(DVec3::ZERO)),
        // The diffuse colour is not negative anywhere, and the tint is scaled so that its largest channel is the
        // transparency.
        (None, Some(_)) => transparency,
        (None, None) => f64::INFINITY,
    }
}

/// Bounds the light of an object's own surface, times the path length to the surface.
fn own(model: &Model, object: &Object, look: &Look, any_light_comes: bool) -> f64 {
    let highlight = if object.material.shininess == 0.0 { Rgb::ZERO } else { look.specular.abs() };
    let diffuse = look.diffuse.abs();
    let mut own = look.ambient.abs();
    for light in &model.lights {
        if highlight == Rgb::ZERO && diffuse == Rgb::ZERO {
            break;
        }
        let Some(sent) = light.value.brightest().filter(|_| any_light_comes) else { return f64::INFINITY };
        // A light with a size is sampled on a disc perpendicular to the direction of its centre, so no sample is nearer
        // than the centre.
        let scattered = match clearance(object, light.value.location()) {
            _ if diffuse == Rgb::ZERO => Rgb::ZERO,
            0.0 => return f64::INFINITY,
            clearance => diffuse / clearance,
        };
        own += sent.abs() * (scattered + highlight);
    }
    largest(own)
}
