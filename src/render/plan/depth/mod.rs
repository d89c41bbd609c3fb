//! The depth of rays in mirrors and glass: an upper bound on what a branch can still add to a pixel.
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
//! `S` of ambient plus, for each light, emissivity times (diffuse divided by the least distance of the object from
//! the light, plus specular if there are highlights). Cosines, their powers, and the fraction of a light that passes
//! through glass are at most 1. Rays do not hit objects behind the plane that they leave, or the object that they
//! leave if it cannot be hit again.
//!
//! **Interfaces.** Where the material has an interface, which divides each channel of light into a reflected fraction
//! `r` and the rest, the sum is `kept * S / d + (1 - r) * tint * transmitted light + r * reflected light`. So
//!
//! ```text
//! beyond(i, side) >= kept_j * S_j + max(T_j * beyond(j, other side), beyond(j, same side))
//! ```
//!
//! The same inequality holds for `P` below, but with 0 for `kept_j * S_j` where nothing is kept. The reflected ray
//! gets a quarter of the allowance, and the transmitted one the rest, or one of them gets all where the other does
//! not exist. The weight of the reflected branch is the largest `r` of a channel, rounded up to a power of two.
//!
//! The background counts as an object around everything, whose own light `S` is its brightest channel times
//! [`MAX_DIST`]: it is not divided by the path length `d`, but no ray leaves an object where `d` is more than that.
//!
//! Any solution of these inequalities is at least the least one, which is at least every sum of finitely many
//! branches. A solution is searched for by iteration from below, and accepted if it satisfies the inequalities as
//! computed. Where mirrors and glass pass on as much light as they receive, there is no solution. Then no branch is
//! cut, and [`MAX_RAYS`](crate::limits::MAX_RAYS) ends the branches that the path length does not.
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
//! Under the free rules, no light is divided by `d`: the bounds are on light itself, `S` includes a lamp's falloff,
//! and the background's own light is its brightest channel. Branches are not cut one by one with fixed allowances:
//! the tracer ends the tree of a pixel as a whole, by [`LightRange`]s from the same inequalities.
//!
//! Where glass and mirrors pass on nearly all light that they receive, the cuts leave very many rays. From the
//! `MANY`th ray on, a branch is also cut where `weight * beyond / d < FAINT` by itself.

mod branch;
mod range;
mod sides;
mod solve;
mod surface;

pub use branch::{Branch, ContinuationBounds, FAINT};
pub(crate) use branch::{MANY, STEPS, step};
pub use range::LightRange;
pub(crate) use surface::clearance;

use super::glow;
use crate::limits::MAX_DIST;
use solve::VisibleSurfaces;
use surface::{BoundedLight, SurfaceLight};
use tabray_world::accuracy::Accuracy;
use tabray_world::material::{Look, Rgb};
use tabray_world::parallel;
use tabray_world::rules::Rules;
use tabray_world::scene::model::{Model, Object};

/// Bounds on the light of branches in a scene with mirrors or glass.
pub struct Depth {
    /// A bound on any channel of the light that a primary ray returns if it hits an object, times the path length;
    /// infinite where there is no bound.
    pub most: f64,
    /// The bounds for each object, by the object's index.
    pub objects: Vec<ContinuationBounds>,
    /// Under the free rules, the bounds of the light that rays leaving each object return, for each side of the object,
    /// the outside first.
    pub ranges: Vec<[LightRange; 2]>,
    /// The bounds of the light that rays from matt surfaces return, by the number of matt surfaces before on their
    /// paths; empty where light does not bounce.
    pub scattered: Vec<LightRange>,
}

impl Depth {
    /// Computes the bounds of a scene; `None` where no ray continues from an object.
    pub fn new(model: &Model) -> Option<Self> {
        let is_shiny = |object: &Object| {
            let look = object.shader.brightest(&object.material);
            !object.is_opaque() || look.is_none_or(|look| look.specular != Rgb::ZERO)
        };
        let bounces = model.camera.value.bounces != 0;
        (bounces || model.objects.iter().any(is_shiny)).then(|| Self::of(model))
    }

    /// Computes the bounds of any scene.
    pub(crate) fn of(model: &Model) -> Self {
        let looks = looks(model);
        let (surfaces, _) = surfaces(model, &looks, BoundedLight::default(), background(model));
        let cuts = model.camera.value.accuracy != Accuracy::Classic;
        let (most, objects) = VisibleSurfaces::new(model, surfaces, background(model)).bounds(cuts);
        let (ranges, scattered) = match model.camera.value.rules {
            Rules::Notes => Default::default(),
            Rules::Free => range::ranges(model, &looks),
        };
        Self { most, objects, ranges, scattered }
    }

    /// Returns a bound on the light of rays that leave the object of this index, times the path length; for `None`,
    /// on that of primary rays.
    pub fn beyond(&self, leaves: Option<usize>) -> f64 {
        leaves.map_or(self.most, |index| self.objects[index].beyond)
    }

    /// Disables all cuts.
    #[doc(hidden)]
    pub fn uncut(mut self) -> Self {
        for object in &mut self.objects {
            for branch in [&mut object.through, &mut object.mirrored] {
                (branch.faint, branch.faint_alone) = (f64::INFINITY, f64::INFINITY);
            }
        }
        for range in self.ranges.as_flattened_mut().iter_mut().chain(&mut self.scattered) {
            range.high = Rgb::INFINITY;
        }
        self
    }
}

/// Bounds the light of rays that leave an object and hit nothing; under the notes' rules, times the path length.
fn background(model: &Model) -> f64 {
    let brightest = model.background.as_ref().map(|background| background.value.brightest());
    let longest = match model.camera.value.rules {
        Rules::Notes => MAX_DIST,
        Rules::Free => 1.0,
    };
    brightest.map_or(0.0, |brightest| brightest.max_element() * longest)
}

/// Bounds what a primary ray that hits an object returns in any channel, times the path length; infinite where there is
/// no bound.
pub(crate) fn most(model: &Model) -> f64 {
    let background = background(model);
    let (surfaces, _) = surfaces(model, &looks(model), BoundedLight::default(), background);
    VisibleSurfaces::new(model, surfaces, background).bounds(false).0
}

/// Bounds what each light of a model adds to a primary ray in any channel, times the path length; infinite where there
/// is no bound.
pub(crate) fn most_of_lights(model: &Model) -> Vec<f64> {
    let looks = looks(model);
    let most = |light: usize| {
        let of = BoundedLight { light: Some(light), channel: None };
        let (surfaces, _) = surfaces(model, &looks, of, 0.0);
        VisibleSurfaces::new(model, surfaces, 0.0).bounds(false).0
    };
    parallel::map(model.lights.len(), most)
}

/// Bounds the surfaces of a scene, with the light that matt ones receive from others as their own, and the light of
/// rays from matt surfaces, by the number of matt surfaces before on their paths; none where light does not bounce.
fn surfaces(
    model: &Model,
    looks: &[Option<Look>],
    of: BoundedLight,
    background: f64,
) -> (Vec<SurfaceLight>, Vec<f64>) {
    let surfaces = SurfaceLight::all(model, looks, of);
    let scattered = scattered(model, &surfaces, background, of.largest(glow::brightest(model, looks)));
    let surfaces = match scattered.first() {
        Some(most) => surfaces.into_iter().map(|surface| surface.lit_by(*most)).collect(),
        None => surfaces,
    };
    (surfaces, scattered)
}

/// Bounds the light of rays from matt surfaces, by the number of matt surfaces before on their paths; empty where light
/// does not bounce.
///
/// Where no matt surface passes on light, rays return at most `first`, and with them comes at most `aimed` from what the
/// matt surface aims at. Beyond, rays return `factor` times what each matt surface receives.
fn scattered(model: &Model, surfaces: &[SurfaceLight], background: f64, aimed: f64) -> Vec<f64> {
    let bounces = model.camera.value.bounces as usize;
    if bounces == 0 {
        return Vec::new();
    }
    let most = |surfaces: Vec<SurfaceLight>, background| {
        VisibleSurfaces::new(model, surfaces, background).bounds(false).0
    };
    let first = most(surfaces.to_vec(), background) + aimed;
    let factor = most(surfaces.iter().map(SurfaceLight::only_scattering).collect(), 0.0);
    let mut all = vec![first; bounces];
    for index in (1..bounces).rev() {
        all[index - 1] = first + sides::gain(factor, all[index]);
    }
    all
}

/// Returns each object's brightest look, if it has one.
fn looks(model: &Model) -> Vec<Option<Look>> {
    let brightest = |Object { shader, material, .. }: &Object| {
        shader.brightest(material).map(|look| material.coated(look))
    };
    model.objects.iter().map(brightest).collect()
}
