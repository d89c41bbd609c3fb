//! Continuous modulation combined with tiles, as the notes suggest for their third shader.

use super::rainbow;
use super::tiles::{Grid, WIDTH};
use tabray::prelude::*;
use tabray::shapes::cosine_palette::CosinePalette;

static BRIGHTNESS: Pparm<f64> = Pparm::or("brightness", "half of the strongest colour", 6.0)
    .must("0 or more", |brightness| *brightness >= 0.0);

const TABLE: Table = &[&WIDTH, &rainbow::FREQUENCY, &rainbow::PHASE, &BRIGHTNESS];

inventory::submit! {
    Entity::shader("rainbow_tiles", "tiles along x and z: the material's colour and hues around a point in turn", &[TABLE], |args| {
        let (grid, hues) = (Grid::new(args), rainbow::palette(args, args.get(&BRIGHTNESS)));
        Ok(match hues.are_of_the_notes() {
            true => ShaderFactory::new(move |anchor| RainbowTiles::<true> { grid, hues, anchor }),
            false => ShaderFactory::new(move |anchor| RainbowTiles::<false> { grid, hues, anchor }),
        })
    })
    .on_plane(2)
}

struct RainbowTiles<const OF_THE_NOTES: bool> {
    grid: Grid,
    hues: CosinePalette,
    anchor: Anchor,
}

impl<const OF_THE_NOTES: bool> Shader for RainbowTiles<OF_THE_NOTES> {
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
        let own = constants(material.reflectivity(of));
        if of != Reflectivity::Ambient {
            return Some(own);
        }
        let from = |axis: usize| at.position[axis] - N::constant(self.anchor.origin[axis]);
        let hue = self.hues.colour::<OF_THE_NOTES, N>([from(0), from(1)]);
        Some(self.grid.colour(at, [0, 2], hue, own))
    }

    #[inline]
    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.grid.tile(DVec2::new(at.position.x, at.position.z))
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        let look = self.hues.brightest(material)?;
        Some(Look { ambient: look.ambient.max(material.ambient.abs()), ..look })
    }
}
