//! A template: rings. Describe it here.

use tabray::prelude::*;

static RINGS: Pparm<f64> =
    Pparm::or("rings", "how many rings there are in the unit of length", 6.0).positive();

const TABLE: Table = &[&RINGS as &dyn Row];

// Its name in scenes, its meaning, its table, and how it is made: once for a scene, and then for each object. The anchor
// is the point of a plane, the centre of a sphere or the middle of another object, and the unit of length there.
inventory::submit! {
    Entity::shader("template", "rings across y, light and dark", &[TABLE], |args| {
        let rings = args.get(&RINGS);
        Ok(ShaderFactory::new(move |anchor| Template { rings, anchor }))
    })
}

struct Template {
    rings: f64,
    anchor: Anchor,
}

impl Template {
    /// Returns the brightness of the surface at a point.
    #[inline]
    fn brightness(&self, at: &SurfacePoint) -> f64 {
        let height = (at.position - self.anchor.origin).y / self.anchor.unit;
        0.6 + 0.4 * libm::sin(std::f64::consts::TAU * self.rings * height)
    }
}

// Whatever is not defined here, such as `specular`, is that of the material. A shader that asks for more than the
// position, such as the normal or u and v, says so in `sees`; one that bends normals defines `bends` and `bend`.
impl Shader for Template {
    /// Returns the emission of the surface.
    #[inline]
    fn ambient(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.ambient * self.brightness(at)
    }

    /// Returns the diffuse reflection coefficients.
    #[inline]
    fn diffuse(&self, material: &Material, at: &SurfacePoint) -> Rgb {
        material.diffuse * self.brightness(at)
    }
}
