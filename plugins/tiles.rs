//! The notes' tiled shading: cyan and yellow tiles half a unit wide, along x and z.

use tabray::exact::interval::Wide;
use tabray::prelude::*;

pub static WIDTH: Pparm<f64> = Pparm::or("width", "the width of a tile", 0.5).unit("world units").positive();
static ON: Pparm<Wall> = Pparm::or("on", "the wall along which the tiles lie", Wall::Floor);

const TABLE: Table = &[&WIDTH, &ON];

inventory::submit! {
    Entity::shader("tiles", "tiles along x and z: the material's colour without red and without blue in turn", &[TABLE], |args| {
        let (grid, axes) = (Grid::new(args), args.get(&ON).axes());
        Ok(match args.get(&ON) {
            Wall::Floor => ShaderFactory::new(move |_| Tiles::<true> { grid, axes }),
            _ => ShaderFactory::new(move |_| Tiles::<false> { grid, axes }),
        })
    })
    .on_plane(0)
}

/// The walls along which the notes modulate colours.
#[derive(Clone, Copy)]
pub enum Wall {
    Floor,
    Backwall,
    Sidewall,
}

impl Wall {
    /// Returns the axes along the wall.
    pub fn axes(self) -> [usize; 2] {
        match self {
            Self::Floor => [0, 2],
            Self::Backwall => [0, 1],
            Self::Sidewall => [2, 1],
        }
    }
}

choices! {
    Wall, "wall" {
        Floor => "floor", "along x and z";
        Backwall => "backwall", "along x and y";
        Sidewall => "sidewall", "along z and y";
    }
}

/// Tiles along two axes: x and z, which is quicker, or any.
struct Tiles<const ON_FLOOR: bool> {
    grid: Grid,
    axes: [usize; 2],
}

impl<const ON_FLOOR: bool> Tiles<ON_FLOOR> {
    #[inline(always)]
    fn axes(&self) -> [usize; 2] {
        if ON_FLOOR { [0, 2] } else { self.axes }
    }
}

impl<const ON_FLOOR: bool> Shader for Tiles<ON_FLOOR> {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::PATCH
    }

    #[inline(always)]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let own: [N; 3] = constants(material.reflectivity(of));
        if of != Reflectivity::Ambient {
            return Some(own);
        }
        let ([red, green, blue], none) = (own, N::constant(0.0));
        Some(self.grid.colour(at, self.axes(), [red, green, none], [none, green, blue]))
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        let [column, row] = self.axes().map(|axis| at.position[axis]);
        self.grid.tile(DVec2::new(column, row))
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        material.brightest_times(Rgb::ONE)
    }
}

/// Tiles of one width.
#[derive(Clone, Copy)]
pub struct Grid {
    per_unit: Known,
}

impl Grid {
    /// Makes the tiles of an entity whose table has [`WIDTH`].
    pub fn new(args: &Args) -> Self {
        let (width, n) = (args.get(&WIDTH), Wide::constant);
        Self { per_unit: Known { rounded: 1.0 / width, enclosed: n(1.0) / n(width) } }
    }

    /// Returns the colour of a point, or the mean over the patch around it, given the two axes along which tiles lie and the
    /// colours of even and of odd tiles. The notes add the offset because a cast to an integer makes the tile at 0 twice
    /// as wide; with `floor` instead of the cast, tiles are equally wide at any distance.
    #[inline(always)]
    pub fn colour<N: Number>(&self, at: &Point<N>, [x, y]: [usize; 2], even: [N; 3], odd: [N; 3]) -> [N; 3] {
        let tiles = |along: N| N::known(&self.per_unit) * along;
        let counted = |at: [N; 3]| {
            let offset = N::constant(1000.0);
            [tiles(at[x]) + offset, tiles(at[y]) + offset]
        };
        let patch = at.patch.as_ref().map(|patch| {
            let [width, height] = patch.widths(|side| [side[x], side[y]]);
            [counted(patch.middle), [tiles(width), tiles(height)]]
        });
        tiled(even, odd, counted(at.position), patch)
    }

    /// Returns the tile on which a point lies.
    #[inline]
    pub fn tile(&self, along: DVec2) -> DVec2 {
        let tile = |coordinate: f64| (self.per_unit.rounded * coordinate + 1000.0).floor();
        DVec2::new(tile(along.x), tile(along.y))
    }
}
