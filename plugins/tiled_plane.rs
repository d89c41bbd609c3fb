//! A tiled plane: an infinite plane with tiles of two materials.

use super::fplane::{self, DIMENSIONS, XDIR, sides};
use super::plane;
use std::sync::Arc;
use tabray::prelude::*;
use tabray::shapes::rectangle::along_sides;

static ALTMATERIAL: Pparm<Arc<Material>> =
    Pparm::required("altmaterial", "the material of every other tile").not_dumped();

const TABLE: Table = &[&ALTMATERIAL];

inventory::submit! {
    Entity::shape("tiled_plane", "an infinite plane, tiled with two materials", &[plane::TABLE, fplane::TABLE, TABLE], |args| {
        let tiles = Tiles {
            sides: sides(args)?,
            given: [args.get(&plane::NORMAL), args.get(&XDIR)],
            dimensions: args.get(&DIMENSIONS),
            other: args.get(&ALTMATERIAL),
        };
        Ok(Body::shaded(plane::shape(args), tiles).anchored(args.get(&plane::POINT), 1.0))
    })
    .alias(&["tplane"])
    .dumped_as("tplane")
}

struct Tiles {
    sides: [DVec3; 2],
    /// The normal and `xdir`, of any length.
    given: [DVec3; 2],
    dimensions: DVec2,
    other: Arc<Material>,
}

impl Tiles {
    #[inline]
    fn tile_at(&self, at: DVec3) -> DVec2 {
        let tile = |side: usize| ((self.sides[side].dot(at) + 100_000.0) / self.dimensions[side]).floor();
        DVec2::new(tile(0), tile(1))
    }

    /// Returns the material of the tile at a point. Tiles are counted from the world's origin, not from the plane's
    /// point. The notes add the offset because a cast to an integer would make the tile at 0 twice as wide.
    #[inline]
    fn material<'m>(&'m self, own: &'m Material, at: DVec3) -> &'m Material {
        let tile = self.tile_at(at);
        if (tile.x + tile.y).rem_euclid(2.0) == 0.0 { &self.other } else { own }
    }
}

impl Shader for Tiles {
    #[inline]
    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.material(material, at.position).ambient
    }

    #[inline]
    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.material(material, at.position).diffuse
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let [normal, xdir] = self.given;
        let [u, v] = along_sides(constants(normal), constants(xdir), at.position);
        let tile = |along: Interval<F>, side: usize| {
            let offset = Interval::constant(100_000.0);
            ((along + offset) / Interval::constant(self.dimensions[side])).certain_floor()
        };
        let other = Material { specular: material.specular, ..(*self.other).clone() };
        let (own, other) = (LookBounds::from(material), LookBounds::from(&other));
        Some(match (tile(u, 0), tile(v, 1)) {
            (Some(i), Some(j)) if (i + j).rem_euclid(2.0) == 0.0 => other,
            (Some(_), Some(_)) => own,
            _ => own.hull(&other),
        })
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.tile_at(at.position)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let [one, other] = [material, &*self.other];
        let is_sound = one.diffuse.min(other.diffuse).min_element() >= 0.0;
        is_sound.then(|| Look {
            ambient: one.ambient.abs().max(other.ambient.abs()),
            diffuse: one.diffuse.max(other.diffuse),
            specular: one.specular,
        })
    }
}
