//! How deep rays are followed into mirrors and glass: what a branch can still add to a pixel, at most.
//!
//! **What rays bring back.** A ray that meets object `j` after its light has come `d` from the viewer brings back
//!
//! ```text
//! kept_j * S / d  +  tint_j * what comes through  +  specular_j * what is mirrored
//! ```
//!
//! where `S` is the ambient colour and what the lights do, and the two rays that go on bring back the same sum of what they
//! meet, farther away. So rays that leave object `i` on a side of it, on a way of `d` so far, bring back at most
//! `beyond / d`, where for each object `j` and side of it that they may come to
//!
//! ```text
//! beyond(i, side) >= kept_j * S_j + T_j * beyond(j, other side) + s_j * beyond(j, same side)
//! ```
//!
//! Each letter is the largest magnitude of any channel at any place: `T` of the tint, `s` of the specular colour, and `S` of
//! ambient and, for each light, emissivity times (diffuse / the least distance of the object from it, and specular if
//! there are glints). Cosines, powers of them, and what glass lets through of a light are at most 1. Rays do not come to
//! what lies behind the plane that they leave, nor to an object that they leave and that says so.
//!
//! Any solution of these inequalities is above the least one, and that is above all sums of finitely many branches. One is
//! looked for from below, and taken when it solves them as it stands. Where mirrors and glass give on as much light as
//! they get there is none: then nothing is left out, and [`MAX_RAYS`](crate::render::limits::MAX_RAYS) ends what the distance does
//! not.
//!
//! **What is left out.** A ray of a camera may leave out [`FAINT`] in all, 1/1024 of a level. That is shared out among the
//! branches. Let `P(i, side)` solve the inequalities with 1 for each `kept_j * S_j`. A ray whose share is `u * P` where it
//! leaves one object gives the ray through the next one `u * (T_j + 1/2 / P) * P` with the `P` of that one and its side,
//! and the mirrored one `u * (s_j + 1/2 / P) * P`: together `u * (T_j P + s_j P + 1)`, no more than it has. Where only one
//! goes on, it gets the other half, too. A branch is left out where `weight * beyond / d < share * FAINT`, `weight` being
//! the product of all `T` and `s` on the way. A branch's weight falls by more than its share does with each step, so that
//! each ends; and what is left out of a ray's colour adds up to less than [`FAINT`].
//!
//! Where panes and mirrors give on nearly all that they get, that takes very many rays. From the [`MANY`]th on, a branch is
//! also left out where `weight * beyond / d < FAINT` by itself.

use crate::geometry::aabb::{self, SLACK};
use crate::geometry::ray::Side;
use crate::render::culling;
use crate::render::limits::MAX_DIST;
use crate::scene::model::{Model, Object};
use crate::world::accuracy::Accuracy;
use crate::world::material::{Look, Rgb};
use glam::DVec3;

/// What may be left out of the colour of a camera ray: 1/1024 of a level of 1/255.
pub(crate) const FAINT: f64 = 1.0 / (1024.0 * 255.0);

/// From so many rays on that a camera ray has cost, branches are left out each for itself.
pub(crate) const MANY: u32 = 4000;

/// More than rounding makes of a bound: of the products along a branch, fewer than 2^15 with an error of 2^-53 each, and
/// of sums over as many lights.
const ROUNDING: f64 = 1.0 + 1e-11;

/// How often the bounds are made better before they are given up.
const ROUNDS: usize = 50;

/// Of so many mirrors and panes it is looked at which lie behind which.
const PAIRS: usize = 64;

/// What the branches of a scene with mirrors or glass can bring back.
pub(crate) struct Depth {
    /// What a camera ray can, times how far its light has come.
    pub most: f64,
    /// By the objects' indices.
    pub objects: Vec<Onward>,
}

/// What can come back from where rays meet an object.
#[derive(Clone, Copy)]
pub(crate) struct Onward {
    /// From the object's own surface, times how far the light has come.
    pub own: f64,
    /// From what rays that leave it meet, times how far that light has come.
    pub beyond: f64,
    /// What goes on through it.
    pub through: Branch,
    /// What it mirrors.
    pub mirrored: Branch,
}

/// How rays go on in one way.
#[derive(Clone, Copy)]
pub(crate) struct Branch {
    /// What their light is multiplied by, at most.
    pub weight: f64,
    /// Their part of what may be left out.
    pub share: f64,
    /// They are left out where the weight so far, times this, is less than the share so far times the way so far.
    pub faint: f64,
    /// Where many rays have been followed, also where the weight so far, times this, is less than the way so far.
    pub faint_alone: f64,
}

impl Onward {
    /// Where nothing goes on.
    pub const NONE: Self = Self { own: 0.0, beyond: 0.0, through: Branch::NONE, mirrored: Branch::NONE };
}

impl Branch {
    const NONE: Self = Self { weight: 0.0, share: 1.0, faint: 0.0, faint_alone: 0.0 };
}

impl Depth {
    /// That of a scene; nothing where no ray goes on.
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
        // Else more light may come through many panes than is sent.
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

    /// What rays that leave an object can bring back, or rays from the viewer.
    pub fn beyond(&self, leaves: Option<usize>) -> f64 {
        leaves.map_or(self.most, |index| self.objects[index].beyond)
    }

    /// Leaves nothing out.
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

/// What an object's surface does with light: the largest magnitudes of any channel at any place.
#[derive(Clone, Copy)]
struct Surface {
    own: f64,
    through: f64,
    mirrored: f64,
}

impl Surface {
    /// Whether rays go on from it.
    fn goes_on(&self) -> bool {
        self.through != 0.0 || self.mirrored != 0.0
    }

    /// What rays can bring back that come to it on each side, of which so much is its own.
    fn met(&self, own: f64, [outside, inside]: [f64; 2]) -> [f64; 2] {
        let onward =
            |through: f64, mirrored: f64| gain(self.through, through) + gain(self.mirrored, mirrored);
        [own + onward(inside, outside), own + onward(outside, inside)]
    }
}

/// Something for each side of an object: first the outside, which its normal points to.
type Sides<T> = [T; 2];

const SIDES: Sides<Side> = [Side::Outside, Side::Inside];

/// The surfaces of a scene, and which of them rays come to from which.
struct Scene {
    surfaces: Vec<Surface>,
    /// Those from which rays go on, by their indices, and whether rays that leave them on a side may meet them again.
    shiny: Vec<(usize, Sides<bool>)>,
    /// On which sides of one of those another one lies, for each pair of them; empty where they are many.
    lies: Vec<Sides<bool>>,
    /// The largest of what those objects send from which no rays go on, where they may be met from each side of one of
    /// those.
    t_max: Vec<Sides<f64>>,
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
        let t_max = shiny.iter().map(|of| {
            let sent = matt
                .iter()
                .map(|object| lies(*of, *object).map(|lies| if lies { surfaces[*object].own } else { 0.0 }));
            sent.fold([0.0; 2], |[one, other], [outside, inside]| [above(one, outside), above(other, inside)])
        });
        let t_max = t_max.collect();
        let pairs = shiny.iter().flat_map(|of| shiny.iter().map(|object| lies(*of, *object)));
        let lies = if is_few { pairs.collect() } else { Vec::new() };
        let meets = |index: usize| (index, SIDES.map(|side| can_hit_itself(&objects[index], side)));
        Self { shiny: shiny.into_iter().map(meets).collect(), lies, t_max, surfaces }
    }

    fn depth(&self, cuts: bool) -> Depth {
        let infinite = || vec![[f64::INFINITY; 2]; self.shiny.len()];
        let own = |surface: &Surface| surface.own;
        let beyond = self.solve(&self.t_max, own).unwrap_or_else(infinite);
        let one = |end: f64| if end > 0.0 { 1.0 } else { 0.0 };
        let t_max: Vec<_> = self.t_max.iter().map(|t_max| t_max.map(one)).collect();
        let shares = self.solve(&t_max, |_| 1.0).unwrap_or_else(infinite);
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

    /// The least bounds that are found of what rays can bring back that leave each object from which they go on, where
    /// each object's own light and that of the others is this.
    fn solve(&self, t_max: &[Sides<f64>], own: impl Fn(&Surface) -> f64) -> Option<Vec<Sides<f64>>> {
        let mut bounds = vec![[0.0; 2]; self.shiny.len()];
        let mut before: Option<Vec<Sides<f64>>> = None;
        for _ in 0..ROUNDS {
            // Two steps at once: what goes to and fro between two kinds of objects grows evenly then.
            let better = self.step(t_max, &own, &self.step(t_max, &own, &bounds));
            let gained = each(&better, &bounds, |better, bound| better - bound);
            if let Some(before) = before {
                // As if each step went on to gain as much less than the one before it as this one does, and a little more.
                let ratios = each(
                    &gained,
                    &before,
                    |gained, before| if gained == 0.0 { 0.0 } else { gained / before },
                );
                let ratio = ratios.into_iter().flatten().fold(0.0, above);
                let rest = 1.01 * ratio / (1.0 - ratio);
                let beyond = each(&better, &gained, |better, gained| better + gain(rest, gained));
                let next = self.step(t_max, &own, &beyond);
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

    /// What rays can bring back that leave each object, if those that leave what they meet can bring back so much.
    fn step(
        &self,
        t_max: &[Sides<f64>],
        own: impl Fn(&Surface) -> f64,
        beyond: &[Sides<f64>],
    ) -> Vec<Sides<f64>> {
        let met = self.shiny.iter().zip(beyond).map(|((index, _), beyond)| {
            let surface = &self.surfaces[*index];
            surface.met(own(surface), *beyond)
        });
        let met: Vec<_> = met.collect();
        if self.lies.is_empty() {
            return self.step_among_many(t_max, &met);
        }
        let all = || met.iter().enumerate();
        let of = |index: usize, side: usize| {
            all().fold(t_max[index][side], |most, (other, met)| {
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

    /// Likewise, where each may be met from each side of each.
    fn step_among_many(&self, t_max: &[Sides<f64>], met: &[Sides<f64>]) -> Vec<Sides<f64>> {
        let met: Vec<_> = met.iter().map(|[outside, inside]| above(*outside, *inside)).collect();
        let brighter =
            |one: usize, other: usize| if above(met[other], met[one]) > met[one] { other } else { one };
        let Some(brightest) = (0..met.len()).reduce(brighter) else { return Vec::new() };
        let others = (0..met.len()).filter(|index| *index != brightest);
        let rest = others.map(|index| met[index]).fold(0.0, above);
        let of = |index: usize, side: usize| {
            let is_left = index == brightest && !self.shiny[index].1[side];
            above(t_max[index][side], if is_left { rest } else { met[brightest] })
        };
        (0..met.len()).map(|index| [of(index, 0), of(index, 1)]).collect()
    }
}

impl Surface {
    /// How rays go on from it which can bring back so much. `whole` is the share of a camera ray, in the unit of `shares`.
    fn onward(&self, beyond: Sides<f64>, shares: Sides<f64>, whole: f64, cuts: bool) -> Onward {
        let Self { own, through, mirrored } = *self;
        let part = if through == 0.0 || mirrored == 0.0 { 1.0 } else { 0.5 };
        // Of the sides on which rays may leave it, whichever bounds less. From where nothing is met nothing comes.
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

/// Something of two bounds for each object and side.
fn each(one: &[Sides<f64>], other: &[Sides<f64>], of: impl Fn(f64, f64) -> f64) -> Vec<Sides<f64>> {
    one.iter().zip(other).map(|(one, other)| [of(one[0], other[0]), of(one[1], other[1])]).collect()
}

/// Whether a ray that leaves an object on a side may meet it again.
fn can_hit_itself(object: &Object, side: Side) -> bool {
    object.shape.can_hit_itself(side)
}

/// On which sides of the plane that an object lies in, if it does, another one may be met.
fn lies(of: &Object, object: &Object) -> Sides<bool> {
    let Some([point, normal]) = of.shape.plane() else { return [true; 2] };
    let size = |at: DVec3| at.abs().max_element();
    let (middle, reach) = match (culling::bounds(object), object.shape.plane()) {
        (Some(bounds), _) => (bounds.middle(), bounds.half_size()),
        (None, Some([other, upright])) if upright == normal || upright == -normal => (other, DVec3::ZERO),
        _ => return [true; 2],
    };
    let distance = normal.dot(middle - point);
    let reach =
        normal.abs().dot(reach) + 10.0 * SLACK * (size(middle) + size(reach) + size(point) + MAX_DIST);
    [distance > -reach, distance < reach]
}

/// How far from a point all of an object is, at least.
fn clearance(object: &Object, from: DVec3) -> f64 {
    let by_bounds =
        || aabb::clearance(from, culling::bounds(object), |region| culling::is_clear_of(object, region));
    object.shape.clearance(from).unwrap_or_else(by_bounds)
}

/// The largest magnitude of a channel.
fn largest(colour: Rgb) -> f64 {
    colour.abs().max_element()
}

/// The larger of two bounds; what is no number bounds nothing.
fn above(one: f64, other: f64) -> f64 {
    if one >= other {
        one
    } else if other.is_nan() || one.is_nan() {
        f64::INFINITY
    } else {
        other
    }
}

/// What comes back of some light. Of what is not mirrored nothing does, however bright.
fn gain(weight: f64, light: f64) -> f64 {
    if weight == 0.0 || light == 0.0 { 0.0 } else { weight * light }
}

/// What light that passes through an object is multiplied by.
fn tint(object: &Object, look: Option<&Look>) -> f64 {
    let transparency = object.material.transparency;
    match (object.shader.uniform(&object.material), look) {
        _ if transparency == 0.0 => 0.0,
        (Some(_), _) => largest(object.tint(DVec3::ZERO)),
        // Nowhere is the diffuse colour below 0, and its strongest channel makes 1.
        (None, Some(_)) => transparency,
        (None, None) => f64::INFINITY,
    }
}

/// What comes from an object's own surface, times how far the light has come from there.
fn own(model: &Model, object: &Object, look: &Look, any_light_comes: bool) -> f64 {
    let glint = if object.material.shininess == 0.0 { Rgb::ZERO } else { look.specular.abs() };
    let diffuse = look.diffuse.abs();
    let mut own = look.ambient.abs();
    for light in &model.lights {
        if glint == Rgb::ZERO && diffuse == Rgb::ZERO {
            break;
        }
        let Some(sent) = light.value.brightest().filter(|_| any_light_comes) else { return f64::INFINITY };
        // A light with a size is seen on a disc across the way to its middle: no nearer than that.
        let scattered = match clearance(object, light.value.location()) {
            _ if diffuse == Rgb::ZERO => Rgb::ZERO,
            0.0 => return f64::INFINITY,
            clearance => diffuse / clearance,
        };
        own += sent.abs() * (scattered + glint);
    }
    largest(own)
}
