//! Continuous modulation combined with tiles, as the notes suggest for their third shader.

use super::{rainbow, tiles};
use crate::prelude::*;

inventory::submit! {
    ProceduralShader::new("rainbow_tiles", "tiles along x and z: the material's colour and hues around a point in turn", |anchor| Box::new(RainbowTiles(anchor))).on_plane(2)
}

struct RainbowTiles(Anchor);

impl Shader for RainbowTiles {
    #[inline]
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        if tiles::is_odd(at) { material.ambient } else { 6.0 * rainbow::around(&self.0, at) }
    }

    fn enclose<F: Precise>(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        let odd = LookBounds::from(material);
        let even = LookBounds { ambient: rainbow::enclosed_around(&self.0, at), ..odd };
        Some(match tiles::is_certainly_odd(at) {
            Some(true) => odd,
            Some(false) => even,
            None => odd.hull(&even),
        })
    }

    #[inline]
    fn tile(&self, at: DVec3) -> DVec2 {
        tiles::tile(at)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let look = rainbow::brightest(6.0, material)?;
        Some(Look { ambient: look.ambient.max(material.ambient.abs()), ..look })
    }
}
