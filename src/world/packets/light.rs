//! Lights, sampled from many shading points at once (the notes' `light_t::illuminate`, without shadows).
//!
//! All arrays are as long as those of the packet whose rays hit the points.

use crate::geometry::aabb::larger;
use crate::light::Light;
use crate::material::Rgb;
use crate::number::Number;
use crate::packets::shader::is_any;
use crate::rules::Rules;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::{View, ViewMut};
use glam::DVec3;
use tabray_exact::affine::Affine;
use tabray_exact::interval::{Interval, Wide};

/// Points of a surface that may see a light.
pub struct ShadingPoints<'p> {
    /// The points, in world coordinates.
    pub points: View<'p>,
    /// The unit normals at the points.
    pub normals: View<'p>,
    /// The point of the light that each point sees, in world coordinates; `None` for the light's own position.
    pub lights: Option<View<'p>>,
    /// The rules of light.
    pub rules: Rules,
    /// The distance before the light at which the shadow rays end, as a fraction of the sum of the distance to the
    /// light and of the largest magnitude of the point's coordinates.
    pub slack: f64,
}

/// The light that a light source sends to shading points, and its directions.
pub struct LightSamples<'f> {
    /// The unit vectors toward the light.
    pub toward: ViewMut<'f>,
    /// The colours that the light sends, black where it sends nothing. Left untouched for a uniform light.
    pub emissivity: ViewMut<'f>,
    /// The factors of the light, from the angles at which it arrives and under the notes' rules the distances: see
    /// [`Rules::received`].
    pub strengths: &'f mut [f64],
    /// The ends of the shadow rays, in world units from the points; 0 where no shadow ray is needed.
    pub t_max: &'f mut [f64],
    /// 0 for a point that the light does not shine on or lies behind; otherwise 1.
    pub shines: &'f mut [u64],
}

/// Whether any of several shading points is lit.
pub struct AnyLit {
    /// Whether any point faces the light.
    pub any_faces: bool,
    /// Whether the light shines on any of the points that face it.
    pub any_shines: bool,
}

/// A light for packets. Every [`Light`] is one.
pub trait PacketLight: Light + Sends<f64> + Sends<Interval> + Sends<Affine> + Sends<Wide> {
    /// Samples the light from many points, with what is [`sent`](Light::sent) to each.
    fn sample(&self, cpu: Cpu, points: &ShadingPoints, samples: LightSamples) -> AnyLit;
}

/// A light of any type, asked in one number. Every [`Light`] is one.
pub trait Sends<N> {
    /// Calls [`Light::sent`].
    fn sends(&self, toward: [N; 3]) -> [N; 3];
}

impl<T: Light, N: Number> Sends<N> for T {
    fn sends(&self, toward: [N; 3]) -> [N; 3] {
        self.sent(toward)
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
        // Each is a loop of its own: one that asks in every lane is not vectorized.
        match shading.lights {
            None => sample_each(light, shading, |_| middle, out),
            Some(lights) => {
                let lights = lights.first(count);
                sample_each(light, shading, |lane| lights.get(lane), out)
            }
        }
    }
}

/// Samples a light from many points. `place` returns the point of the light that a lane sees.
#[inline(always)]
fn sample_each<T: Light>(
    light: &T,
    shading: &ShadingPoints,
    place: impl Fn(usize) -> DVec3,
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
        let sent = Rgb::from(light.sent(point.to_array()));
        let does_shine = faces & is_any(sent);
        let ray_end = distance - slack * (distance + reach(point));
        toward.set(lane, dir);
        if !is_uniform {
            emissivity.set(lane, sent);
        }
        strengths[lane] = shading.rules.received(cosine, inverse);
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
