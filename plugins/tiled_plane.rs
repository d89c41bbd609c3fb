//! A tiled plane: an infinite plane with tiles of two materials.

use super::fplane::{self, DIMENSIONS, XDIR, sides};
use super::plane;
use std::sync::Arc;
use tabray::prelude::*;
use tabray::shapes::rectangle::known_sides;

static ALTMATERIAL: Pparm<Arc<Material>> =
    Pparm::required("altmaterial", "the material of every other tile").not_dumped();

static ORIGIN: Pparm<Option<DVec3>> =
    Pparm::or("origin", "the point from which tiles are counted, in place of the world's origin", None)
        .unit("world coordinates")
        .not_dumped();
static ALTMIRROR: Pparm<bool> = Pparm::or(
    "altmirror",
    "whether every other tile mirrors as `altmaterial` does; otherwise all mirror as `material` does",
    false,
)
.not_dumped();

const TABLE: Table = &[&ALTMATERIAL, &ORIGIN, &ALTMIRROR];

/// The notes' program adds this to the distances along the sides, because a cast to an integer would make the tile at 0
/// twice as wide.
const OFFSET: f64 = 100_000.0;

inventory::submit! {
    Entity::shape("tiled_plane", "an infinite plane, tiled with two materials", &[plane::TABLE, fplane::TABLE, TABLE], |args| {
        let tiles = Tiles {
            sides: known_sides(args.get(&plane::NORMAL), args.get(&XDIR), sides(args)?),
            dimensions: args.get(&DIMENSIONS),
            origin: args.get(&ORIGIN),
            other: args.get(&ALTMATERIAL),
            mirrors: args.get(&ALTMIRROR),
        };
        Ok(Body::shaded(plane::shape(args), tiles).anchored(args.get(&plane::POINT), 1.0))
    })
    .alias(&["tplane"])
    .dumped_as("tplane")
}

struct Tiles {
    sides: [[Known; 3]; 2],
    dimensions: DVec2,
    /// The point from which tiles are counted; `None` for the world's origin, with [`OFFSET`].
    origin: Option<DVec3>,
    other: Arc<Material>,
    /// Whether every other tile has a mirror of its own.
    mirrors: bool,
}

impl Tiles {
    /// Returns the place of a point in units of tiles.
    #[inline(always)]
    fn place<N: Number>(&self, at: [N; 3]) -> [N; 2] {
        let n = N::constant;
        let (at, offset) = match self.origin {
            Some(origin) => (per_axis(|axis| at[axis] - n(origin[axis])), 0.0),
            None => (at, OFFSET),
        };
        let [u, v] = self.along(at);
        [(u + n(offset)) / n(self.dimensions.x), (v + n(offset)) / n(self.dimensions.y)]
    }

    /// Returns the parts of a vector along the sides.
    #[inline(always)]
    fn along<N: Number>(&self, vector: [N; 3]) -> [N; 2] {
        let along = |side: usize| dot(Known::vector(&self.sides[side]), vector);
        [along(0), along(1)]
    }

    /// Returns the middle and the widths of a patch, in units of tiles.
    #[inline(never)]
    fn patch<N: Number>(&self, patch: &PatchOf<N>) -> [[N; 2]; 2] {
        let [width, height] = patch.widths(|side| self.along(side));
        let widths = [width / N::constant(self.dimensions.x), height / N::constant(self.dimensions.y)];
        [self.place(patch.middle), widths]
    }
}

impl Shader for Tiles {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::PATCH
    }

    /// Returns the colour of the tile at a point, or the mean over the patch around it.
    #[inline(always)]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let own = constants(material.reflectivity(of));
        let other = match of {
            Reflectivity::Specular if !self.mirrors => own,
            _ => constants(self.other.reflectivity(of)),
        };
        let patch = at.patch.as_ref().map(|patch| self.patch(patch));
        Some(tiled(other, own, self.place(at.position), patch))
    }

    #[inline(always)]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        let [column, row] = self.place(at.position.to_array());
        DVec2::new(column, row).floor()
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let both = material.brightest_with(&self.other)?;
        Some(Look { specular: if self.mirrors { both.specular } else { material.specular }, ..both })
    }
}
