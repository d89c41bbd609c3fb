//! An environment: a picture all around the scene.

use std::sync::Arc;
use tabray::prelude::*;
use tabray::world::repeated::{blended, repeated};
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

impl Background for Environment {
    /// Interpolates between the four nearest texels; the left edge continues at the right one.
    fn colour<N: Number>(&self, toward: [N; 3]) -> [N; 3] {
        let ([around, up], [width, height]) = (equirectangular(toward), self.texture.size());
        if width == 0 {
            return constants(Rgb::ZERO);
        }
        let place = [around * N::constant(width.into()), up * N::constant(height.into())];
        let row = |at: f64| at.clamp(0.0, f64::from(height) - 1.0) as u32;
        let texel = |at: DVec2| self.texture.texel(repeated(at.x, width), row(at.y));
        let most = || [N::any(0.0, self.texture.brightest()); 3];
        blended(place, texel).unwrap_or_else(most).map(|channel| N::constant(self.brightness) * channel)
    }

    fn detail(&self) -> Option<[u32; 2]> {
        Some(self.texture.size())
    }

    fn brightest(&self) -> Rgb {
        Rgb::splat(self.brightness * self.texture.brightest())
    }
}
