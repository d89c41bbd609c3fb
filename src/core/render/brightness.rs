//! Bounds on what the rays through a part of an image return, each by itself.

use super::lines;
use super::rays::Tracer;
use super::scene::{Scene, boxes};
use crate::geometry::aabb::Aabb;
use crate::render::plan::depth::{Depth, clearance};
use crate::scene::model::Model;
use crate::world::film::Film;
use crate::world::material::Rgb;

/// Bounds the colours of a model's primary rays, where light with a size counts by its mean.
pub struct Brightness<'m> {
    model: &'m Model,
    depth: Depth,
    boxes: Vec<Option<Aabb>>,
    passes_fractions: bool,
}

impl<'m> Brightness<'m> {
    /// Prepares the bounds of a model.
    pub fn new(model: &'m Model) -> Self {
        let passes_fractions = model.tints_are_fractions();
        Self { model, depth: Depth::of(model), boxes: boxes(model), passes_fractions }
    }

    /// Bounds any channel of any primary ray, where 1 is white; infinite where there is no bound.
    pub fn most(&self, camera: &Film) -> f64 {
        let viewer = camera.origins();
        let hits = self.model.objects.iter().zip(&self.depth.objects).map(|(object, bounds)| {
            let distance = clearance(object, viewer.middle) - viewer.radius;
            match bounds.hit {
                0.0 => 0.0,
                hit if distance > 0.0 => hit / distance,
                _ => f64::INFINITY,
            }
        });
        let background = self.model.background.as_ref();
        let background = background.map_or(0.0, |background| background.value.brightest().max_element());
        camera.gain() * hits.fold(background, |most, hit| if hit <= most { most } else { hit })
    }

    /// Bounds the colours of all primary rays through a square of the image, given by its middle and half its width in
    /// pixels: the least and the greatest of each channel, infinite where there is no bound.
    pub fn within(&self, camera: &Film, middle: [f64; 2], half: f64) -> [Rgb; 2] {
        let Self { model, depth, boxes, passes_fractions } = self;
        let (most, passes_fractions) = (depth.most, *passes_fractions);
        let scene = Scene { model, depth: Some(depth), boxes, most, passes_fractions };
        let Some(lines) = lines(camera, middle, half) else {
            let most = Rgb::splat(self.most(camera));
            return [-most, most];
        };
        let ranges = Tracer::new(&scene).primary(&lines).map(|channel| channel.range());
        let end = |of: fn(&tabray_exact::interval::Interval) -> f64, unknown: f64| {
            let ends = [0, 1, 2].map(|channel| of(&ranges[channel]));
            Rgb::from_array(ends.map(|end| if end.is_nan() { unknown } else { camera.gain() * end }))
        };
        [end(|range| range.low, f64::NEG_INFINITY), end(|range| range.high, f64::INFINITY)]
    }
}
