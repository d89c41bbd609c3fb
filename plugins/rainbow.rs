//! The notes' continuously modulated shading: colours that change with the angle around a point.

use crate::prelude::*;

inventory::submit! {
    ProceduralShader::new("rainbow", "hues around a point, independent of the material", |anchor| Box::new(Rainbow(anchor))).on_plane(1)
}

struct Rainbow(Anchor);

impl Shader for Rainbow {
    fn ambient(&self, _material: &Material, at: DVec3) -> Rgb {
        6.0 * around(&self.0, at)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        brightest(6.0, material)
    }
}

/// Red, green and blue from 0 to 2, each a third of a turn behind the other, twice around: `1 + cos(2 t + k/3)` for
/// a direction of the angle t. Without an angle there is no `acos` to lose digits or to be asked for what is none.
pub fn colour(toward: DVec2) -> Rgb {
    // At the point itself there is no direction; all are alike there.
    let DVec2 { x, y } = (toward / toward.abs().max_element()).try_normalize().unwrap_or(DVec2::ZERO);
    let (cos, sin) = (x * x - y * y, 2.0 * x * y);
    let half_root_3 = 0.5 * 3.0_f64.sqrt();
    Rgb::new(1.0 + cos, 1.0 - 0.5 * cos - half_root_3 * sin, 1.0 - 0.5 * cos + half_root_3 * sin)
}

/// The largest magnitudes of a look with so many times these colours and the rest of a material.
pub fn brightest(times: f64, material: &Material) -> Option<Look> {
    let Material { diffuse, specular, .. } = *material;
    let is_sound = diffuse.min_element() >= 0.0;
    // 2 and more than rounding adds to it.
    is_sound.then_some(Look { ambient: Rgb::splat(2.000001 * times), diffuse, specular })
}

/// The colour at a point of a surface, as seen from an anchor.
pub fn around(anchor: &Anchor, at: DVec3) -> Rgb {
    colour((at - anchor.origin).truncate())
}
