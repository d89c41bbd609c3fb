//! The notes' shading of a sphere: colours that change with the angle around its centre.

use super::rainbow::{self, FREQUENCY, PHASE};
use tabray::prelude::*;
use tabray::shapes::cosine_palette::CosinePalette;

static BRIGHTNESS: Pparm<f64> = Pparm::or("brightness", "half of the strongest colour", 1.0)
    .must("0 or more", |brightness| *brightness >= 0.0);

const TABLE: Table = &[&FREQUENCY, &PHASE, &BRIGHTNESS];

inventory::submit! {
    Entity::shader("angular", "hues around the centre, independent of the material", &[TABLE], |args| {
        let hues = rainbow::palette(args, args.get(&BRIGHTNESS));
        Ok(match hues.are_of_the_notes() {
            true => ShaderFactory::new(move |anchor| Angular::<true> { hues, anchor }),
            false => ShaderFactory::new(move |anchor| Angular::<false> { hues, anchor }),
        })
    })
    .on_sphere(0)
}

struct Angular<const OF_THE_NOTES: bool> {
    hues: CosinePalette,
    anchor: Anchor,
}

impl<const OF_THE_NOTES: bool> Shader for Angular<OF_THE_NOTES> {
    /// Returns the same colours above and below the centre: the notes' test for the lower half, `coord.y < 3.0`, is
    /// always true.
    #[inline(always)]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let from = |axis: usize| at.position[axis] - N::constant(self.anchor.origin[axis]);
        Some(match of {
            Reflectivity::Ambient => self.hues.colour::<OF_THE_NOTES, N>([from(0), -from(1).abs()]),
            _ => constants(material.reflectivity(of)),
        })
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.hues.brightest(material)
    }
}
