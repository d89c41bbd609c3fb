//! What surfaces answer to light at many points at once.

use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::{View, ViewMut};
use crate::world::material::{Material, Rgb};
use crate::world::shader::Shader;

/// A look for packets: every [`Shader`] is one.
pub trait PacketShader: Shader {
    /// What [`ambient`](Shader::ambient) and [`specular`](Shader::specular) give at many points; tells whether any of
    /// the second is not 0.
    fn ambient_and_specular(
        &self,
        cpu: Cpu,
        material: &Material,
        points: View,
        ambients: ViewMut,
        speculars: ViewMut,
    ) -> bool;

    /// What [`diffuse`](Shader::diffuse) gives at many points; tells whether any is not 0.
    fn diffuses(&self, cpu: Cpu, material: &Material, points: View, out: ViewMut) -> bool;
}

impl<T: Shader> PacketShader for T {
    fn ambient_and_specular(
        &self,
        cpu: Cpu,
        material: &Material,
        points: View,
        ambients: ViewMut,
        speculars: ViewMut,
    ) -> bool {
        ambient_and_specular(cpu, self, material, points, ambients, speculars)
    }

    fn diffuses(&self, cpu: Cpu, material: &Material, points: View, out: ViewMut) -> bool {
        diffuses(cpu, self, material, points, out)
    }
}

kernels! {
    /// The reflectivities at points of a surface: for light from nowhere in particular, and as a mirror. Tells whether
    /// any of those is not 0.
    fn ambient_and_specular[T: Shader](shader: &T, material: &Material, points: View) => ambients, speculars -> bool {
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
