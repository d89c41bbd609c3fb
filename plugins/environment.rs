//! An environment: a picture all around the scene.

use std::f64::consts::PI;
use std::sync::Arc;
use tabray::prelude::*;

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
    /// Interpolates between the four nearest texels; the left edge follows on the right one.
    fn colour(&self, toward: DVec3) -> Rgb {
        let [width, height] = self.texture.size();
        if width == 0 {
            return Rgb::ZERO;
        }
        let around = 0.5 + libm::atan2(toward.x, -toward.z) / (2.0 * PI);
        let up = 0.5 + libm::asin(toward.y.clamp(-1.0, 1.0)) / PI;
        let (x, y) = (around * f64::from(width) - 0.5, up * f64::from(height) - 0.5);
        let row = |row: f64| row.clamp(0.0, f64::from(height - 1)) as u32;
        let column = |column: f64| column.rem_euclid(f64::from(width)) as u32;
        let (left, lower) = (x.floor(), y.floor());
        let along = |row| {
            let [one, other] = [left, left + 1.0].map(|at| self.texture.texel(column(at), row));
            one.lerp(other, x - left)
        };
        self.brightness * along(row(lower)).lerp(along(row(lower + 1.0)), y - lower)
    }

    fn detail(&self) -> Option<[u32; 2]> {
        Some(self.texture.size())
    }

    fn brightest(&self) -> Rgb {
        Rgb::splat(self.brightness * self.texture.brightest())
    }
}
