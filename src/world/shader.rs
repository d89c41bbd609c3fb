//! Looks: the trait that a plugin implements for one point of a surface.

use crate::world::material::{Look, Material, Rgb};
use glam::DVec3;

/// How a surface answers light where its material alone does not say.
///
/// The defaults are the notes' `material_getamb`, `material_getdiff` and `material_getspec`.
pub trait Shader: Send + Sync {
    /// The reflectivity for light from nowhere in particular.
    fn ambient(&self, material: &Material, _at: DVec3) -> Rgb {
        material.ambient
    }

    /// The reflectivity for light from the scene's lights, scattered evenly.
    fn diffuse(&self, material: &Material, _at: DVec3) -> Rgb {
        material.diffuse
    }

    /// The reflectivity of the surface as a mirror.
    fn specular(&self, material: &Material, _at: DVec3) -> Rgb {
        material.specular
    }

    /// What those three give at every point, if that is the same: then they are not asked at each. `None` is never wrong.
    fn uniform(&self, _material: &Material) -> Option<Look> {
        None
    }

    /// The largest that those three give anywhere, whatever the sign, from which follows how deep mirrors and glass are
    /// looked into; nothing where that is not known, or where a surface that is not even has a diffuse colour below 0.
    /// `None` is never wrong.
    fn brightest(&self, material: &Material) -> Option<Look> {
        self.uniform(material)
    }
}

/// The shader of an object that has none of its own: the material everywhere.
pub struct Plain;

impl Shader for Plain {
    fn uniform(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        Some(Look { ambient, diffuse, specular })
    }
}
