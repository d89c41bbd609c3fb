//! The colour that a ray sees: first hits, light, shadows, mirrors and glass (the notes' `ray_trace`).

use crate::geometry::{Light, Ray, Span};
use crate::material::Rgb;
use crate::model::{Model, Object};
use crate::sample::Sample;
use glam::{DVec2, DVec3};

/// Light that has travelled farther than this is black.
const MAX_DIST: f64 = 20.0;

/// The rays that one pixel may cost. Mirrors that nearly touch would otherwise reflect each other for ever;
/// what lies beyond is black.
const MAX_RAYS: usize = 20_000;

/// What a ray meets first.
struct Hit<'m> {
    /// Which of the model's objects.
    index: usize,
    object: &'m Object,
    /// How far from the ray's origin.
    distance: f64,
    point: DVec3,
}

/// The colour of a pixel, before it is clamped to what a picture can show: `x` counts from the left and `y`
/// from the bottom.
pub fn pixel(model: &Model, x: usize, y: usize) -> Rgb {
    let camera = &model.camera.value;
    let colours = camera.rays(x, y).map(|(ray, sample)| colour(model, &ray, sample));
    colours.sum::<Rgb>() / f64::from(camera.samples)
}

/// The colour that a ray sees, before it is clamped. Lights with a size are met where `sample` says, or in
/// their middle.
pub fn colour(model: &Model, ray: &Ray, sample: Option<Sample>) -> Rgb {
    Tracer { model, sample, rays: MAX_RAYS }.trace(ray, 0.0, None)
}

struct Tracer<'m> {
    model: &'m Model,
    sample: Option<Sample>,
    /// The rays that the pixel may still cost.
    rays: usize,
}

impl<'m> Tracer<'m> {
    /// The light that comes back along a ray. The light has `travelled` this far from the viewer already, and
    /// the ray leaves the object `last`, which it does not see.
    fn trace(&mut self, ray: &Ray, travelled: f64, last: Option<usize>) -> Rgb {
        if travelled > MAX_DIST {
            return DVec3::ZERO;
        }
        let Some(hit) = self.closest(ray, &Span::RAY, last) else { return DVec3::ZERO };
        let travelled = travelled + hit.distance;
        let Object { material, shape, shader, .. } = hit.object;
        let normal = shape.normal(hit.point);

        let mut colour = shader.ambient(material, hit.point);
        for (index, light) in self.model.lights.iter().enumerate() {
            colour += self.illuminate(index, &*light.value, &hit, normal, ray.origin);
        }
        colour *= 1.0 / travelled;

        if material.transparency != 0.0 {
            let onward = Ray { origin: hit.point, dir: ray.dir };
            let behind = self.trace(&onward, travelled, Some(hit.index));
            colour = (1.0 - material.transparency) * colour + hit.object.tint(hit.point) * behind;
        }
        let specular = shader.specular(material, hit.point);
        if specular != DVec3::ZERO {
            let mirrored = ray.dir - 2.0 * ray.dir.dot(normal) * normal;
            let reflected = Ray { origin: hit.point, dir: mirrored };
            colour += specular * self.trace(&reflected, travelled, Some(hit.index));
        }
        colour
    }

    /// What one light adds to the colour of a hit, as seen from `eye`.
    fn illuminate(
        &mut self,
        index: usize,
        light: &dyn Light,
        hit: &Hit<'m>,
        normal: DVec3,
        eye: DVec3,
    ) -> Rgb {
        let to_light = self.place_on(index, light, hit.point) - hit.point;
        let distance = to_light.length();
        let to_light = to_light * (1.0 / distance);
        let cos = to_light.dot(normal);
        // The light is behind the surface, or on it (NaN).
        if cos.is_nan() || cos <= 0.0 {
            return DVec3::ZERO;
        }
        let Some(emissivity) = light.emissivity(hit.point) else { return DVec3::ZERO };
        let Some(passed) = self.unshadowed(hit, to_light, distance) else { return DVec3::ZERO };

        let Object { material, shader, .. } = hit.object;
        let light = emissivity * passed;
        let mut colour = shader.diffuse(material, hit.point) * light * (cos / distance);
        if material.shininess != 0.0 {
            let half = ((eye - hit.point).normalize() + to_light).normalize();
            let glint = libm::pow(half.dot(normal), material.shininess);
            colour += light * shader.specular(material, hit.point) * glint;
        }
        colour
    }

    /// The point of a light that this sample meets: on the disc that a ball of its size shows to `seen_from`.
    fn place_on(&self, index: usize, light: &dyn Light, seen_from: DVec3) -> DVec3 {
        let (middle, size) = (light.location(), light.size());
        let Some(sample) = self.sample.filter(|_| size > 0.0) else { return middle };
        let Some(axis) = (middle - seen_from).try_normalize() else { return middle };
        let (across, up) = axis.any_orthonormal_pair();
        let DVec2 { x, y } = sample.on_light(index);
        let (radius, angle) = (size * x.sqrt(), std::f64::consts::TAU * y);
        middle + radius * (libm::cos(angle) * across + libm::sin(angle) * up)
    }

    /// The part of each channel that gets from a light to a hit, or nothing where an opaque object stands
    /// between them. Glass on the way tints it.
    fn unshadowed(&mut self, hit: &Hit<'m>, to_light: DVec3, distance: f64) -> Option<Rgb> {
        let mut passed = DVec3::ONE;
        let (mut from, mut skip, mut left) = (hit.point, hit.index, distance);
        loop {
            let ray = Ray { origin: from, dir: to_light };
            let Some(blocker) = self.closest(&ray, &Span { near: 0.0, far: left }, Some(skip)) else {
                return Some(passed);
            };
            if blocker.object.material.transparency == 0.0 {
                return None;
            }
            passed *= blocker.object.tint(blocker.point);
            (from, skip) = (blocker.point, blocker.index);
            left -= blocker.distance;
        }
    }

    /// What a ray meets first within a span, the object that it leaves excepted. Of two at the same distance
    /// the earlier one in the scene wins.
    fn closest(&mut self, ray: &Ray, within: &Span, skip: Option<usize>) -> Option<Hit<'m>> {
        self.rays = self.rays.checked_sub(1)?;
        let mut nearest = None;
        let mut within = *within;
        for (index, object) in self.model.objects.iter().enumerate() {
            if Some(index) == skip {
                continue;
            }
            let distance = object.shape.distance(ray, &within);
            if distance < within.far {
                within.far = distance;
                nearest = Some((index, object));
            }
        }
        let (index, object) = nearest?;
        Some(Hit { index, object, distance: within.far, point: ray.at(within.far) })
    }
}
