//! The light that reaches the points of a surface.

use super::number::Enclosing;
use super::panes::{Ends, passed};
use super::scene::{Colour, EnclosedScene, Path};
use super::surface::{HitPoints, is_black};
use tabray_exact::scalar::{cross, dot, per_axis, unit};
use tabray_world::directions::{self, orthonormal_pair};
use tabray_world::geometry::sight::Line;
use tabray_world::packets::light::PacketLight;
use tabray_world::rules::{Falloff, Rules};
use tabray_world::sample::Sample;

/// The greatest exponent for which a highlight is computed by multiplication.
const MAX_POWER: i32 = 1000;

/// The choice of points of lights with a size.
#[derive(Clone, Copy)]
pub enum LightPoints {
    /// The points in the middle.
    Middle,
    /// The points that a sample chooses.
    Of(Sample),
    /// All points, with the mean of their light.
    All,
}

/// Encloses the contribution of the light of this index to the colour of points; `None` where it is open. `dir` is
/// the unit vector along the rays that see the points.
pub(super) fn contribution<N: Enclosing>(
    scene: &EnclosedScene,
    (index, seen): (usize, LightPoints),
    surface: &HitPoints<N>,
    dir: [N; 3],
) -> Option<Colour<N>> {
    let (zero, black) = (N::of(0.0), [N::constant(0.0); 3]);
    let (light, rules) = (&scene.model.lights[index].value, scene.model.camera.value.rules);
    let shininess = scene.model.objects[surface.place.object].material.shininess;
    let has_glint = shininess != 0.0 && !is_black(&surface.specular);
    if is_black(&surface.diffuse) && !has_glint {
        return Some(black);
    }
    let toward = toward(&**light, (index, seen), surface.at)?;
    let distance = dot(toward, toward).sqrt();
    let cosine = dot(toward, surface.normal) / distance;
    // Light from behind the surface may face only the shading normals.
    let above = surface
        .geometric_normal
        .map_or(cosine, |geometric_normal| cosine.min(dot(toward, geometric_normal)))
        .range();
    if above.high <= zero {
        return Some(black);
    }
    let mut sent = N::sent(&**light, surface.at);
    if is_black(&sent) {
        return Some(black);
    }
    if rules == Rules::Free && light.fading.falloff != Falloff::None {
        let factor = light.fading.factor(distance);
        sent = per_axis(|channel| sent[channel] * factor);
    }
    let received = rules.received(cosine, N::constant(1.0) / distance);
    let received = surface.through_coat(scene, received, cosine)?;
    let mut scattered = per_axis(|channel| surface.diffuse[channel] * received);
    if has_glint {
        let half = per_axis(|axis| toward[axis] / distance - dir[axis]);
        let half_cosine = dot(half, surface.normal) / dot(half, half).sqrt();
        if half_cosine.range().high > zero {
            let strength = power(half_cosine, shininess);
            scattered = per_axis(|channel| scattered[channel] + surface.specular[channel] * strength);
        }
    }
    let line = Line { origin: surface.at, dir: toward };
    let path = Path { line, leaves: Some(surface.place), is_inside: surface.is_inside };
    let full = per_axis(|channel| scattered[channel] * sent[channel]);
    let lit = passed(scene, &path, index, Ends::at(N::of(1.0))).lit(scene, &full, above)?;
    Some(lit.map(N::mean_over_light))
}

/// Encloses the vectors from points to a light: to its location, or to the chosen points of the disc around it that
/// faces the points. `None` where the vectors are open.
fn toward<N: Enclosing>(
    light: &(dyn PacketLight + 'static),
    (index, seen): (usize, LightPoints),
    at: [N; 3],
) -> Option<[N; 3]> {
    let n = N::constant;
    let (location, size) = (light.location(), light.size());
    let toward = per_axis(|axis| n(location[axis]) - at[axis]);
    if size == 0.0 {
        return Some(toward);
    }
    let (place, [across, up]) = match seen {
        LightPoints::Middle => return Some(toward),
        LightPoints::Of(sample) => {
            (directions::on_disc(sample.on_light(index)), orthonormal_pair(unit(toward))?)
        }
        LightPoints::All => return Some(on_disc(toward, n(size))),
    };
    let [x, y] = place.map(|coordinate| n(size) * coordinate);
    Some(per_axis(|axis| toward[axis] + (x * across[axis] + y * up[axis])))
}

/// Encloses the vectors to all points of a disc of this radius that faces its viewers. `toward` leads to the disc's
/// middle.
pub fn on_disc<N: Enclosing>(toward: [N; 3], radius: N) -> [N; 3] {
    let magnitude = |axis: &usize| toward[*axis].coarse().middle().abs();
    let farthest = (0..3).min_by(|one, other| magnitude(one).total_cmp(&magnitude(other)));
    let axis = per_axis(|axis| N::constant(if Some(axis) == farthest { 1.0 } else { 0.0 }));
    // A mean over the disc does not depend on how it is turned, so any two perpendicular vectors serve.
    let sight = unit(toward);
    let across = unit(cross(sight, axis));
    let up = cross(sight, across);
    let [x, y] = [0, 1].map(|coordinate| radius * N::on_light(coordinate));
    per_axis(|axis| toward[axis] + (x * across[axis] + y * up[axis]))
}

/// Encloses the power of a cosine above 0; 0 below.
pub(super) fn power<N: Enclosing>(cosine: N, shininess: f64) -> N {
    let n = N::constant;
    let cosine = cosine.max(n(0.0)).min(n(1.0));
    let whole = shininess as i32;
    if f64::from(whole) == shininess && (1..=MAX_POWER).contains(&whole) {
        return cosine.powi(whole);
    }
    let power = cosine.pow(n(shininess));
    if shininess > 0.0 { power.max(n(0.0)).min(n(1.0)) } else { power }
}
