//! The reflectivities of a part of a solid.

use glam::DVec2;
use std::sync::Arc;
use tabray_world::body::Body;
use tabray_world::material::{Look, Material, Reflectivity, Rgb};
use tabray_world::number::Number;
use tabray_world::shader::Shader;
use tabray_world::surface_point::{Point, ShaderInputs, SurfacePoint};

/// The reflectivities of the object that a part comes from.
pub struct PartShader(pub Arc<Body>);

impl Shader for PartShader {
    fn sees(&self) -> ShaderInputs {
        self.0.shader.sees()
    }

    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        N::looks(&*self.0.shader).reflects(of, material, at)
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

    fn bend<N: Number>(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]> {
        N::looks(&*self.0.shader).leans(at, normal)
    }

    fn covers_in_part(&self) -> bool {
        self.0.shader.covers_in_part()
    }

    fn coverage<N: Number>(&self, at: &Point<N>) -> N {
        N::looks(&*self.0.shader).covers(at)
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.shader.uniform(material)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.0.shader.brightest(material)
    }
}
