//! Bounds on the colours of the single rays through a part of an image.

use crate::enclosed::{EnclosedScene, EnclosingTracer, LightPoints, SceneBounds};
use crate::footprint::{LIMITS, lines};
use crate::plan::depth::{Depth, clearance};
use std::cell::Cell;
use tabray_exact::affine::Affine;
use tabray_world::material::Rgb;
use tabray_world::rules::Rules;
use tabray_world::scene::model::Model;
use tabray_world::sensor::Sensor;

/// Bounds the colours of a model's primary rays; a light with a size counts by its mean. The bounds are multiplied by
/// the steepest slope of the display, so white is 1 or more.
pub struct Brightness<'m> {
    model: &'m Model,
    depth: Depth,
    lights: Vec<usize>,
    bounds: SceneBounds,
}

impl<'m> Brightness<'m> {
    /// Prepares the bounds of a model.
    pub fn new(model: &'m Model) -> Self {
        let lights = (0..model.lights.len()).collect();
        Self { model, depth: Depth::of(model), lights, bounds: SceneBounds::of(model) }
    }

    /// Bounds all channels of all primary rays, where 1 is white; infinite where there is no bound.
    pub fn most(&self, camera: &Sensor) -> f64 {
        let (viewer, rules) = (camera.origins(), camera.rules);
        let hits = self.model.objects.iter().zip(&self.depth.objects).map(|(object, bounds)| {
            let distance = clearance(object, viewer.middle) - viewer.radius;
            match bounds.hit {
                0.0 => 0.0,
                hit if distance > 0.0 || rules == Rules::Free => rules.over_path(hit, distance),
                _ => f64::INFINITY,
            }
        });
        let background = self.model.background.as_ref();
        let background = background.map_or(0.0, |background| background.value.brightest().max_element());
        let most = hits.fold(background, |most, hit| if hit <= most { most } else { hit });
        camera.display().steepest() * most
    }

    /// Bounds the colours of all primary rays through a square of the image, given by its middle and half its width in
    /// pixels: the least and the greatest of each channel, infinite where there is no bound.
    pub fn within(&self, camera: &Sensor, middle: [f64; 2], half: f64) -> [Rgb; 2] {
        let Self { model, depth, lights, bounds } = self;
        let meets_uncertified = Cell::new(false);
        let window = camera.window();
        let scene = EnclosedScene { model, lights, depth: Some(depth), bounds, window, meets_uncertified };
        let Some(lines) = lines(camera, middle, half) else {
            let most = Rgb::splat(self.most(camera));
            return [-most, most];
        };
        let colour = EnclosingTracer::new(&scene, LIMITS, LightPoints::All).primary(&lines);
        let ranges = colour.unwrap_or([Affine::WHOLE; 3]).map(|channel| channel.range());
        let steepest = camera.display().steepest();
        let end = |of: fn(&tabray_exact::interval::Interval) -> f64, unknown: f64| {
            let ends = [0, 1, 2].map(|channel| of(&ranges[channel]));
            Rgb::from_array(ends.map(|end| if end.is_nan() { unknown } else { steepest * end }))
        };
        [end(|range| range.low, f64::NEG_INFINITY), end(|range| range.high, f64::INFINITY)]
    }
}
