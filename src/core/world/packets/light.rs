//! Lights, sampled from many shading points at once.

use crate::geometry::aabb::larger;
use crate::simd::cpu::{Cpu, kernels};
use crate::world::certify::Precise;
use crate::world::light::Light;
use crate::world::light_samples::{AnyLit, LightSamples, ShadingPoints};
use crate::world::material::Rgb;
use crate::world::rules::Rules;
use f256::f256;
use glam::DVec3;
use tabray_exact::interval::{Fraction, Interval};

/// A light for packets. Every [`Light`] is one.
pub trait PacketLight: Light + EncloseLight<f64> + EncloseLight<f256> + EncloseLight<Fraction> {
    /// Samples the light from many points, with what [`emissivity`](Light::emissivity) returns for each.
    fn sample(&self, cpu: Cpu, points: &ShadingPoints, samples: LightSamples) -> AnyLit;
}

/// A light that is enclosed in one precision. Every [`Light`] is one.
pub trait EncloseLight<F> {
    /// Calls [`Light::enclose`].
    fn sent(&self, toward: [Interval<F>; 3]) -> Option<[Interval<F>; 3]>;
}

impl<T: Light, F: Precise> EncloseLight<F> for T {
    fn sent(&self, toward: [Interval<F>; 3]) -> Option<[Interval<F>; 3]> {
        self.enclose(toward)
    }
}

impl<T: Light> PacketLight for T {
    fn sample(&self, cpu: Cpu, points: &ShadingPoints, samples: LightSamples) -> AnyLit {
        let LightSamples { toward, emissivity, strengths, t_max, shines } = samples;
        sample(cpu, self, points, strengths, t_max, shines, toward, emissivity)
    }
}

kernels! {
    /// Samples a light from many points.
    fn sample[T: Light](
        light: &T,
        shading: &ShadingPoints,
        strengths: &mut [f64],
        t_max: &mut [f64],
        shines: &mut [u64],
    ) => toward, emissivity -> AnyLit {
        let (count, middle) = (shading.points.len(), light.location());
        let (toward, emissivity) = (toward.first(count), emissivity.first(count));
        let out = LightSamples { toward, emissivity, strengths, t_max, shines };
        let free = |cosine, inverse| Rules::Free.received(cosine, inverse);
        let notes = |cosine, inverse| Rules::Notes.received(cosine, inverse);
        match (shading.rules, shading.lights) {
            (Rules::Notes, None) => sample_each(light, shading, |_| middle, notes, out),
            (Rules::Notes, Some(lights)) => {
                let lights = lights.first(count);
                sample_each(light, shading, |lane| lights.get(lane), notes, out)
            }
            (Rules::Free, lights) => {
                let place = |lane| lights.map_or(middle, |lights| lights.get(lane));
                sample_each(light, shading, place, free, out)
            }
        }
    }
}

/// Samples a light from many points. `place` returns the point of the light that a lane sees, and `received` the factor of
/// the light from the cosine of its angle and the reciprocal of its distance.
#[inline(always)]
fn sample_each<T: Light>(
    light: &T,
    shading: &ShadingPoints,
    place: impl Fn(usize) -> DVec3,
    received: impl Fn(f64, f64) -> f64,
    out: LightSamples,
) -> AnyLit {
    let LightSamples { mut toward, mut emissivity, strengths, t_max, shines } = out;
    let (count, slack, is_uniform) = (shading.points.len(), shading.slack, light.uniform().is_some());
    let (points, normals) = (shading.points.first(count), shading.normals.first(count));
    let (strengths, t_max, shines) = (&mut strengths[..count], &mut t_max[..count], &mut shines[..count]);
    let (mut any_faces, mut any_shines) = (0, 0);
    for lane in 0..count {
        let point = points.get(lane);
        let between = place(lane) - point;
        let distance = between.length();
        let inverse = 1.0 / distance;
        let dir = between * inverse;
        let cosine = dir.dot(normals.get(lane));
        // A light on the surface itself makes the cosine NaN, and counts as behind.
        let faces = u64::from(cosine > 0.0);
        let sent = light.emissivity(point);
        let does_shine = faces & u64::from(sent.is_some());
        let ray_end = distance - slack * (distance + reach(point));
        toward.set(lane, dir);
        if !is_uniform {
            emissivity.set(lane, sent.unwrap_or(Rgb::ZERO));
        }
        strengths[lane] = received(cosine, inverse);
        t_max[lane] = if does_shine != 0 { ray_end } else { 0.0 };
        shines[lane] = does_shine;
        any_faces |= faces;
        any_shines |= does_shine;
    }
    AnyLit { any_faces: any_faces != 0, any_shines: any_shines != 0 }
}

/// Returns the largest magnitude of a point's coordinates, in world units.
#[inline(always)]
fn reach(point: DVec3) -> f64 {
    let reach = point.abs();
    larger(larger(reach.x, reach.y), reach.z)
}
