//! The notes' tiled shading: cyan and yellow tiles half a unit wide, along x and z.

use crate::prelude::*;

inventory::submit! {
    ProceduralShader::new("tiles", "tiles along x and z: the material's colour without red and without blue in turn", |_| Box::new(Tiles)).on_plane(0)
}

struct Tiles;

impl Shader for Tiles {
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        let Rgb { x: red, y: green, z: blue } = material.ambient;
        if is_odd(at) { Rgb::new(0.0, green, blue) } else { Rgb::new(red, green, 0.0) }
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        (diffuse.min_element() >= 0.0).then_some(Look { ambient, diffuse, specular })
    }
}

/// Whether a point lies on an odd tile. The notes' offset keeps tiles from meeting twice as wide at 0; `floor`
/// in place of a cast to an integer keeps that so however far away the tile is.
pub fn is_odd(at: DVec3) -> bool {
    let tile = |coordinate: f64| (2.0 * coordinate + 1000.0).floor();
    (tile(at.x) + tile(at.z)).rem_euclid(2.0) != 0.0
}
