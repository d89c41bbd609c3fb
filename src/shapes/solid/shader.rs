//! The look of a part of a solid.

use crate::numeric::interval::Interval;
use crate::numeric::interval::{Fine, Fraction};
use crate::world::body::Body;
use crate::world::certify::Precise;
use crate::world::material::{Look, Material, Rgb};
use crate::world::packets::shader::EncloseLook;
use crate::world::shader::{LookBounds, Shader};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// The reflectivities of the object that is a part.
pub struct PartShader(pub Arc<Body>);

impl Shader for PartShader {
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.shader.ambient(material, at)
    }

    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.shader.diffuse(material, at)
    }

    fn specular(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.shader.specular(material, at)
    }

    fn tile(&self, at: DVec3) -> DVec2 {
        self.0.shader.tile(at)
    }

    fn enclose<F: Precise>(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        let look = EncloseLook::<Fraction>::look(&*self.0.shader, material, at.map(F::widen))?;
        let narrow = |colour: [Fine; 3]| colour.map(F::narrow);
        let LookBounds { ambient, diffuse, specular } = look;
        Some(LookBounds { ambient: narrow(ambient), diffuse: narrow(diffuse), specular: narrow(specular) })
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.shader.uniform(material)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.0.shader.brightest(material)
    }
}
