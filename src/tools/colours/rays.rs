//! The colours that rays return, in intervals.

use super::light;
use super::scene::{Colour, FirstHit, Number, Path, Place, Scene};
use super::surface::{Surface, is_black, tint};
use tabray_core::geometry::sight::Line;
use tabray_core::render::limits::MAX_DIST;
use tabray_core::world::sample::Sample;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, dot, per_axis};

/// The number of rays after which a pixel's branches are no longer followed, but bounded.
const MAX_RAYS: usize = 4000;

/// The number of rays one after the other, each continuing the last, after which they are bounded.
const MAX_DEPTH: usize = 300;

/// A branch that can add no more than this to a pixel's channel is bounded and not followed: a part of a level that no
/// byte is likely to notice.
const NEGLIGIBLE: f64 = 1e-11;

/// A ray.
struct Ray<F> {
    path: Path<F>,
    /// The length of the line's direction, in world units.
    length: Interval<F>,
    /// The length of the path from the viewer to the line's start, in world units.
    travelled: Interval<F>,
    /// A bound on the factor by which the ray's light is multiplied.
    weight: f64,
    depth: usize,
}

/// Traces the rays of one sample.
pub(super) struct Tracer<'s, 'p, 'm> {
    scene: &'s Scene<'p, 'm>,
    /// The sample of the pixel, if it has several.
    sample: Option<Sample>,
    rays: usize,
    is_spent: bool,
}

impl<'s, 'p, 'm> Tracer<'s, 'p, 'm> {
    pub fn new(scene: &'s Scene<'p, 'm>, sample: Option<Sample>) -> Self {
        Self { scene, sample, rays: 0, is_spent: false }
    }

    /// Tells whether branches were not followed because of their number.
    pub fn is_spent(&self) -> bool {
        self.is_spent
    }

    /// Encloses the colour that a primary ray returns; `None` where it is open.
    pub fn primary<F: Number>(&mut self, line: &Line<Interval<F>>) -> Option<Colour<F>> {
        let length = dot(line.dir, line.dir).sqrt();
        let path = Path { line: *line, leaves: None };
        self.colour(&Ray { path, length, travelled: Interval::constant(0.0), weight: 1.0, depth: 0 })
    }

    fn colour<F: Number>(&mut self, ray: &Ray<F>) -> Option<Colour<F>> {
        let black = [Interval::constant(0.0); 3];
        let farthest = F::of(MAX_DIST);
        if ray.travelled.low > farthest {
            return Some(black);
        }
        if let Some(bound) = self.bound(ray) {
            return Some([bound; 3]);
        }
        if ray.travelled.high > farthest || self.is_spent {
            return None;
        }
        match self.scene.first(&ray.path) {
            FirstHit::Nothing => Some(self.background(ray)),
            FirstHit::Hit(t, place) => self.seen(ray, t, place),
            FirstHit::OneOf(places, may_be_nothing) => {
                let hull = |one: Colour<F>, other: Colour<F>| per_axis(|at| one[at].hull(other[at]));
                let mut any = may_be_nothing.then(|| self.background(ray));
                for (t, place) in places {
                    let seen = self.seen(ray, t, place)?;
                    any = Some(any.map_or(seen, |any| hull(any, seen)));
                }
                any
            }
            FirstHit::Open => None,
        }
    }

    /// Encloses the colour that a ray returns which hits nothing.
    fn background<F: Number>(&self, ray: &Ray<F>) -> Colour<F> {
        let Some(background) = &self.scene.plan.model.background else { return [Interval::constant(0.0); 3] };
        let toward = per_axis(|axis| (ray.path.line.dir[axis] / ray.length).coarse());
        background.value.enclose(toward).map(Interval::from_f64)
    }

    /// Encloses the colour that a ray returns which hits a place at t.
    fn seen<F: Number>(&mut self, ray: &Ray<F>, t: Interval<F>, place: Place) -> Option<Colour<F>> {
        self.rays += 1;
        let surface = Surface::new(self.scene, &ray.path.line, t, place)?;
        let travelled = ray.travelled + t * ray.length;
        let mut colour = surface.ambient;
        let toward = per_axis(|axis| ray.path.line.dir[axis] / ray.length);
        for index in &self.scene.plan.needs.lights {
            let light = &*self.scene.plan.model.lights[*index].value;
            let draw = self.sample.map(|sample| sample.on_light(*index));
            let added = light::shine(self.scene, light, draw, &surface, toward)?;
            colour = per_axis(|channel| colour[channel] + added[channel]);
        }
        colour = per_axis(|channel| colour[channel] / travelled);
        let material = &self.scene.objects[place.object].material;
        if material.interface.is_some() {
            return None;
        }
        if material.transparency != 0.0 {
            let tint = tint(material.transparency, surface.diffuse)?;
            let kept = Interval::constant(1.0) - Interval::constant(material.transparency);
            let behind = self.secondary(ray, &surface, travelled, ray.path.line.dir, &tint)?;
            colour = per_axis(|channel| kept * colour[channel] + tint[channel] * behind[channel]);
        }
        if !is_black(&surface.specular) {
            let dir = surface.mirrored(ray.path.line.dir)?;
            let seen = self.secondary(ray, &surface, travelled, dir, &surface.specular)?;
            colour = per_axis(|channel| colour[channel] + surface.specular[channel] * seen[channel]);
        }
        Some(colour)
    }

    /// Encloses the colour that a ray returns which continues from a surface. Its light is multiplied by `factor`.
    fn secondary<F: Number>(
        &mut self,
        ray: &Ray<F>,
        surface: &Surface<F>,
        travelled: Interval<F>,
        dir: [Interval<F>; 3],
        factor: &Colour<F>,
    ) -> Option<Colour<F>> {
        let path = Path { line: Line { origin: surface.at, dir }, leaves: Some(surface.place) };
        let most = factor.iter().fold(0.0_f64, |most, channel| most.max(channel.coarse().magnitude()));
        // A mirrored direction is as long as the one that it is mirrored from.
        let length = ray.length;
        self.colour(&Ray { path, length, travelled, weight: ray.weight * most, depth: ray.depth + 1 })
    }

    /// Bounds what a ray returns that leaves an object, where that is negligible, or where there are too many rays.
    fn bound<F: Number>(&mut self, ray: &Ray<F>) -> Option<Interval<F>> {
        let (depth, leaves) = (self.scene.plan.depth.as_ref()?, ray.path.leaves?);
        let most = depth.beyond(Some(leaves.object)) / ray.travelled.coarse().low;
        let is_negligible = ray.weight * most < NEGLIGIBLE;
        // An operation with many digits takes a hundred times as long.
        let fewer = if F::IS_LONG { 10 } else { 1 };
        let is_last = self.rays >= MAX_RAYS / fewer || ray.depth >= MAX_DEPTH / fewer;
        self.is_spent |= is_last && !is_negligible;
        // Written so that a NaN is no bound.
        let is_bound = (is_negligible || is_last) && most < f64::INFINITY;
        is_bound.then(|| Interval { low: F::of(-most), high: F::of(most) })
    }
}
