//! Shaders, evaluated at many points at once.

pub use crate::shader::{PacketShader, SurfacePoints};

use crate::material::{Material, Reflectivity, Rgb};
use crate::shader::Shader;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::ViewMut;
use crate::surface_point::{Point, SurfacePoint};

impl<T: Shader> PacketShader for T {
    fn ambient_and_specular(
        &self,
        cpu: Cpu,
        material: &Material,
        points: SurfacePoints,
        mut ambients: ViewMut,
        mut speculars: ViewMut,
    ) -> bool {
        let mut any = false;
        let is_copy = self.in_object_space(cpu, points, &mut |shader, own, part| {
            let (ambients, speculars) = (ambients.part(part.clone()), speculars.part(part));
            any |= shader.ambient_and_specular(cpu, material, own, ambients, speculars);
        });
        if is_copy { any } else { ambient_and_specular(cpu, self, material, points, ambients, speculars) }
    }

    fn diffuses(&self, cpu: Cpu, material: &Material, points: SurfacePoints, mut out: ViewMut) -> bool {
        let mut any = false;
        let is_copy = self.in_object_space(cpu, points, &mut |shader, own, part| {
            any |= shader.diffuses(cpu, material, own, out.part(part));
        });
        if is_copy { any } else { diffuses(cpu, self, material, points, out) }
    }

    fn tiles(&self, cpu: Cpu, points: SurfacePoints, out: &mut [u64]) {
        let is_copy = self.in_object_space(cpu, points, &mut |shader, own, part| {
            shader.tiles(cpu, own, &mut out[part]);
        });
        if !is_copy {
            tiles(cpu, self, points, out);
        }
    }
}

/// Runs a statement for each point. Where a shader sees positions alone, the loop is over positions.
macro_rules! each {
    ($points:expr, $lane:ident, $at:ident, $body:block) => {
        let count = $points.positions.len();
        if $points.seen.is_empty() {
            let positions = $points.positions.first(count);
            for $lane in 0..count {
                let $at = &SurfacePoint::at(positions.get($lane));
                $body
            }
        } else {
            for ($lane, $at) in $points.seen[..count].iter().enumerate() $body
        }
    };
}

kernels! {
    /// Evaluates the ambient and the mirror reflectivities at points of a surface. Returns whether any mirror
    /// reflectivity is not 0.
    fn ambient_and_specular[T: Shader](
        shader: &T, material: &Material, points: SurfacePoints
    ) => ambients, speculars -> bool {
        let (count, mut any) = (points.positions.len(), 0);
        let (mut ambients, mut speculars) = (ambients.first(count), speculars.first(count));
        // One loop for both is compiled without vector instructions where a shader chooses among colours.
        each!(points, lane, at, {
            ambients.set(lane, colour(shader, Reflectivity::Ambient, material, at));
        });
        each!(points, lane, at, {
            let specular = colour(shader, Reflectivity::Specular, material, at);
            speculars.set(lane, specular);
            any |= is_any(specular);
        });
        any != 0
    }

    /// Evaluates the diffuse reflectivities at points of a surface. Returns whether any is not 0.
    fn diffuses[T: Shader](shader: &T, material: &Material, points: SurfacePoints) => out -> bool {
        let (count, mut any) = (points.positions.len(), 0);
        let mut out = out.first(count);
        each!(points, lane, at, {
            let diffuse = colour(shader, Reflectivity::Diffuse, material, at);
            out.set(lane, diffuse);
            any |= is_any(diffuse);
        });
        any != 0
    }

    /// Writes the tiles at points of a surface.
    fn tiles[T: Shader](shader: &T, points: SurfacePoints, out: &mut [u64]) {
        let points = SurfacePoints { positions: points.positions.first(out.len()), ..points };
        each!(points, lane, at, {
            let tile = shader.tile(at);
            // Adding 0 turns minus zero, whose bits differ, into zero.
            let [column, row] = [(tile.x + 0.0).to_bits(), (tile.y + 0.0).to_bits()];
            out[lane] = column.rotate_left(17) ^ row.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        });
    }
}

#[inline(always)]
fn colour<T: Shader>(shader: &T, of: Reflectivity, material: &Material, at: &SurfacePoint) -> Rgb {
    shader.reflectivity(of, material, &Point::<f64>::of(at)).map_or(Rgb::ZERO, Rgb::from)
}

/// Returns 1 for a colour that is not black, and 0 for black.
#[inline(always)]
pub fn is_any(colour: Rgb) -> u64 {
    u64::from((colour.x != 0.0) | (colour.y != 0.0) | (colour.z != 0.0))
}
