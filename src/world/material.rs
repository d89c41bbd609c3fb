//! Colours, and how a surface answers light.

use glam::DVec3;

/// A colour or a reflectivity: red, green and blue; 1 is as bright as a picture can show.
pub type Rgb = DVec3;

/// How a surface answers light, per channel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// The part of light from nowhere in particular that it reflects.
    pub ambient: Rgb,
    /// The part of light from the scene's lights that it scatters evenly.
    pub diffuse: Rgb,
    /// The part of light that it reflects as a mirror does.
    pub specular: Rgb,
    /// The sharpness of the glint that a light leaves on it; 0 for none.
    pub shininess: f64,
    /// The part of light that passes through it, from 0 to 1.
    pub transparency: f64,
}

/// How a surface answers light, per channel, where that is the same all over it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The reflectivity for light from nowhere in particular.
    pub ambient: Rgb,
    /// The reflectivity for light from the scene's lights, scattered evenly.
    pub diffuse: Rgb,
    /// The reflectivity as a mirror.
    pub specular: Rgb,
}
