//! Colours, and how a surface reflects light.

use crate::world::interface::AnyInterface;
use glam::DVec3;

/// A colour or a reflectivity: red, green and blue. 1 is as bright as an image can show; there is no upper limit.
pub type Rgb = DVec3;

/// How a surface reflects light, per channel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// The reflectivity for ambient light.
    pub ambient: Rgb,
    /// The reflectivity for light from the scene's lights, scattered diffusely.
    pub diffuse: Rgb,
    /// The mirror reflectivity.
    pub specular: Rgb,
    /// The exponent of the specular highlight; 0 for no highlight.
    pub shininess: f64,
    /// The fraction of light that passes through the surface, from 0 to 1.
    pub transparency: f64,
    /// How light continues at the surface; `None` if it is transmitted in a straight line, and reflected as `specular`
    /// says.
    pub interface: Option<AnyInterface>,
}

/// A surface's reflectivities, per channel, where they are the same at every point, or bounds of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The reflectivity for ambient light.
    pub ambient: Rgb,
    /// The reflectivity for light from the scene's lights, scattered diffusely.
    pub diffuse: Rgb,
    /// The mirror reflectivity.
    pub specular: Rgb,
}
