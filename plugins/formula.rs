//! Colours by formulas: in the point x, y, z, in u and v, in the normal nx, ny, nz, and in the curvature.

use tabray::prelude::*;

type Formulas = [SurfaceField; 3];

static AMBIENT: Pparm<Option<Formulas>> =
    Pparm::or("ambient", "the reflectivity for ambient light, in place of the material's", None);
static DIFFUSE: Pparm<Option<Formulas>> =
    Pparm::or("diffuse", "the diffuse reflectivity, in place of the material's", None);
static SPECULAR: Pparm<Option<Formulas>> =
    Pparm::or("specular", "the mirror reflectivity, in place of the material's", None);

const TABLE: Table = &[&AMBIENT, &DIFFUSE, &SPECULAR];

inventory::submit! {
    Entity::shader("formula", "colours by formulas", &[TABLE], |args| {
        let look = ByFormula {
            ambient: args.get(&AMBIENT),
            diffuse: args.get(&DIFFUSE),
            specular: args.get(&SPECULAR),
        };
        Ok(ShaderFactory::new(move |_| look.clone()))
    })
}

/// The greatest reflectivity. One below 0, or of no value, counts as 0.
const MAX_REFLECTIVITY: f64 = 1e6;

/// The formulas of the three reflectivities; `None` for the material's.
#[derive(Clone)]
struct ByFormula {
    ambient: Option<Formulas>,
    diffuse: Option<Formulas>,
    specular: Option<Formulas>,
}

impl ByFormula {
    fn all(&self) -> impl Iterator<Item = &SurfaceField> {
        [&self.ambient, &self.diffuse, &self.specular].into_iter().flatten().flatten()
    }
}

impl Shader for ByFormula {
    fn sees(&self) -> ShaderInputs {
        self.all().map(ShaderInputs::of).fold(ShaderInputs::POSITION, ShaderInputs::and)
    }

    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let formulas = match of {
            Reflectivity::Ambient => &self.ambient,
            Reflectivity::Diffuse => &self.diffuse,
            Reflectivity::Specular => &self.specular,
        };
        let Some([red, green, blue]) = formulas else { return Some(constants(material.reflectivity(of))) };
        let (least, most) = (N::constant(0.0), N::constant(MAX_REFLECTIVITY));
        let channel = |formula: &SurfaceField| Some(least.max(at.value(formula)?).min(most));
        Some([channel(red)?, channel(green)?, channel(blue)?])
    }

    /// The formulas over all of space bound the colours.
    fn brightest(&self, material: &Material) -> Option<Look> {
        let most = |formula: &SurfaceField| {
            let bound = surface_formula::range(formula).high;
            if bound < MAX_REFLECTIVITY { bound.max(0.0) } else { MAX_REFLECTIVITY }
        };
        let colour = |formulas: &Option<Formulas>, own: Rgb| match formulas {
            Some(formulas) => Rgb::from(formulas.each_ref().map(most)),
            None => own,
        };
        let is_sound = self.diffuse.is_some() || material.diffuse.min_element() >= 0.0;
        is_sound.then(|| Look {
            ambient: colour(&self.ambient, material.ambient),
            diffuse: colour(&self.diffuse, material.diffuse),
            specular: colour(&self.specular, material.specular),
        })
    }
}
