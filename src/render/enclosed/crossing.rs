//! How rays continue at interfaces.

use super::number::Enclosing;
use super::scene::Colour;
use super::surface::HitPoints;
use tabray_exact::scalar::{constants, dot, per_axis};
use tabray_world::interface::Law;

/// How rays continue at an interface.
pub(super) struct Crossings<N> {
    /// The fraction of the light that is reflected.
    pub reflected: Colour<N>,
    /// The unit directions of the transmitted rest; `None` if it is absorbed.
    pub onward: Option<[N; 3]>,
}

/// Encloses how rays that hit points along unit vectors continue; `None` where that is open.
pub(super) fn crossings<N: Enclosing>(law: Law, surface: &HitPoints<N>, dir: [N; 3]) -> Option<Crossings<N>> {
    let (n, one) = (N::constant, N::constant(1.0));
    let cosine = -dot(dir, surface.normal);
    // Bent normals may face away from the rays; the tracer then turns them.
    if surface.geometric_normal.is_some() && cosine.range().low <= N::of(0.0) {
        return None;
    }
    let cosine = cosine.max(n(0.0)).min(one);
    match law {
        Law::Schlick(colour) => {
            let grazing = (one - cosine).powi(5);
            let colour: Colour<N> = constants(colour);
            let reflected = per_axis(|channel| colour[channel] + (one - colour[channel]) * grazing);
            Some(Crossings { reflected, onward: None })
        }
        Law::Fresnel(1.0) => Some(Crossings { reflected: [n(0.0); 3], onward: Some(dir) }),
        Law::Fresnel(index) => {
            let (from, to) = if surface.is_inside { (n(index), one) } else { (one, n(index)) };
            let ratio = from / to;
            let below = one - ratio * ratio * ((one - cosine) * (one + cosine));
            if below.range().high <= N::of(0.0) {
                return Some(Crossings { reflected: [one; 3], onward: None });
            }
            if below.range().low <= N::of(0.0) {
                return None;
            }
            let root = below.sqrt();
            let across = (from * cosine - to * root) / (from * cosine + to * root);
            let along = (to * cosine - from * root) / (to * cosine + from * root);
            let reflected = n(0.5) * (across.powi(2) + along.powi(2));
            let bend = ratio * cosine - root;
            let onward = per_axis(|axis| ratio * dir[axis] + bend * surface.normal[axis]);
            // Bent normals may lead a ray back to the side from which it comes. Then the surface's own normals replace
            // them.
            if let Some(geometric_normal) = surface.geometric_normal {
                let through = dot(onward, geometric_normal).range();
                if through.low >= N::of(0.0) {
                    return crossings(
                        law,
                        &HitPoints { normal: geometric_normal, geometric_normal: None, ..*surface },
                        dir,
                    );
                }
                if through.high >= N::of(0.0) {
                    return None;
                }
            }
            Some(Crossings { reflected: [reflected; 3], onward: Some(onward) })
        }
        Law::Unknown => None,
    }
}
