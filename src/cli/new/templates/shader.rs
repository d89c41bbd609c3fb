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

// Whatever is not defined here is that of the material. A shader that asks for more than the position, such as the normal
// or u and v, says so in `sees`; one that bends normals defines `bends` and `bend`.
impl Shader for Template {
    /// Returns a reflectivity at a point. `N` is `f64` for pictures; for proofs of colours, it is a number that encloses
    /// all points of a box.
    #[inline]
    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        let (n, own) = (N::constant, constants(material.reflectivity(of)));
        let height = (at.position[1] - n(self.anchor.origin.y)) / n(self.anchor.unit);
        let brightness = n(0.6) + n(0.4) * (n(std::f64::consts::TAU * self.rings) * height).sin();
        Some(match of {
            Reflectivity::Specular => own,
            _ => own.map(|channel| brightness * channel),
        })
    }
}
