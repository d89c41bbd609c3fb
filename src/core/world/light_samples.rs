//! A light as seen from the shading points of a surface (the notes' `light_t::illuminate`, without shadows).
//!
//! All arrays are as long as those of the packet whose rays hit the points.

use crate::simd::soa::{View, ViewMut};
use crate::world::rules::Rules;

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
    /// The factors of the light, from the angles at which it arrives and by the notes' rules the distances: see
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
