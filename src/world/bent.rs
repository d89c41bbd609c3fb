//! Shaders that bend normals, and leave the colours to another shader.

use crate::body::AnyShader;
use crate::certify::Precise;
use crate::luminous::Luminous;
use crate::material::{Look, Material, Rgb};
use crate::shader::{EnclosedShader, Shader};
use crate::surface_point::{PointBounds, ShaderInputs, SurfacePoint};
use glam::{DVec2, DVec3};
use tabray_exact::interval::Interval;

/// How normals are bent.
pub trait Bend: Send + Sync {
    /// The properties of a point that it sees besides the normal.
    const SEES: ShaderInputs;

    /// Returns the outward unit normal with which a point is shaded instead of this one.
    fn bent(&self, at: &SurfacePoint, normal: DVec3) -> DVec3;

    /// Encloses the unit normals that [`bent`](Self::bent) returns instead of these, before any rounding, at every
    /// point of a box; `None` where the bent normals are not known. `None` is always correct.
    fn enclose<F: Precise>(
        &self,
        _at: &PointBounds<F>,
        _normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        None
    }
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

    fn bend(&self, at: &SurfacePoint) -> DVec3 {
        self.bend.bent(at, self.colours.bend(at))
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

    fn coverage(&self, at: &SurfacePoint) -> f64 {
        self.colours.coverage(at)
    }

    fn enclose_bend<F: Precise>(
        &self,
        at: &PointBounds<F>,
        normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        self.bend.enclose(at, normal)
    }

    fn colours(&self) -> Option<&(dyn EnclosedShader + 'static)> {
        Some(&*self.colours)
    }

    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colours.ambient(material, at)
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colours.diffuse(material, at)
    }

    fn specular(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.colours.specular(material, at)
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
