//! The notes' tiled shading: cyan and yellow tiles half a unit wide, along x and z.

use crate::prelude::*;

inventory::submit! {
    ProceduralShader::new("tiles", "tiles along x and z: the material's colour without red and without blue in turn", |_| Box::new(Tiles)).on_plane(0)
}

struct Tiles;

impl Shader for Tiles {
    #[inline]
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        let Rgb { x: red, y: green, z: blue } = material.ambient;
        if is_odd(at) { Rgb::new(0.0, green, blue) } else { Rgb::new(red, green, 0.0) }
    }

    fn enclose<F: Precise>(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        let own = LookBounds::from(material);
        let without = |channel: usize| {
            let mut look = own;
            look.ambient[channel] = Interval::constant(0.0);
            look
        };
        let (odd, even) = (without(0), without(2));
        Some(match is_certainly_odd(at) {
            Some(true) => odd,
            Some(false) => even,
            None => odd.hull(&even),
        })
    }

    #[inline]
    fn tile(&self, at: DVec3) -> DVec2 {
        tile(at)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        (diffuse.min_element() >= 0.0).then_some(Look { ambient, diffuse, specular })
    }
}

/// Tells whether a point lies on an odd tile. The notes add the offset because a cast to an integer makes the tile at 0
/// twice as wide; with `floor` in place of the cast, tiles are equally wide at any distance.
#[inline]
pub fn is_odd(at: DVec3) -> bool {
    let tile = tile(at);
    (tile.x + tile.y).rem_euclid(2.0) != 0.0
}

/// Returns the tile on which a point lies.
#[inline]
pub fn tile(at: DVec3) -> DVec2 {
    let tile = |coordinate: f64| (2.0 * coordinate + 1000.0).floor();
    DVec2::new(tile(at.x), tile(at.z))
}

/// Tells whether a point lies on an odd tile, where that is certain.
pub fn is_certainly_odd<F: Precise>([x, _, z]: [Interval<F>; 3]) -> Option<bool> {
    let tile =
        |along: Interval<F>| (Interval::constant(2.0) * along + Interval::constant(1000.0)).certain_floor();
    Some((tile(x)? + tile(z)?).rem_euclid(2.0) != 0.0)
}
