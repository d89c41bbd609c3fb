//! The colour that a ray sees: first hits, light, shadows, mirrors and glass (the notes' `ray_trace`).

use crate::accuracy::Accuracy;
use crate::geometry::{Light, Ray, Side, Span};
use crate::material::Rgb;
use crate::model::{Model, Object};
use crate::sample::Sample;
use crate::watch::{Event, Hit, Outcome, Purpose, Reason, Watch};
use glam::{DVec2, DVec3};

/// Light that has travelled farther than this is black.
pub(crate) const MAX_DIST: f64 = 20.0;

/// The rays that one pixel may cost. Mirrors that nearly touch would otherwise reflect each other for ever;
/// what lies beyond is black.
pub(crate) const MAX_RAYS: usize = 20_000;

/// The colour of a pixel, before it is clamped to what a picture can show: `x` counts from the left and `y`
/// from the bottom.
pub fn pixel(model: &Model, x: usize, y: usize) -> Rgb {
    watch_pixel(model, x, y, &mut ())
}

/// As [`pixel`], and `watch` sees how it comes about.
pub fn watch_pixel(model: &Model, x: usize, y: usize, watch: &mut impl Watch) -> Rgb {
    let camera = &model.camera.value;
    let colours = camera.rays(x, y).map(|(ray, sample)| watch_colour(model, &ray, sample, watch));
    colours.sum::<Rgb>() / f64::from(camera.samples)
}

/// The colour that a ray sees, before it is clamped. Lights with a size are met where `sample` says, or in
/// their middle.
pub fn colour(model: &Model, ray: &Ray, sample: Option<Sample>) -> Rgb {
    watch_colour(model, ray, sample, &mut ())
}

/// As [`colour`], and `watch` sees how it comes about.
pub fn watch_colour(model: &Model, ray: &Ray, sample: Option<Sample>, watch: &mut impl Watch) -> Rgb {
    watch.see(Event::Begin(Purpose::Primary));
    Tracer { model, sample, rays: MAX_RAYS, watch }.trace(ray, 0.0, None)
}

/// What a ray from the viewer meets first.
pub fn first_hit<'m>(model: &'m Model, ray: &Ray) -> Option<Hit<'m>> {
    let mut tracer = Tracer { model, sample: None, rays: MAX_RAYS, watch: &mut () };
    tracer.closest(ray, &Span::RAY, None)
}

struct Tracer<'m, 'w, W> {
    model: &'m Model,
    sample: Option<Sample>,
    /// The rays that the pixel may still cost.
    rays: usize,
    watch: &'w mut W,
}

impl<'m, W: Watch> Tracer<'m, '_, W> {
    /// The light that comes back along a ray. The light has `travelled` this far from the viewer already, and
    /// the ray leaves the object `last` on a side of it, and does not see it where it starts.
    fn trace(&mut self, ray: &Ray, travelled: f64, last: Option<(usize, Side)>) -> Rgb {
        let colour = self.follow(ray, travelled, last);
        self.watch.see(Event::Colour(colour));
        colour
    }

    #[inline(always)]
    fn follow(&mut self, ray: &Ray, travelled: f64, last: Option<(usize, Side)>) -> Rgb {
        if travelled > MAX_DIST {
            self.watch.see(Event::Dropped(Reason::TooFar));
            return DVec3::ZERO;
        }
        let Some(hit) = self.closest(ray, &Span::RAY, last) else { return DVec3::ZERO };
        let travelled = travelled + hit.distance;
        let Object { material, shape, shader, .. } = hit.object;
        let normal = shape.normal(hit.point);
        let side = Side::seen_along(ray.dir, normal);
        let normal = if side == Side::Inside && shape.is_two_sided() { -normal } else { normal };

        let mut colour = shader.ambient(material, hit.point);
        self.watch.see(Event::Surface { normal, ambient: colour });
        for (index, light) in self.model.lights.iter().enumerate() {
            colour += self.illuminate(index, &*light.value, &hit, (normal, side), ray.origin);
        }
        colour *= 1.0 / travelled;
        self.watch.see(Event::Shaded { hit: &hit, travelled, colour });

        if material.transparency != 0.0 {
            let onward = Ray { origin: hit.point, dir: ray.dir };
            let (tint, kept) = (hit.object.tint(hit.point), 1.0 - material.transparency);
            self.watch.see(Event::Begin(Purpose::Transmitted { tint, kept }));
            colour =
                kept * colour + tint * self.trace(&onward, travelled, Some((hit.index, side.opposite())));
        }
        let specular = shader.specular(material, hit.point);
        if specular != DVec3::ZERO {
            let mirrored = ray.dir - 2.0 * ray.dir.dot(normal) * normal;
            let reflected = Ray { origin: hit.point, dir: mirrored };
            self.watch.see(Event::Begin(Purpose::Reflected { specular }));
            colour += specular * self.trace(&reflected, travelled, Some((hit.index, side)));
        }
        colour
    }

    /// What one light adds to the colour of a hit, as seen from `eye`.
    fn illuminate(
        &mut self,
        index: usize,
        light: &dyn Light,
        hit: &Hit<'m>,
        (normal, side): (DVec3, Side),
        eye: DVec3,
    ) -> Rgb {
        let to_light = self.place_on(index, light, hit.point) - hit.point;
        let distance = to_light.length();
        let to_light = to_light * (1.0 / distance);
        let cos = to_light.dot(normal);
        // The light is behind the surface, or on it (NaN).
        if cos.is_nan() || cos <= 0.0 {
            self.watch.see(Event::Light(index, Outcome::Behind));
            return DVec3::ZERO;
        }
        let Some(emissivity) = light.emissivity(hit.point) else {
            self.watch.see(Event::Light(index, Outcome::Aside));
            return DVec3::ZERO;
        };
        let passed = match self.unshadowed(hit, side, to_light, distance) {
            Ok(passed) => passed,
            Err(blocker) => {
                self.watch.see(Event::Light(index, Outcome::Blocked(blocker)));
                return DVec3::ZERO;
            }
        };

        let Object { material, shader, .. } = hit.object;
        let light = emissivity * passed;
        let mut colour = shader.diffuse(material, hit.point) * light * (cos / distance);
        if material.shininess != 0.0 {
            let half = ((eye - hit.point).normalize() + to_light).normalize();
            let glint = libm::pow(half.dot(normal), material.shininess);
            colour += light * shader.specular(material, hit.point) * glint;
        }
        self.watch.see(Event::Light(index, Outcome::Shines { passed, colour }));
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

    /// The part of each channel that gets from a light to a hit, or the opaque object that stands between them.
    /// Glass on the way tints it.
    fn unshadowed(
        &mut self,
        hit: &Hit<'m>,
        side: Side,
        to_light: DVec3,
        distance: f64,
    ) -> Result<Rgb, usize> {
        let mut passed = DVec3::ONE;
        // A surface that the light lies on is no blocker, however rounding has it.
        let slack = match self.model.camera.value.accuracy {
            Accuracy::Classic => 0.0,
            _ => 16.0 * f64::EPSILON * (distance + hit.point.abs().max_element()),
        };
        let (mut from, mut last, mut left) = (hit.point, (hit.index, side), distance - slack);
        loop {
            let ray = Ray { origin: from, dir: to_light };
            let within = Span { far: left, ..Span::RAY };
            self.watch.see(Event::Begin(Purpose::Shadow { distance: left }));
            let Some(blocker) = self.closest(&ray, &within, Some(last)) else { return Ok(passed) };
            if blocker.object.material.transparency == 0.0 {
                return Err(blocker.index);
            }
            passed *= blocker.object.tint(blocker.point);
            let normal = blocker.object.shape.normal(blocker.point);
            last = (blocker.index, Side::seen_along(to_light, normal).opposite());
            from = blocker.point;
            left -= blocker.distance;
        }
    }

    /// What a ray meets first within a span, but for the place where it leaves an object. Of two at the same
    /// distance the earlier one in the scene wins.
    fn closest(&mut self, ray: &Ray, within: &Span, last: Option<(usize, Side)>) -> Option<Hit<'m>> {
        let Some(rays) = self.rays.checked_sub(1) else {
            self.watch.see(Event::Dropped(Reason::TooMany));
            return None;
        };
        self.rays = rays;
        self.watch.see(Event::Search(ray));
        let mut nearest = None;
        let mut within = *within;
        for (index, object) in self.model.objects.iter().enumerate() {
            let leaves = last.filter(|(last, _)| *last == index).map(|(_, side)| side);
            if leaves.is_some() && object.shape.is_convex() {
                self.watch.see(Event::Tested(index, None));
                continue;
            }
            let distance = object.shape.distance(ray, &Span { leaves, ..within });
            self.watch.see(Event::Tested(index, Some(distance)));
            if distance < within.far {
                within.far = distance;
                nearest = Some((index, object));
            }
        }
        let hit = nearest.map(|(index, object)| Hit {
            index,
            object,
            distance: within.far,
            point: ray.at(within.far),
        });
        self.watch.see(Event::Met(hit.as_ref()));
        hit
    }
}
