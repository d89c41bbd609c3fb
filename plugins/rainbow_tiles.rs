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

    #[inline]
    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        let along = DVec2::new(at.position.x, at.position.z);
        let hue = || self.hues.colour::<OF_THE_NOTES>((at.position - self.anchor.origin).truncate());
        match &at.patch {
            Some(patch) => between(hue(), material.ambient, self.grid.odd_part(along, [0, 2], patch)),
            None if self.grid.is_odd(along) => material.ambient,
            None => hue(),
        }
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        let [x, y, _] = at.position;
        let from =
            [x - Interval::constant(self.anchor.origin.x), y - Interval::constant(self.anchor.origin.y)];
        let odd = LookBounds::from(material);
        let even = LookBounds { ambient: self.hues.enclose(from), ..odd };
        Some(self.grid.look(at, [0, 2], even, odd))
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
