//! Looks: the trait that a plugin implements for one point of a surface, and what follows from it for many.

use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::{View, ViewMut};
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
    fn even(&self, _material: &Material) -> Option<Look> {
        None
    }

    /// The largest that those three give anywhere, whatever the sign, from which follows how deep mirrors and glass are
    /// looked into; nothing where that is not known, or where a surface that is not even has a diffuse colour below 0.
    /// `None` is never wrong.
    fn brightest(&self, material: &Material) -> Option<Look> {
        self.even(material)
    }

    /// What [`ambient`](Self::ambient) and [`specular`](Self::specular) give at many points; tells whether any of the
    /// second is not 0.
    fn unlit(
        &self,
        cpu: Cpu,
        material: &Material,
        points: View,
        ambients: ViewMut,
        speculars: ViewMut,
    ) -> bool {
        unlit(cpu, self, material, points, ambients, speculars)
    }

    /// What [`diffuse`](Self::diffuse) gives at many points; tells whether any is not 0.
    fn diffuses(&self, cpu: Cpu, material: &Material, points: View, out: ViewMut) -> bool {
        diffuses(cpu, self, material, points, out)
    }
}

/// The shader of an object that has none of its own: the material everywhere.
pub struct Plain;

impl Shader for Plain {
    fn even(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        Some(Look { ambient, diffuse, specular })
    }
}

kernels! {
    /// The reflectivities at points of a surface: for light from nowhere in particular, and as a mirror. Tells whether
    /// any of those is not 0.
    fn unlit[T: Shader](shader: &T, material: &Material, points: View) => ambients, speculars -> bool {
        let (count, mut any) = (points.len(), 0);
        let (mut ambients, mut speculars) = (ambients.first(count), speculars.first(count));
        for lane in 0..count {
            let point = points.get(lane);
            let specular = shader.specular(material, point);
            ambients.set(lane, shader.ambient(material, point));
            speculars.set(lane, specular);
            any |= is_any(specular);
        }
        any != 0
    }

    /// Likewise for light from the scene's lights. Tells whether any is not 0.
    fn diffuses[T: Shader](shader: &T, material: &Material, points: View) => out -> bool {
        let (count, mut any) = (points.len(), 0);
        let mut out = out.first(count);
        for lane in 0..count {
            let diffuse = shader.diffuse(material, points.get(lane));
            out.set(lane, diffuse);
            any |= is_any(diffuse);
        }
        any != 0
    }
}

/// 1 for a colour that is not black, else 0.
#[inline(always)]
pub(crate) fn is_any(colour: Rgb) -> u64 {
    u64::from((colour.x != 0.0) | (colour.y != 0.0) | (colour.z != 0.0))
}
