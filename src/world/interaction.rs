//! Where rays come to a surface.

use crate::geometry::ray::Side;
use crate::simd::soa::ViewMut;
use glam::DVec3;

/// Places on a surface, each where a ray of a packet comes to it. All arrays are as long as the packet's.
pub struct SurfaceInteraction<'l> {
    /// Where they are, in world coordinates.
    pub points: ViewMut<'l>,
    /// The unit normals there, turned to the rays' side where both are lit.
    pub normals: ViewMut<'l>,
    /// The side that each ray comes to.
    pub sides: &'l mut [Side],
    /// The cosines of the angles between the rays and the normals, of either sign.
    pub cosines: &'l mut [f64],
    /// How far the way from the viewer is, in world units: to where the rays start at first, and then to the places.
    pub travelled: &'l mut [f64],
}

/// The side that a ray along `dir` comes to of a surface with this normal, the cosine of the angle between them, and the
/// normal, turned to that side if both are lit.
#[inline(always)]
pub(crate) fn turned(dir: DVec3, normal: DVec3, is_two_sided: bool) -> (Side, f64, DVec3) {
    let side = Side::seen_along(dir, normal);
    (side, dir.dot(normal), if is_two_sided & (side == Side::Inside) { -normal } else { normal })
}
