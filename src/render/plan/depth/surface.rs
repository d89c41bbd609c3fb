//! Bounds on the light that an object's surface scatters, transmits and reflects, over all of its points.

use super::branch::{Branch, ContinuationBounds, FAINT, REFLECTED};
use super::sides::{Sides, above, gain};
use crate::plan::glow;
use glam::DVec3;
use tabray_world::geometry::aabb;
use tabray_world::material::{Look, Rgb};
use tabray_world::rules::Rules;
use tabray_world::scene::model::{Model, Object};
use tabray_world::surface_point::SurfacePoint;

/// A factor larger than the rounding error of a bound: that of the products along a branch, fewer than 2^15 with a
/// relative error of 2^-53 each, and of sums over as many lights; 2^16 such errors are less than 8e-12.
const ROUNDING: f64 = 1.0 + 1e-11;

/// The light that is bounded.
#[derive(Clone, Copy, Default)]
pub(super) struct BoundedLight {
    /// The light whose scattered part is the surfaces' own light; `None` for all lights and the ambient colours.
    pub light: Option<usize>,
    /// The channel; `None` for the largest.
    pub channel: Option<usize>,
}

impl BoundedLight {
    /// Returns the magnitude of a colour.
    pub fn largest(self, colour: Rgb) -> f64 {
        self.channel.map_or(colour.abs().max_element(), |channel| colour[channel].abs())
    }
}

/// Bounds on a surface's light: the largest magnitudes of any channel, or of one, at any point.
#[derive(Clone, Copy)]
pub(super) struct SurfaceLight {
    /// The surface's own light, times the path length.
    pub own: f64,
    /// The tint of transmitted light.
    through: f64,
    /// The specular reflectivity.
    mirrored: f64,
    /// The diffuse reflectivity, of the fraction of light that the surface keeps.
    scattered: f64,
    /// Whether light is divided between the two, by an interface.
    is_split: bool,
    /// Whether rays pass through what the surface does not cover.
    covers_in_part: bool,
    /// A factor of the light that an interface passes on: 1, or [`HELD`] where only that gives a bound under the free
    /// rules.
    held: f64,
}

/// Under the free rules, the fraction of light that bounds let an interface pass on, if its surface has light of its
/// own. The assumption is that no more than 8 such surfaces in a row pass on nearly all light. Metal reflects all
/// light that grazes it, and glass all light that it totally reflects, so nothing else bounds the sum of their
/// highlights.
const HELD: f64 = 7.0 / 8.0;

impl SurfaceLight {
    /// Bounds the surfaces of a scene, given each object's brightest look, if it has one.
    pub fn all(model: &Model, looks: &[Option<Look>], of: BoundedLight) -> Vec<Self> {
        let (objects, rules) = (|| model.objects.iter().zip(looks), model.camera.value.rules);
        let aimed = glow::brightest(model, looks);
        let tints: Vec<_> = objects().map(|(object, look)| tint(object, look.as_ref(), of)).collect();
        // With a tint above 1, many panes may let through more light than is sent.
        let any_light_comes = tints.iter().all(|tint| *tint <= 1.0);
        objects()
            .zip(&tints)
            .map(|((object, look), tint)| {
                let own = look.map_or(f64::INFINITY, |look| own(model, object, &look, of, any_light_comes));
                let mut own = gain(1.0 - object.material.transparency, own) * ROUNDING;
                if object.material.interface.is_some() {
                    own += glints(model, object, aimed, of, any_light_comes) * ROUNDING;
                }
                let (is_split, is_free) = (object.material.interface.is_some(), rules == Rules::Free);
                Self {
                    own,
                    // Glass that passes on all light would have no bound otherwise.
                    through: if is_free && is_split { *tint } else { tint * ROUNDING },
                    held: if is_free && is_split && own != 0.0 { HELD } else { 1.0 },
                    mirrored: if is_split {
                        1.0
                    } else {
                        look.map_or(f64::INFINITY, |look| of.largest(look.specular)) * ROUNDING
                    },
                    scattered: look.map_or(f64::INFINITY, |look| {
                        gain(1.0 - object.material.transparency, of.largest(look.diffuse)) * ROUNDING
                    }),
                    is_split,
                    covers_in_part: object.shader.covers_in_part(),
                }
            })
            .collect()
    }

    /// Adds the light that the surface scatters if it receives this much from everywhere to its own.
    pub fn lit_by(self, most: f64) -> Self {
        Self { own: self.own + gain(self.scattered, most) * ROUNDING, ..self }
    }

    /// Returns the surface with the light alone that it scatters if it receives 1 from everywhere.
    pub fn only_scattering(&self) -> Self {
        Self { own: self.scattered, ..*self }
    }

    /// Tells whether rays continue from the surface.
    pub fn goes_on(&self) -> bool {
        self.through != 0.0 || self.mirrored != 0.0 || self.covers_in_part
    }

    /// Bounds the light of rays that hit each side of the surface, given its own light and that of rays that leave
    /// each side.
    pub fn met(&self, own: f64, [outside, inside]: [f64; 2]) -> [f64; 2] {
        let continuation = |through: f64, mirrored: f64| {
            let (through, mirrored) = (gain(self.through, through), gain(self.mirrored, mirrored));
            if self.is_split { self.held * above(through, mirrored) } else { through + mirrored }
        };
        let met = |through: f64, mirrored: f64| {
            let covered = own + continuation(through, mirrored);
            // What is seen is a mean of what covers and of what is behind it.
            if self.covers_in_part { above(covered, through) } else { covered }
        };
        [met(inside, outside), met(outside, inside)]
    }

    /// Returns the surface's own light in the unit of shares: 1, or 0 where an interface passes on all light.
    pub fn unit(&self) -> f64 {
        if self.is_split && self.own == 0.0 { 0.0 } else { 1.0 }
    }

    /// Computes how rays continue from the surface, given bounds on their light. `whole` is the share of a primary
    /// ray, in the unit of `shares`.
    pub fn continuation(
        &self,
        beyond: Sides<f64>,
        shares: Sides<f64>,
        whole: f64,
        cuts: bool,
    ) -> ContinuationBounds {
        let Self { own, through, mirrored, is_split, .. } = *self;
        let part = if through == 0.0 || mirrored == 0.0 { 1.0 } else { 0.5 };
        // The larger ratio of the two sides, since rays may leave on either. A side from which nothing is hit returns
        // nothing.
        let ratio = |side: usize| if beyond[side] == 0.0 { 0.0 } else { beyond[side] / shares[side] };
        let (ratio, most) = (above(ratio(0), ratio(1)), above(shares[0], shares[1]));
        let branch = |weight: f64, part_of_split: f64| {
            let share = match most > 0.0 {
                _ if is_split => part_of_split,
                true => weight + part / most,
                false => 1.0,
            };
            let faint = gain(weight, ratio) * whole * ROUNDING / (share * FAINT);
            let faint_alone = gain(weight, above(beyond[0], beyond[1])) * ROUNDING / FAINT;
            let [faint, faint_alone] =
                [faint, faint_alone].map(|faint| if cuts { above(0.0, faint) } else { f64::INFINITY });
            Branch { weight, share, faint, faint_alone }
        };
        ContinuationBounds {
            own,
            hit: own,
            beyond: above(beyond[0], beyond[1]),
            through: branch(through, 1.0 - REFLECTED),
            mirrored: branch(mirrored, REFLECTED),
        }
    }
}

/// Bounds the factor by which an object multiplies light that passes through it.
fn tint(object: &Object, look: Option<&Look>, of: BoundedLight) -> f64 {
    let transparency = object.material.transparency;
    match (object.shader.uniform(&object.material), look) {
        _ if transparency == 0.0 => 0.0,
        (Some(_), _) => of.largest(object.tint(&SurfacePoint::at(DVec3::ZERO))),
        // The diffuse colour is not negative anywhere, and the tint is scaled so that its largest channel is the
        // transparency.
        (None, Some(_)) => transparency,
        (None, None) => f64::INFINITY,
    }
}

/// Bounds the light of an object's own surface; under the notes' rules, times the path length to the surface.
fn own(model: &Model, object: &Object, look: &Look, of: BoundedLight, any_light_comes: bool) -> f64 {
    let (specular, alone) = (look.specular.abs(), object.material.highlight.abs());
    let [highlight, gleam] =
        if object.material.shininess == 0.0 { [Rgb::ZERO; 2] } else { [specular + alone, alone] };
    let given = look.ambient.abs() + object.material.emission.abs();
    let ambient = if of.light.is_some() { Rgb::ZERO } else { given };
    scattered(model, object, ambient, [look.diffuse.abs(), highlight, gleam], of, any_light_comes)
}

/// Bounds the highlights of a surface that are no part of its own light, and the light of lamps that its facets mirror by
/// aim, as [`own`] does.
fn glints(model: &Model, object: &Object, aimed: Rgb, of: BoundedLight, any_light_comes: bool) -> f64 {
    // By aim, facets mirror no more of a light than its radiance.
    let gleam = if object.material.roughness() == 0.0 { Rgb::ZERO } else { Rgb::ONE };
    let highlight = if object.material.glints() { Rgb::ONE } else { Rgb::ZERO };
    let emitted = if of.light.is_some() { Rgb::ZERO } else { gleam * aimed };
    scattered(model, object, emitted, [Rgb::ZERO, highlight, gleam], of, any_light_comes)
}

/// Bounds the ambient light of an object and the light of lamps that it scatters, given its largest reflectivities: the
/// diffuse one, that for highlights, and that for highlights of lamps that mirrors show.
fn scattered(
    model: &Model,
    object: &Object,
    ambient: Rgb,
    [diffuse, highlight, gleam]: [Rgb; 3],
    of: BoundedLight,
    any_light_comes: bool,
) -> f64 {
    let mut own = ambient;
    let lights = of.light.map_or(&model.lights[..], |only| std::slice::from_ref(&model.lights[only]));
    for light in lights {
        if highlight == Rgb::ZERO && diffuse == Rgb::ZERO && gleam == Rgb::ZERO {
            break;
        }
        let Some(sent) = light.value.brightest().filter(|_| any_light_comes) else { return f64::INFINITY };
        // A light with a size is sampled on a disc perpendicular to the direction of its centre, so no sample is nearer
        // than the centre.
        let clearance = || clearance(object, light.value.location());
        own += match (light.value.emitter(), model.camera.value.rules) {
            (Some(emitter), _) if !emitter.has_highlights() => sent.abs() * (diffuse + gleam),
            (Some(_), _) => sent.abs() * (diffuse + highlight),
            (None, Rules::Free) => {
                sent.abs() * light.value.fading.factor(clearance()) * (diffuse + highlight)
            }
            (None, Rules::Notes) => {
                let scattered = match clearance() {
                    _ if diffuse == Rgb::ZERO => Rgb::ZERO,
                    0.0 => return f64::INFINITY,
                    clearance => diffuse / clearance,
                };
                sent.abs() * (scattered + highlight)
            }
        };
    }
    of.largest(own)
}

/// Returns a lower bound on the distance from a point to an object, in world units.
pub(crate) fn clearance(object: &Object, from: DVec3) -> f64 {
    let by_bounds =
        || aabb::clearance(from, object.shape.culling_bounds(), |region| object.shape.is_culled_in(region));
    object.shape.clearance(from).unwrap_or_else(by_bounds)
}
