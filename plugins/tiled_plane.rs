//! A tiled plane: an infinite plane with tiles of two materials.

use super::fplane::{self, DIMENSIONS, XDIR, sides};
use super::plane;
use std::sync::Arc;
use tabray::prelude::*;
use tabray::shapes::rectangle::along_sides;

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
            sides: sides(args)?,
            given: [args.get(&plane::NORMAL), args.get(&XDIR)],
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
    sides: [DVec3; 2],
    /// The normal and `xdir`, of any length.
    given: [DVec3; 2],
    dimensions: DVec2,
    /// The point from which tiles are counted; `None` for the world's origin, with [`OFFSET`].
    origin: Option<DVec3>,
    other: Arc<Material>,
    /// Whether every other tile has a mirror of its own.
    mirrors: bool,
}

impl Tiles {
    #[inline(always)]
    fn tile_at(&self, at: DVec3) -> DVec2 {
        let (at, offset) = self.origin.map_or((at, OFFSET), |origin| (at - origin, 0.0));
        let tile = |side: usize| ((self.sides[side].dot(at) + offset) / self.dimensions[side]).floor();
        DVec2::new(tile(0), tile(1))
    }

    /// Returns the part of a patch around a point that is odd.
    #[inline(never)]
    fn odd_part(&self, at: DVec3, patch: &Patch) -> f64 {
        let (from, offset) = self.origin.map_or((at, OFFSET), |origin| (at - origin, 0.0));
        let middle = DVec2::from(self.sides.map(|side| side.dot(from) + offset)) / self.dimensions;
        odd_part(middle, DVec2::from(self.sides.map(|side| patch.extent(side))) / self.dimensions)
    }

    /// Returns the colour of the tile at a point, or the mean over the patch around it.
    #[inline(always)]
    fn colour(&self, own: Rgb, other: Rgb, at: &SurfacePoint) -> Rgb {
        if let Some(patch) = &at.patch {
            return between(other, own, self.odd_part(at.position, patch));
        }
        if is_odd(self.tile_at(at.position)) { own } else { other }
    }

    /// Returns the mirror reflectivity of every other tile.
    #[inline(always)]
    fn other_specular(&self, material: &Material) -> Rgb {
        if self.mirrors { self.other.specular } else { material.specular }
    }
}

impl Shader for Tiles {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::PATCH
    }

    #[inline(always)]
    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colour(material.ambient, self.other.ambient, at)
    }

    #[inline(always)]
    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colour(material.diffuse, self.other.diffuse, at)
    }

    #[inline(always)]
    fn specular(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colour(material.specular, self.other_specular(material), at)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let ([normal, xdir], n) = (self.given, Interval::<F>::constant);
        let along = |vector| {
            let [u, v] = along_sides(constants(normal), constants(xdir), vector);
            [u / n(self.dimensions.x), v / n(self.dimensions.y)]
        };
        let tiles = |at: [Interval<F>; 3]| match self.origin {
            Some(origin) => along(per_axis(|axis| at[axis] - n(origin[axis]))),
            None => {
                let [u, v] = along_sides(constants(normal), constants(xdir), at);
                [(u + n(OFFSET)) / n(self.dimensions.x), (v + n(OFFSET)) / n(self.dimensions.y)]
            }
        };
        let other = Material { specular: self.other_specular(material), ..(*self.other).clone() };
        let (own, other) = (LookBounds::from(material), LookBounds::from(&other));
        Some(match (tiles(at.position).map(Interval::certain_floor), &at.patch) {
            ([Some(i), Some(j)], _) if !is_odd(DVec2::new(i, j)) => other,
            ([Some(_), Some(_)], _) => own,
            (_, Some(patch)) => other.mean(&own, odd_part_bounds(tiles(patch.middle), patch.widths(along))),
            _ => own.hull(&other),
        })
    }

    #[inline(always)]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.tile_at(at.position)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let both = material.brightest_with(&self.other)?;
        Some(Look { specular: if self.mirrors { both.specular } else { material.specular }, ..both })
    }
}
