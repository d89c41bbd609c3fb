//! The reflectivities of a part of a solid.

use glam::{DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::interval::Interval;
use tabray_world::body::Body;
use tabray_world::certify::Precise;
use tabray_world::material::{Look, Material, Rgb};
use tabray_world::shader::{self, LookBounds, Shader};
use tabray_world::surface_point::{PointBounds, ShaderInputs, SurfacePoint};

/// The reflectivities of the object that a part comes from.
pub struct PartShader(pub Arc<Body>);

impl Shader for PartShader {
    fn sees(&self) -> ShaderInputs {
        self.0.shader.sees()
    }

    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.0.shader.ambient(material, at)
    }

    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.0.shader.diffuse(material, at)
    }

    fn specular(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        self.0.shader.specular(material, at)
    }

    fn emission(&self, at: &SurfacePoint) -> Rgb {
        self.0.shader.emission(at)
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.0.shader.tile(at)
    }

    fn level(&self, at: &SurfacePoint) -> f64 {
        self.0.shader.level(at)
    }

    fn bends(&self) -> bool {
        self.0.shader.bends()
    }

    fn bend(&self, at: &SurfacePoint) -> DVec3 {
        self.0.shader.bend(at)
    }

    fn covers_in_part(&self) -> bool {
        self.0.shader.covers_in_part()
    }

    fn coverage(&self, at: &SurfacePoint) -> f64 {
        self.0.shader.coverage(at)
    }

    fn enclose_coverage<F: Precise>(&self, at: &PointBounds<F>) -> Interval<F> {
        shader::enclosed_coverage(&*self.0.shader, at)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        shader::enclosed(&*self.0.shader, material, at)
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.shader.uniform(material)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.0.shader.brightest(material)
    }
}
