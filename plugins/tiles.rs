//! The notes' tiled shading: cyan and yellow tiles half a unit wide, along x and z.

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
    #[inline]
    fn along(&self, at: DVec3) -> DVec2 {
        if ON_FLOOR { DVec2::new(at.x, at.z) } else { DVec2::from(self.axes.map(|axis| at[axis])) }
    }
}

impl<const ON_FLOOR: bool> Shader for Tiles<ON_FLOOR> {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::PATCH
    }

    #[inline]
    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        let Rgb { x: red, y: green, z: blue } = material.ambient;
        let (odd, even) = (Rgb::new(0.0, green, blue), Rgb::new(red, green, 0.0));
        let along = self.along(at.position);
        if let Some(patch) = &at.patch {
            return between(even, odd, self.grid.odd_part(along, self.axes, patch));
        }
        if self.grid.is_odd(along) { odd } else { even }
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let own = LookBounds::from(material);
        let without = |channel: usize| {
            let mut look = own;
            look.ambient[channel] = Interval::constant(0.0);
            look
        };
        let (odd, even) = (without(0), without(2));
        Some(self.grid.look(at, self.axes, even, odd))
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.grid.tile(self.along(at.position))
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        (diffuse.min_element() >= 0.0).then_some(Look { ambient, diffuse, specular })
    }
}

/// Tiles of one width.
#[derive(Clone, Copy)]
pub struct Grid {
    width: f64,
    per_unit: f64,
}

impl Grid {
    /// Makes the tiles of an entity whose table has [`WIDTH`].
    pub fn new(args: &Args) -> Self {
        let width = args.get(&WIDTH);
        Self { width, per_unit: 1.0 / width }
    }

    /// Tells whether a point lies on an odd tile. The notes add the offset because a cast to an integer makes the tile
    /// at 0 twice as wide; with `floor` instead of the cast, tiles are equally wide at any distance.
    #[inline]
    pub fn is_odd(&self, along: DVec2) -> bool {
        is_odd(self.tile(along))
    }

    /// Returns the part of a patch around a point that is odd, given the two axes along which tiles lie.
    pub fn odd_part(&self, along: DVec2, axes: [usize; 2], patch: &Patch) -> f64 {
        let widths = DVec2::from(axes.map(|axis| patch.extent(DVec3::AXES[axis])));
        odd_part(self.per_unit * along + 1000.0, self.per_unit * widths)
    }

    /// Returns the tile on which a point lies.
    #[inline]
    pub fn tile(&self, along: DVec2) -> DVec2 {
        let tile = |coordinate: f64| (self.per_unit * coordinate + 1000.0).floor();
        DVec2::new(tile(along.x), tile(along.y))
    }

    /// Encloses the look of points, given the looks of even and of odd tiles and the two axes along which tiles lie.
    pub fn look<F: Precise>(
        &self,
        at: &PointBounds<F>,
        axes: [usize; 2],
        even: LookBounds<F>,
        odd: LookBounds<F>,
    ) -> LookBounds<F> {
        let n = Interval::<F>::constant;
        // Of a width that is a power of two, the reciprocal is exact.
        let is_exact = self.width.to_bits() << 12 == 0 && self.per_unit.is_normal();
        let tiles = |along| if is_exact { n(self.per_unit) * along } else { along / n(self.width) };
        let along = |vector: [Interval<F>; 3]| axes.map(|axis| tiles(vector[axis]));
        let counted = |vector| along(vector).map(|tile| tile + n(1000.0));
        match (counted(at.position).map(Interval::certain_floor), &at.patch) {
            ([Some(one), Some(other)], _) if is_odd(DVec2::new(one, other)) => odd,
            ([Some(_), Some(_)], _) => even,
            (_, Some(patch)) => even.mean(&odd, odd_part_bounds(counted(patch.middle), patch.widths(along))),
            _ => odd.hull(&even),
        }
    }
}
