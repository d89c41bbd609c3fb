//! Backgrounds that light surfaces.

use crate::background::EnclosedBackground;
use crate::emitter::{Emitter, Extent, LightSample, by_cosine};
use crate::light::Light;
use crate::material::Rgb;
use crate::number::Number;
use crate::sky_map::SkyMap;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};
use tabray_exact::scalar::per_axis;

/// The light of a background. Directions are chosen by the cosine of the angle at which light arrives. Where the
/// background has detail, half of them are chosen by its brightness.
pub struct SkyLight {
    background: Arc<dyn EnclosedBackground>,
    map: OnceLock<Option<SkyMap>>,
}

impl SkyLight {
    /// Makes the light of a background, which is examined when it first lights a surface.
    pub fn new(background: Arc<dyn EnclosedBackground>) -> Self {
        Self { background, map: OnceLock::new() }
    }

    fn map(&self) -> Option<&SkyMap> {
        self.map.get_or_init(|| SkyMap::of(&*self.background)).as_ref()
    }
}

impl Light for SkyLight {
    fn location(&self) -> DVec3 {
        DVec3::ZERO
    }

    fn is_far(&self) -> bool {
        true
    }

    fn sent<N: Number>(&self, _toward: [N; 3]) -> [N; 3] {
        let most = self.background.brightest();
        per_axis(|channel| N::any(0.0, most[channel]))
    }

    /// The density of directions is at least half of the cosine density.
    fn brightest(&self) -> Option<Rgb> {
        Some(2.0 * self.background.brightest())
    }

    fn emitter(&self) -> Option<&dyn Emitter> {
        Some(self)
    }
}

impl Emitter for SkyLight {
    fn sample(&self, _at: DVec3, normal: DVec3, numbers: DVec2) -> Option<LightSample> {
        let Some(map) = self.map() else {
            let toward = DVec3::from(by_cosine(normal.to_array(), numbers)?);
            let cosine = toward.dot(normal);
            let light = self.background.colour_toward(toward) / cosine;
            return (cosine > 0.0).then_some(LightSample { toward, distance: f64::INFINITY, light });
        };
        // The middle of the range chooses by the cosine, so a single sample is the most even one.
        let DVec2 { x, y } = numbers;
        let toward = match x {
            x if (0.25..0.75).contains(&x) => {
                by_cosine(normal.to_array(), DVec2::new(2.0 * (x - 0.25), y))?.into()
            }
            x => map.direction(DVec2::new(if x < 0.25 { 2.0 * x } else { 2.0 * x - 1.0 }, y)),
        };
        let cosine = toward.dot(normal);
        if cosine <= 0.0 {
            return None;
        }
        let density = 0.5 * cosine + 0.5 * PI * map.density(toward);
        let light = self.background.colour_toward(toward) / density;
        Some(LightSample { toward, distance: f64::INFINITY, light })
    }

    fn extent(&self) -> Extent<'_> {
        Extent::Sky { background: &*self.background, map: self.map() }
    }

    /// Mirrors show the background itself.
    fn has_highlights(&self) -> bool {
        false
    }
}
