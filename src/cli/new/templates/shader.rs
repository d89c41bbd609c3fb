//! A template: rings. Say here what it looks like.

use crate::prelude::*;

// What scenes call it, what it is, and how it is made for one object.
inventory::submit! {
    ProceduralShader::new("template", "rings across y, light and dark", |anchor| Box::new(Template(anchor)))
}

/// The anchor is the point of a plane or the centre of a sphere, and the length that counts as 1 there.
struct Template(Anchor);

impl Template {
    /// How bright the surface is at a point.
    fn brightness(&self, at: DVec3) -> f64 {
        let height = (at - self.0.origin).y / self.0.unit;
        0.6 + 0.4 * (40.0 * height).sin()
    }
}

// What is left out here, such as `specular`, is the material's.
impl Shader for Template {
    /// What the surface sends by itself.
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        material.ambient * self.brightness(at)
    }

    /// How much of the lights' light it scatters.
    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        material.diffuse * self.brightness(at)
    }
}
