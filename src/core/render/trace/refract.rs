//! How rays continue where a material has an interface.

use super::surface::Surface;
use crate::simd::soa::View;
use crate::world::interface::{Crossing, Interface};
use glam::DVec3;

/// Returns the unit normal that faces a direction.
pub(super) fn facing(normal: DVec3, dir: DVec3) -> DVec3 {
    if normal.dot(dir) > 0.0 { -normal } else { normal }
}

/// Returns how each ray of a packet crosses a surface with an interface.
pub(super) fn crossings(interface: &dyn Interface, dir: View, surface: &Surface) -> Vec<Crossing> {
    let crossing = |lane: usize| {
        let (dir, side) = (dir.get(lane), surface.sides[lane]);
        let cross = |normal| interface.cross(dir, facing(normal, dir), side);
        let crossing = cross(surface.normals.get(lane));
        // Bent normals may lead a ray back to the side from which it comes.
        let Some(unbent) = surface.bent_from(lane) else { return crossing };
        let is_through = |onward: DVec3| onward.dot(unbent) * dir.dot(unbent) > 0.0;
        if crossing.onward.is_none_or(is_through) { crossing } else { cross(unbent) }
    };
    (0..dir.len()).map(crossing).collect()
}
