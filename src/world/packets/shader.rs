//! Shaders, evaluated at many points at once.

use crate::numeric::interval::{Fraction, Interval};
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::{View, ViewMut};
use crate::world::certify::Precise;
use crate::world::material::{Material, Rgb};
use crate::world::shader::{LookBounds, Shader};
use f256::f256;

/// A shader for packets. Every [`Shader`] is one.
pub trait PacketShader: Shader + EncloseLook<f64> + EncloseLook<f256> + EncloseLook<Fraction> {
    /// Evaluates [`ambient`](Shader::ambient) and [`specular`](Shader::specular) at many points. Returns whether any
    /// specular reflectivity is not 0.
    fn ambient_and_specular(
        &self,
        cpu: Cpu,
        material: &Material,
        points: View,
        ambients: ViewMut,
        speculars: ViewMut,
    ) -> bool;

    /// Evaluates [`diffuse`](Shader::diffuse) at many points. Returns whether any reflectivity is not 0.
    fn diffuses(&self, cpu: Cpu, material: &Material, points: View, out: ViewMut) -> bool;

    /// Writes the [`tile`](Shader::tile) at each point, as one number.
    fn tiles(&self, cpu: Cpu, points: View, out: &mut [u64]);
}

/// A shader whose looks are enclosed in one precision. Every [`Shader`] is one.
pub trait EncloseLook<F> {
    /// Returns what [`Shader::enclose`] does.
    fn look(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>>;
}

impl<T: Shader, F: Precise> EncloseLook<F> for T {
    fn look(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        self.enclose(material, at)
    }
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

    fn tiles(&self, cpu: Cpu, points: View, out: &mut [u64]) {
        tiles(cpu, self, points, out);
    }
}

kernels! {
    /// Evaluates the ambient and the mirror reflectivities at points of a surface. Returns whether any mirror
    /// reflectivity is not 0.
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

    /// Evaluates the diffuse reflectivities at points of a surface. Returns whether any is not 0.
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

    /// Writes the tiles at points of a surface.
    fn tiles[T: Shader](shader: &T, points: View, out: &mut [u64]) {
        let points = points.first(out.len());
        for lane in 0..out.len() {
            let tile = shader.tile(points.get(lane));
            // So that minus zero is zero.
            let [column, row] = [(tile.x + 0.0).to_bits(), (tile.y + 0.0).to_bits()];
            out[lane] = column.rotate_left(17) ^ row.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
    }
}

/// Returns 1 for a colour that is not black, and 0 for black.
#[inline(always)]
pub(crate) fn is_any(colour: Rgb) -> u64 {
    u64::from((colour.x != 0.0) | (colour.y != 0.0) | (colour.z != 0.0))
}
