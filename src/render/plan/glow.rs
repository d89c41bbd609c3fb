//! What objects emit: the surfaces that rays from matt and rough surfaces meet by aim, besides by chance.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::ops::Range;
use tabray_world::emitter::{FREE, LightSample};
use tabray_world::luminous::{AimedPoint, Luminous, chosen};
use tabray_world::material::{Look, Rgb};
use tabray_world::scene::model::{Model, Object};

/// What the objects of a scene emit, as rays aim at it. A sample aims at one of its parts, in proportion to what they emit.
pub struct Glow {
    parts: Vec<Part>,
    /// The sums of the chances of the parts up to each, its own included, up to a factor.
    sums: Vec<f64>,
    /// The numbers of the parts of each object of the scene.
    of_objects: Vec<Range<usize>>,
}

/// A part of an object that gives the same light everywhere.
struct Part {
    surface: Luminous,
    radiance: Rgb,
    /// Whether the object's material gives the light, and not its shader.
    is_of_material: bool,
    /// The probability with which samples choose it.
    chance: f64,
}

impl Glow {
    /// Returns what a scene's objects emit, where it lights others; `None` where there is nothing to aim at.
    pub fn of(model: &Model) -> Option<Self> {
        if model.camera.value.bounces == 0 {
            return None;
        }
        let (mut parts, mut sums, mut sum) = (Vec::new(), Vec::new(), 0.0);
        let mut of_objects = Vec::with_capacity(model.objects.len());
        for Object { material, shape, shader, .. } in &model.objects {
            let start = parts.len();
            let is_of_material = material.emission != Rgb::ZERO;
            let own = match is_of_material {
                true => shape.luminous().map(|surface| (surface, material.emission)).into_iter().collect(),
                false => shader.glowing(),
            };
            for (surface, radiance) in own {
                let power = surface.area() * radiance.max_element();
                // Where numbers overflow, chance alone is left.
                if power > 0.0 && power.is_finite() {
                    sum += power;
                    sums.push(sum);
                    parts.push(Part { surface, radiance, is_of_material, chance: power });
                }
            }
            of_objects.push(start..parts.len());
        }
        parts.iter_mut().for_each(|part| part.chance /= sum);
        (!parts.is_empty() && sum.is_finite()).then_some(Self { parts, sums, of_objects })
    }

    /// Tells whether rays aim at an object.
    pub fn is_aimed_at(&self, object: usize) -> bool {
        !self.of_objects[object].is_empty()
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
        let Part { surface, radiance, chance, .. } = &self.parts[index];
        if self.is_inside(from, index) {
            return None;
        }
        let AimedPoint { toward, distance, density } =
            surface.sample(at, normal, DVec2::new(part, numbers.y))?;
        let density = chance * density;
        let distance = FREE * distance;
        Some((LightSample { toward, distance, light: *radiance / (PI * density) }, density))
    }

    /// Returns the density, per unit of solid angle, with which [`sample`](Self::sample) chooses the point of an object
    /// that is seen from a place on another along a unit vector, at a distance in world units, and where the object has
    /// this unit normal and its shader gives this light; `None` where it is not aimed at from this place.
    pub fn density(
        &self,
        (object, normal, light): (usize, DVec3, Rgb),
        (from, at): (Option<usize>, DVec3),
        toward: DVec3,
        distance: f64,
    ) -> Option<f64> {
        let is_it = |index: &usize| {
            let Part { radiance, is_of_material, .. } = &self.parts[*index];
            *is_of_material || *radiance == light
        };
        let index = self.of_objects[object].clone().find(is_it)?;
        let Part { surface, chance, .. } = &self.parts[index];
        let is_inside = from.is_some_and(|from| self.is_inside(from, index));
        (!is_inside).then_some(chance * surface.density(at, toward, distance, normal)?)
    }

    /// Tells whether rays that leave an object and meet the part of this number are inside of a ball, where rounding
    /// decides on which side its points lie.
    fn is_inside(&self, from: usize, index: usize) -> bool {
        self.of_objects[from].contains(&index) && matches!(self.parts[index].surface, Luminous::Ball(_))
    }
}

/// Bounds what a sample that aims at a scene's objects finds, in each channel, given the objects' brightest looks.
pub fn brightest(model: &Model, looks: &[Option<Look>]) -> Rgb {
    if model.camera.value.bounces == 0 {
        return Rgb::ZERO;
    }
    let emitted = model.objects.iter().zip(looks).map(|(Object { material, shader, .. }, look)| {
        // What a shader gives is a part of the ambient light that it shows.
        let own = match (shader.uniform(material), look) {
            (Some(_), _) => Rgb::ZERO,
            (None, Some(look)) => look.ambient.abs(),
            (None, None) => Rgb::INFINITY,
        };
        material.emission + own
    });
    emitted.fold(Rgb::ZERO, Rgb::max)
}
