//! A light as the places of a surface see it (the notes' `light_t::illuminate`, but for shadows).
//!
//! All arrays are as long as the packet's whose rays came to the places.

use crate::simd::soa::{View, ViewMut};

/// Places of a surface that may see a light.
pub struct ShadingPoints<'p> {
    /// Where they are, in world coordinates.
    pub points: View<'p>,
    /// The unit normals there.
    pub normals: View<'p>,
    /// Where each sees the light; nothing where that is the light's own place.
    pub lights: Option<View<'p>>,
    /// What the ends of the ways are short of the light, as a part of how far that is, and of how far the places are from
    /// the world's origin.
    pub slack: f64,
}

/// What a light sends to places, and how it comes there.
pub struct LightSamples<'f> {
    /// The directions to it, unit vectors.
    pub toward: ViewMut<'f>,
    /// The colours that it sends, black where it sends nothing; of a light that is even they are left as they are.
    pub emissivity: ViewMut<'f>,
    /// The cosines of the angles between those directions and the normals, divided by the distances to it in world
    /// units.
    pub cos_over_distance: &'f mut [f64],
    /// Where the ways to it end, in world units from the places; 0 where none need be gone.
    pub t_max: &'f mut [f64],
    /// 0 for a place to which it sends nothing, or from behind; else 1.
    pub shines: &'f mut [u64],
}

/// What is so of any of some places.
pub struct Lit {
    /// One faces the light.
    pub any_faces: bool,
    /// To one that does the light sends something, too.
    pub any_shines: bool,
}
