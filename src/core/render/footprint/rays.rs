//! The colours that the rays through a footprint return.

use super::light;
use super::scene::{Colour, Path, Place, Scene};
use super::surface::{Surface, is_black, tint};
use crate::geometry::sight::Line;
use crate::render::limits::MAX_DIST;
use crate::world::certify::FootprintHit;
use tabray_exact::affine::Affine;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, dot};

/// The number of hits in a footprint after which its branches are no longer followed, but bounded.
const MAX_HITS: usize = 48;

/// The number of rays one after the other, each continuing the last, after which they are bounded.
const MAX_DEPTH: usize = 24;

/// The number of places that a ray may hit first from which on it is bounded.
const MAX_PLACES: usize = 6;

/// A branch that can add no more than this to a pixel's channel is bounded and not followed: 1/400 of a level.
const NEGLIGIBLE: f64 = 1e-5;

/// Rays.
struct Ray {
    path: Path,
    /// The length of the lines' direction, in world units.
    length: Affine,
    /// The length of the path from the viewer to the lines' start, in world units.
    travelled: Affine,
    /// A bound on the factor by which the rays' light is multiplied.
    weight: f64,
    depth: usize,
}

/// Traces the rays of one footprint.
pub(super) struct Tracer<'s> {
    scene: &'s Scene<'s>,
    hits: usize,
}

impl<'s> Tracer<'s> {
    pub fn new(scene: &'s Scene<'s>) -> Self {
        Self { scene, hits: 0 }
    }

    /// Encloses the colours that primary rays return.
    pub fn primary(&mut self, line: &Line<Affine>) -> Colour {
        let length = dot(line.dir, line.dir).sqrt();
        let path = Path { line: *line, leaves: None };
        self.colour(&Ray { path, length, travelled: Affine::constant(0.0), weight: 1.0, depth: 0 })
    }

    fn colour(&mut self, ray: &Ray) -> Colour {
        let black = [Affine::constant(0.0); 3];
        let travelled = ray.travelled.range();
        if travelled.low > MAX_DIST {
            return black;
        }
        let most = self.bound(ray);
        let is_negligible = ray.depth > 0 && ray.weight * most < NEGLIGIBLE;
        if is_negligible || ray.depth >= MAX_DEPTH {
            return up_to(most);
        }
        let (places, is_something) = self.scene.first(&ray.path);
        let are_many = places.len() > MAX_PLACES || self.hits + places.len() > MAX_HITS;
        if are_many || travelled.high > MAX_DIST {
            let bounds = places.iter().map(|(hit, place)| self.bound_at(ray, hit.low(), *place));
            return up_to(bounds.fold(self.behind(), f64::max));
        }
        self.hits += places.len();
        let mut any = (!is_something).then(|| self.background(ray));
        for (hit, place) in places {
            let most = self.bound_at(ray, hit.low(), place);
            let seen = match hit {
                FootprintHit::Hits(t) | FootprintHit::Perhaps(t) => self.seen(ray, t, place),
                FootprintHit::Doubtful(_) => up_to(most),
            };
            let seen = seen.map(|channel| if channel.rest > most { within(most) } else { channel });
            any = Some(any.map_or(seen, |any| hull(any, seen)));
        }
        any.unwrap_or(black)
    }

    /// Encloses the colours that rays return which hit nothing.
    fn background(&self, ray: &Ray) -> Colour {
        let Some(background) = &self.scene.model.background else { return [Affine::constant(0.0); 3] };
        let toward = ray.path.line.dir.map(|part| (part / ray.length).range());
        background.value.enclose(toward).map(Affine::from)
    }

    /// Encloses the colours that rays return which hit a place at t. Where an interface divides the rays, nothing is known.
    fn seen(&mut self, ray: &Ray, t: Affine, place: Place) -> Colour {
        if self.scene.model.objects[place.object].material.interface.is_some() {
            return [Affine::WHOLE; 3];
        }
        let surfaces = Surface::new(self.scene, &ray.path.line, t, place);
        let any = surfaces.iter().map(|surface| self.shaded(ray, t, surface)).reduce(hull);
        any.unwrap_or([Affine::WHOLE; 3])
    }

    fn shaded(&mut self, ray: &Ray, t: Affine, surface: &Surface) -> Colour {
        let travelled = ray.travelled + t * ray.length;
        let mut colour = surface.ambient;
        let dir = ray.path.line.dir;
        let toward = dir.map(|part| part / ray.length);
        for light in &self.scene.model.lights {
            let added = light::shine(self.scene, &*light.value, surface, toward);
            colour = [0, 1, 2].map(|channel| colour[channel] + added[channel]);
        }
        colour = colour.map(|channel| channel / travelled);
        let material = &self.scene.model.objects[surface.place.object].material;
        if material.transparency != 0.0 {
            let Some(tint) = tint(material.transparency, surface.diffuse) else {
                return [Affine::WHOLE; 3];
            };
            let kept = Affine::constant(1.0) - Affine::constant(material.transparency);
            let behind = self.secondary(ray, surface, travelled, dir, &tint);
            colour = [0, 1, 2].map(|channel| kept * colour[channel] + tint[channel] * behind[channel]);
        }
        if !is_black(&surface.specular) {
            let Some(dir) = surface.mirrored(dir) else { return [Affine::WHOLE; 3] };
            let seen = self.secondary(ray, surface, travelled, dir, &surface.specular);
            colour = [0, 1, 2].map(|channel| colour[channel] + surface.specular[channel] * seen[channel]);
        }
        colour
    }

    /// Encloses the colours that rays return which continue from a surface. Their light is multiplied by `factor`.
    fn secondary(
        &mut self,
        ray: &Ray,
        surface: &Surface,
        travelled: Affine,
        dir: [Affine; 3],
        factor: &Colour,
    ) -> Colour {
        let path = Path { line: Line { origin: surface.at, dir }, leaves: Some(surface.place) };
        let most = factor.iter().fold(0.0_f64, |most, channel| most.max(channel.range().magnitude()));
        // A mirrored direction is as long as the one that it is mirrored from.
        let length = ray.length;
        self.colour(&Ray { path, length, travelled, weight: ray.weight * most, depth: ray.depth + 1 })
    }

    /// Bounds the magnitude of what rays return.
    fn bound(&self, ray: &Ray) -> f64 {
        let most = match (ray.path.leaves, self.scene.depth) {
            (Some(place), Some(depth)) => depth.beyond(Some(place.object)),
            _ => self.scene.most,
        };
        self.over_path(ray, 0.0, most)
    }

    /// Bounds the magnitude of what rays return that hit a place at no smaller t than this.
    fn bound_at(&self, ray: &Ray, t: f64, place: Place) -> f64 {
        let most = self.scene.depth.map_or(self.scene.most, |depth| depth.objects[place.object].hit);
        self.over_path(ray, t, most)
    }

    /// Bounds the magnitude of light, given a bound on it times its path length, where rays hit nothing before t.
    fn over_path(&self, ray: &Ray, t: f64, most: f64) -> f64 {
        if most == 0.0 {
            return self.behind();
        }
        let path = Interval::point(t) * ray.length.range() + ray.travelled.range();
        let bound = (Interval::point(most) / Interval { low: path.low.max(0.0), high: path.high }).high;
        if bound.is_nan() { f64::INFINITY } else { bound.max(self.behind()) }
    }

    /// Bounds the light of the background.
    fn behind(&self) -> f64 {
        let background = self.scene.model.background.as_ref();
        background.map_or(0.0, |background| background.value.brightest().max_element())
    }
}

/// Encloses all colours up to a magnitude.
fn up_to(most: f64) -> Colour {
    [within(most); 3]
}

fn within(most: f64) -> Affine {
    if most.is_finite() { Interval { low: -most, high: most }.into() } else { Affine::WHOLE }
}

fn hull(one: Colour, other: Colour) -> Colour {
    [0, 1, 2].map(|channel| one[channel].hull(other[channel]))
}
