//! The colours of copies.

use super::Placed;
use crate::world::material::{Look, Material, Rgb};
use crate::world::shader::Shader;
use glam::DVec3;

/// The reflectivities of an object at its own points.
pub(super) struct PlacedShader(pub Placed);

impl Shader for PlacedShader {
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.body.shader.ambient(material, self.0.own_point(at))
    }

    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.body.shader.diffuse(material, self.0.own_point(at))
    }

    fn specular(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.body.shader.specular(material, self.0.own_point(at))
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.body.shader.uniform(material)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.0.body.shader.brightest(material)
    }
}
