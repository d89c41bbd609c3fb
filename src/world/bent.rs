//! Shaders that bend normals, and leave the colours to another shader.

use crate::body::AnyShader;
use crate::luminous::Luminous;
use crate::material::{Look, Material, Reflectivity, Rgb};
use crate::number::Number;
use crate::shader::Shader;
use crate::surface_point::{Point, ShaderInputs, SurfacePoint};
use glam::DVec2;

/// How normals are bent.
pub trait Bend: Send + Sync {
    /// The properties of a point that it sees besides the normal.
    const SEES: ShaderInputs;

    /// Returns the outward unit normal with which a point is shaded instead of this one; `None` where it is open, which it
    /// is not in plain numbers.
    fn bent<N: Number>(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]>;
}

/// A shader that bends the normals of another shader.
pub struct Bent<B> {
    /// How normals are bent.
    pub bend: B,
    /// The shader that gives the colours.
    pub colours: AnyShader,
}

impl<B: Bend> Shader for Bent<B> {
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::NORMAL.and(B::SEES).and(self.colours.sees())
    }

    fn bends(&self) -> bool {
        true
    }

    fn bend<N: Number>(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]> {
        self.bend.bent(at, N::looks(&*self.colours).leans(at, normal)?)
    }

    fn cuts_out(&self) -> bool {
        self.colours.cuts_out()
    }

    fn is_cut_out(&self, at: &SurfacePoint) -> bool {
        self.colours.is_cut_out(at)
    }

    fn covers_in_part(&self) -> bool {
        self.colours.covers_in_part()
    }

    fn coverage<N: Number>(&self, at: &Point<N>) -> N {
        N::looks(&*self.colours).covers(at)
    }

    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        N::looks(&*self.colours).reflects(of, material, at)
    }

    fn emission(&self, at: &SurfacePoint) -> Rgb {
        self.colours.emission(at)
    }

    fn glowing(&self) -> Vec<(Luminous, Rgb)> {
        self.colours.glowing()
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.colours.uniform(material)
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.colours.tile(at)
    }

    fn level(&self, at: &SurfacePoint) -> f64 {
        self.colours.level(at)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.colours.brightest(material)
    }
}
