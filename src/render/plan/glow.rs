//! What objects emit: the surfaces that rays from matt and rough surfaces meet by aim, besides by chance.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use tabray_world::emitter::LightSample;
use tabray_world::luminous::{AimedPoint, Luminous, chosen};
use tabray_world::material::Rgb;
use tabray_world::scene::model::{Model, Object};

/// The objects of a scene that emit light, as rays aim at them. A sample aims at one of them, in proportion to what they
/// emit.
pub struct Glow {
    objects: Vec<Glowing>,
    /// The sums of the chances of the objects up to each, its own included, up to a factor.
    sums: Vec<f64>,
    /// The number of each object of the scene among those that emit.
    numbers: Vec<Option<u32>>,
}

/// An object that emits light.
struct Glowing {
    surface: Luminous,
    radiance: Rgb,
    /// The probability with which samples choose it.
    chance: f64,
}

impl Glow {
    /// Returns what a scene's objects emit, where it lights others; `None` where there is nothing to aim at.
    pub fn of(model: &Model) -> Option<Self> {
        if model.camera.value.bounces == 0 {
            return None;
        }
        let (mut objects, mut sums, mut sum) = (Vec::new(), Vec::new(), 0.0);
        let mut numbers = vec![None; model.objects.len()];
        for (number, Object { material, shape, .. }) in numbers.iter_mut().zip(&model.objects) {
            let radiance = material.emission;
            let surface = if radiance == Rgb::ZERO { None } else { shape.luminous() };
            let Some(surface) = surface else { continue };
            let power = surface.area() * radiance.max_element();
            // Where numbers overflow, chance alone is left.
            if power > 0.0 && power.is_finite() {
                sum += power;
                sums.push(sum);
                *number = Some(objects.len() as u32);
                objects.push(Glowing { surface, radiance, chance: power });
            }
        }
        objects.iter_mut().for_each(|object| object.chance /= sum);
        (!objects.is_empty() && sum.is_finite()).then_some(Self { objects, sums, numbers })
    }

    /// Tells whether rays aim at an object.
    pub fn is_aimed_at(&self, object: usize) -> bool {
        self.numbers[object].is_some()
    }

    /// Chooses a point as seen from a place with a unit normal on the object of this index, by two numbers from 0 to 1.
    /// Also returns the density of the choice, per unit of solid angle.
    pub fn sample(
        &self,
        (from, at): (usize, DVec3),
        normal: DVec3,
        numbers: DVec2,
    ) -> Option<(LightSample, f64)> {
        let (index, part) = chosen(&self.sums, numbers.x)?;
        let Glowing { surface, radiance, chance } = &self.objects[index];
        if self.is_inside(from, index) {
            return None;
        }
        let AimedPoint { toward, distance, density } =
            surface.sample(at, normal, DVec2::new(part, numbers.y))?;
        let density = chance * density;
        // The surface itself is not in the way.
        let distance = distance * (1.0 - 1e-9);
        Some((LightSample { toward, distance, light: *radiance / (PI * density) }, density))
    }

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses the point of an object
    /// that is seen from a place on another along a unit vector, at a distance in world units, and where the object has
    /// this unit normal; `None` where it is not aimed at from this place.
    pub fn density(
        &self,
        object: usize,
        (from, at): (Option<usize>, DVec3),
        toward: DVec3,
        distance: f64,
        normal: DVec3,
    ) -> Option<f64> {
        let index = self.numbers[object]? as usize;
        let Glowing { surface, chance, .. } = &self.objects[index];
        let is_inside = from.is_some_and(|from| self.is_inside(from, index));
        (!is_inside).then_some(chance * surface.density(at, toward, distance, normal)?)
    }

    /// Tells whether rays that leave an object and meet the one of this number among those that emit are inside of a
    /// ball, where rounding decides on which side its points lie.
    fn is_inside(&self, from: usize, index: usize) -> bool {
        self.numbers[from] == Some(index as u32) && matches!(self.objects[index].surface, Luminous::Ball(_))
    }
}

/// Bounds what a sample that aims at a scene's objects finds: the brightest emission of any, in each channel.
pub fn brightest(model: &Model) -> Rgb {
    let emission = model.objects.iter().map(|object| object.material.emission);
    if model.camera.value.bounces == 0 { Rgb::ZERO } else { emission.fold(Rgb::ZERO, Rgb::max) }
}
