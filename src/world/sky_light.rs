//! Backgrounds that light surfaces.

use crate::background::EnclosedBackground;
use crate::emitter::{Emitter, EmitterPoint, EnclosedEmitter, by_cosine};
use crate::light::Light;
use crate::material::Rgb;
use crate::number::Number;
use crate::sky_map::SkyMap;
use glam::{DVec2, DVec3};
use std::sync::{Arc, OnceLock};
use tabray_exact::scalar::{constants, dot, per_axis};

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

    fn emitter(&self) -> Option<&dyn EnclosedEmitter> {
        Some(self)
    }
}

impl Emitter for SkyLight {
    fn sample<N: Number>(&self, _at: [N; 3], normal: [N; 3], numbers: DVec2) -> Option<EmitterPoint<N>> {
        let (n, map, DVec2 { x, y }) = (N::constant, self.map(), numbers);
        let toward = match map {
            None => by_cosine(normal, numbers)?,
            // The middle of the range chooses by the cosine, so a single sample is the most even one.
            Some(_) if (0.25..0.75).contains(&x) => by_cosine(normal, DVec2::new(2.0 * (x - 0.25), y))?,
            Some(map) => {
                constants(map.direction(DVec2::new(if x < 0.25 { 2.0 * x } else { 2.0 * x - 1.0 }, y)))
            }
        };
        let cosine = dot(toward, normal);
        // A direction along the surface gives no light.
        if (n(0.0) - cosine).sign()? == n(1.0) {
            return Some(EmitterPoint { toward, is_far: true, light: [n(0.0); 3] });
        }
        let density = match map {
            None => cosine,
            Some(map) => n(0.5) * cosine + n(0.5) * N::pi() * map.density(toward),
        };
        let light = self.background.colour_in(toward).map(|channel| channel / density);
        Some(EmitterPoint { toward, is_far: true, light })
    }

    /// Mirrors show the background itself.
    fn has_highlights(&self) -> bool {
        false
    }
}
