//! A template: rings. Describe it here.

use crate::prelude::*;

// Its name in scenes, its meaning, and how it is made for one object.
inventory::submit! {
    ProceduralShader::new("template", "rings across y, light and dark", |anchor| Box::new(Template(anchor)))
}

/// The anchor is the point of a plane or the centre of a sphere, and the unit of length there.
struct Template(Anchor);

impl Template {
    /// Returns the brightness of the surface at a point.
    #[inline]
    fn brightness(&self, at: DVec3) -> f64 {
        let height = (at - self.0.origin).y / self.0.unit;
        0.6 + 0.4 * (40.0 * height).sin()
    }
}

// Whatever is not defined here, such as `specular`, is that of the material.
impl Shader for Template {
    /// Returns the emission of the surface.
    #[inline]
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        material.ambient * self.brightness(at)
    }

    /// Returns the diffuse reflection coefficients.
    #[inline]
    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        material.diffuse * self.brightness(at)
    }
}
