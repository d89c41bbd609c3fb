//! Copies as objects, and their colours.

use super::shape::{ByPlacement, Placed};
use crate::geometry::placement::Placement;
use crate::numeric::interval::{Fine, Fraction, Interval};
use crate::world::body::Body;
use crate::world::certify::Precise;
use crate::world::material::{Look, Material, Rgb};
use crate::world::packets::shader::EncloseLook;
use crate::world::shader::{LookBounds, Plain, Shader};
use crate::world::shape::{ByPackets, Shape};
use glam::{DVec2, DVec3};
use std::sync::Arc;

impl Placed {
    /// Makes a copy of an object with this material.
    pub fn body(body: &Arc<Body>, placement: Placement, material: &Material) -> Body {
        let shape = Shape::new(Self::new(body, placement)).by::<ByPackets, ByPlacement>();
        let is_plain = body.shader.uniform(material) == Plain.uniform(material);
        let shaded = |shape| Body::shaded(shape, PlacedShader(Self::new(body, placement)));
        let copy = if is_plain { Body::plain(shape) } else { shaded(shape) };
        Body { depth: body.depth + 1, ..copy }
    }
}

/// The reflectivities of an object at its own points.
struct PlacedShader(Placed);

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

    fn tile(&self, at: DVec3) -> DVec2 {
        self.0.body.shader.tile(self.0.own_point(at))
    }

    fn enclose<F: Precise>(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        let own = self.0.placement.point(at).map(F::widen);
        let look = EncloseLook::<Fraction>::look(&*self.0.body.shader, material, own)?;
        let narrow = |colour: [Fine; 3]| colour.map(F::narrow);
        let LookBounds { ambient, diffuse, specular } = look;
        Some(LookBounds { ambient: narrow(ambient), diffuse: narrow(diffuse), specular: narrow(specular) })
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.body.shader.uniform(material)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.0.body.shader.brightest(material)
    }
}
