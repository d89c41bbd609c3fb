//! An environment: a picture all around the scene.

use std::f64::consts::PI;
use std::sync::Arc;
use tabray::prelude::*;
use tabray::world::sky_map::equirectangular;

static TEXTURE: Pparm<Arc<Texture>> = Pparm::required(
    "texture",
    "the equirectangular texture, whose middle lies toward -z and whose upper edge is straight up (y)",
);
static BRIGHTNESS: Pparm<f64> = Pparm::or("brightness", "the factor of the texture's colours", 1.0)
    .must("0 or more", |factor| *factor >= 0.0);

const TABLE: Table = &[&TEXTURE, &BRIGHTNESS];

inventory::submit! {
    Entity::background("environment", "a texture all around, where there is no object", &[TABLE], |args| {
        Ok(Box::new(Environment { texture: args.get(&TEXTURE), brightness: args.get(&BRIGHTNESS) }))
    })
    .known_as(&["envmap", "hdri", "skybox"])
}

struct Environment {
    texture: Arc<Texture>,
    brightness: f64,
}

impl Environment {
    /// Returns the texel of a column and a row; the left edge continues at the right one.
    fn texel(&self, at: DVec2) -> Rgb {
        let [width, height] = self.texture.size().map(f64::from);
        self.texture.texel(at.x.rem_euclid(width) as u32, at.y.clamp(0.0, height - 1.0) as u32)
    }
}

impl Background for Environment {
    /// Interpolates between the four nearest texels.
    fn colour(&self, toward: DVec3) -> Rgb {
        let [width, height] = self.texture.size();
        if width == 0 {
            return Rgb::ZERO;
        }
        let around = 0.5 + libm::atan2(toward.x, -toward.z) / (2.0 * PI);
        let up = 0.5 + libm::asin(toward.y.clamp(-1.0, 1.0)) / PI;
        let (x, y) = (around * f64::from(width) - 0.5, up * f64::from(height) - 0.5);
        let (left, lower) = (x.floor(), y.floor());
        let along = |row| {
            let [one, other] = [left, left + 1.0].map(|column| self.texel(DVec2::new(column, row)));
            one.lerp(other, x - left)
        };
        self.brightness * along(lower).lerp(along(lower + 1.0), y - lower)
    }

    fn enclose(&self, toward: [Interval; 3]) -> [Interval; 3] {
        let ([around, up], size) = (equirectangular(toward), self.texture.size());
        let place = [around * Interval::constant(size[0].into()), up * Interval::constant(size[1].into())];
        let most = Interval { low: 0.0, high: self.texture.brightest() };
        let any = || self.texture.enclose_blended(place, |at| self.texel(at)).unwrap_or([most; 3]);
        let colour = if size[0] == 0 { [Interval::constant(0.0); 3] } else { any() };
        colour.map(|channel| Interval::constant(self.brightness) * channel)
    }

    fn detail(&self) -> Option<[u32; 2]> {
        Some(self.texture.size())
    }

    fn brightest(&self) -> Rgb {
        Rgb::splat(self.brightness * self.texture.brightest())
    }
}
