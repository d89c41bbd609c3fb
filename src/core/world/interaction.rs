//! Surface interactions: where rays hit a surface.

use crate::geometry::ray::Side;
use crate::simd::soa::ViewMut;
use glam::DVec3;

/// Hit points on one surface, one for each ray of a packet. All arrays are as long as the packet's.
pub struct SurfaceInteraction<'l> {
    /// The hit points, in world coordinates.
    pub points: ViewMut<'l>,
    /// The unit normals with which the hit points are shaded, flipped to face the rays where both sides are lit.
    pub normals: ViewMut<'l>,
    /// The unit normals of the surface itself, flipped likewise; not written unless the shape
    /// [is shaded with others](crate::world::hittable::Hittable::is_smooth).
    pub unbent: ViewMut<'l>,
    /// The side that each ray hits.
    pub sides: &'l mut [Side],
    /// The cosines of the angles between the rays and the unflipped normals, from -1 to 1.
    pub cosines: &'l mut [f64],
    /// The path lengths from the viewer, in world units: on entry to the rays' origins, on return to the hit points.
    pub travelled: &'l mut [f64],
}

/// Returns the side of a surface that a ray along `dir` hits, the cosine of the angle between `dir` and `normal`, and
/// the normal, flipped to face the ray if both sides are lit.
#[inline(always)]
pub(crate) fn turned(dir: DVec3, normal: DVec3, is_two_sided: bool) -> (Side, f64, DVec3) {
    let side = Side::seen_along(dir, normal);
    (side, dir.dot(normal), if is_two_sided & (side == Side::Inside) { -normal } else { normal })
}
