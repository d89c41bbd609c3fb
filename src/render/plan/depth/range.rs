//! Lower and upper bounds on the light of rays that leave objects, under the free rules.
//!
//! A range `[low, high]` of light holds for all rays that leave surfaces under two conditions: every surface that
//! receives light in the range returns light in the range, and the background lies in it. Then each sum of branches
//! whose ends are filled with light in the range lies in it too, however deep. So in a furnace, where everything is as
//! bright as the background, no ray need be followed at all.
//!
//! The upper bounds solve the inequalities of the [depth](super), for each channel. The lower bound is the same for
//! all surfaces: the darkest background, or less, if `left * (ambient + passed * low) >= low` would not hold for each
//! surface. Here `passed` is the least fraction that a surface passes on, and `left` the least fraction of light that
//! is left on any path through a medium. This bound does not rely on lamps, which may be in shadow everywhere.

use super::sides::{SIDES, Sides};
use super::solve::VisibleSurfaces;
use super::surface::BoundedLight;
use glam::DVec3;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::per_axis;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::material::{Look, Reflectivity, Rgb};
use tabray_world::scene::model::{Model, Object};
use tabray_world::surface_point::Point;

/// A limit of coordinates: with larger ones, the products of a scene's numbers overflow.
const FAR: f64 = 1e60;

/// Bounds of light, per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightRange {
    /// The least light.
    pub low: Rgb,
    /// The most light; infinite where nothing bounds it.
    pub high: Rgb,
}

impl LightRange {
    /// Returns the range for rays to which the light of some things does not count.
    pub fn down_to_black(self) -> Self {
        Self { low: self.low.min(Rgb::ZERO), ..self }
    }
}

/// Bounds the light of rays that leave each side of a model's objects, given the objects' brightest looks, and that of
/// rays from matt surfaces, by the number of matt surfaces before on their paths.
pub(super) fn ranges(model: &Model, looks: &[Option<Look>]) -> (Vec<Sides<LightRange>>, Vec<LightRange>) {
    let mut ranges = vec![[LightRange::default(); 2]; model.objects.len()];
    let mut scattered = vec![LightRange::default(); model.camera.value.bounces as usize];
    let [darkest, brightest] = background(model);
    for channel in 0..3 {
        let of = BoundedLight { light: None, channel: Some(channel) };
        let (surfaces, most_scattered) = super::surfaces(model, looks, of, brightest[channel]);
        for (range, most) in scattered.iter_mut().zip(most_scattered) {
            range.high[channel] = most;
        }
        for (index, most) in VisibleSurfaces::new(model, surfaces, brightest[channel]).beyond() {
            (0..SIDES.len()).for_each(|side| ranges[index][side].high[channel] = most[side]);
        }
    }
    let least = least(model, darkest);
    for range in ranges.as_flattened_mut() {
        range.low = least.unwrap_or(-range.high).min(range.high);
    }
    for range in &mut scattered {
        range.low = if least.is_some() { Rgb::ZERO } else { -range.high };
    }
    (ranges, scattered)
}

/// Returns the darkest and the brightest of the background, per channel.
fn background(model: &Model) -> [Rgb; 2] {
    let Some(background) = &model.background else { return [Rgb::ZERO; 2] };
    let seen = background.value.colours_toward([Interval { low: -1.0, high: 1.0 }; 3]);
    let low = seen.map(|channel| if channel.low > 0.0 { channel.low } else { 0.0 });
    [Rgb::from_array(low), background.value.brightest()]
}

/// Returns the least light of each channel that rays return; `None` where light may be below 0.
fn least(model: &Model, darkest: Rgb) -> Option<Rgb> {
    let everywhere = around(None);
    let is_positive = |sent: [Interval; 3]| sent.iter().all(|channel| channel.low >= 0.0);
    if !model.lights.iter().all(|lamp| is_positive(lamp.value.light.sends(everywhere))) {
        return None;
    }
    let left = model.objects.iter().fold(Rgb::ONE, |least, object| least.min(left(object)));
    model.objects.iter().try_fold(left * darkest, |least, object| {
        let [ambient, diffuse, specular] = look(object)?;
        if ![ambient, diffuse, specular].into_iter().all(is_positive) {
            return None;
        }
        let transparency = object.material.transparency;
        let tint = tint(transparency, diffuse);
        let passed = |channel: usize| match &object.material.interface {
            Some(interface) if interface.absorbs() => 0.0,
            // What is not transmitted is reflected.
            Some(_) => tint[channel].min(1.0),
            None => tint[channel] + specular[channel].low,
        };
        let bound = |channel: usize| {
            let lost = 1.0 - left[channel] * passed(channel);
            let own = left[channel] * (1.0 - transparency) * ambient[channel].low;
            if lost <= 0.0 { f64::INFINITY } else { own / lost }
        };
        Some(least.min(Rgb::from_array(per_axis(bound))))
    })
}

/// Returns the least fraction of light that is left after a path through an object.
fn left(object: &Object) -> Rgb {
    let Some(medium) = object.material.medium() else { return Rgb::ONE };
    // A path through a box is no longer than its diagonal.
    let longest = object.shape.bounds().map_or(f64::INFINITY, |Aabb { low, high }| (high - low).length());
    (1.0 - 1e-9) * Rgb::from(medium.passed((1.0 + 1e-9) * longest))
}

/// Encloses the reflectivities of an object, at all of its points.
fn look(object: &Object) -> Option<[[Interval; 3]; 3]> {
    let position = around(object.shape.bounds());
    let points =
        Point { position, normal: None, uv: None, face: None, patch: None, tangents: None, plain: None };
    let [ambient, diffuse, specular] =
        Reflectivity::ALL.map(|of| object.shader.reflects(of, &object.material, &points));
    Some([ambient?, diffuse?, specular?])
}

/// Returns the intervals of a box, or of everywhere.
fn around(bounds: Option<Aabb>) -> [Interval; 3] {
    let Aabb { low, high } = bounds.unwrap_or(Aabb { low: DVec3::splat(-FAR), high: DVec3::splat(FAR) });
    per_axis(|axis| Interval { low: low[axis], high: high[axis] })
}

/// Returns the least fraction of each channel that passes through an object, given its diffuse reflectivities.
fn tint(transparency: f64, diffuse: [Interval; 3]) -> [f64; 3] {
    let strongest = diffuse.iter().fold(0.0_f64, |most, channel| most.max(channel.high));
    match strongest > 0.0 {
        true => per_axis(|channel| transparency * diffuse[channel].low / strongest),
        false => [transparency; 3],
    }
}
