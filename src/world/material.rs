//! Colours, and how a surface reflects light.

use crate::interface::{AnyInterface, Coat, Medium};
use glam::DVec3;
use tabray_exact::interval::Interval;

/// A colour or a reflectivity: red, green and blue. 1 is as bright as an image can show; there is no upper limit.
pub type Rgb = DVec3;

/// How a surface reflects light, per channel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// The reflectivity for ambient light.
    pub ambient: Rgb,
    /// The radiance that the surface gives by itself, in all directions. It is seen, and where the camera lets light
    /// bounce, it lights other surfaces.
    pub emission: Rgb,
    /// The reflectivity for light from the scene's lights, scattered diffusely.
    pub diffuse: Rgb,
    /// The mirror reflectivity.
    pub specular: Rgb,
    /// The reflectivity for highlights of lamps alone, without mirror images.
    pub highlight: Rgb,
    /// The exponent of the specular highlight; 0 for no highlight. Highlights of a transparent material with an
    /// interface are as strong as the light itself; the strength of others is `specular` and `highlight` times the light.
    pub shininess: f64,
    /// The fraction of light that passes through the surface, from 0 to 1.
    pub transparency: f64,
    /// How light continues at the surface; `None` if it is transmitted in a straight line, and reflected as `specular`
    /// says.
    pub interface: Option<AnyInterface>,
}

/// One of the three reflectivities of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reflectivity {
    /// That for ambient light.
    Ambient,
    /// That for light from the scene's lights, scattered diffusely.
    Diffuse,
    /// That of the mirror.
    Specular,
}

impl Reflectivity {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Ambient, Self::Diffuse, Self::Specular];
}

impl Material {
    /// Returns a reflectivity.
    #[inline(always)]
    pub fn reflectivity(&self, of: Reflectivity) -> Rgb {
        let Self { ambient, diffuse, specular, .. } = *self;
        Look { ambient, diffuse, specular }.reflectivity(of)
    }

    /// Returns bounds of the looks between those of two materials; `None` where their diffuse light may be negative.
    pub fn brightest_with(&self, other: &Self) -> Option<Look> {
        let is_sound = self.diffuse.min(other.diffuse).min_element() >= 0.0;
        is_sound.then(|| Look {
            ambient: self.ambient.abs().max(other.ambient.abs()),
            diffuse: self.diffuse.max(other.diffuse),
            specular: self.specular.abs().max(other.specular.abs()),
        })
    }

    /// Returns bounds of the looks whose ambient and diffuse colours are the material's times a factor of at most `most`;
    /// `None` where the diffuse light may be negative.
    pub fn brightest_times(&self, most: Rgb) -> Option<Look> {
        let Self { ambient, diffuse, specular, .. } = *self;
        let is_sound = diffuse.min_element() >= 0.0;
        is_sound.then(|| Look { ambient: ambient * most, diffuse: diffuse * most, specular })
    }

    /// Tells whether lamps show as highlights in the surface, in addition to the light that it scatters. In glass they
    /// do, whatever it transmits.
    pub fn glints(&self) -> bool {
        self.interface.is_some() && self.transparency != 0.0 && self.shininess != 0.0
    }

    /// Returns the medium that absorbs light behind the surface, if there is one.
    pub fn medium(&self) -> Option<Medium> {
        self.interface.as_ref().and_then(|interface| interface.medium())
    }

    /// Returns the coat over the surface, if it has one.
    pub fn coat(&self) -> Option<&dyn Coat<f64>> {
        self.interface.as_ref().and_then(|interface| interface.coat()).map(|(plain, _)| plain)
    }

    /// Returns the coat over the surface for proofs, if it has one.
    pub fn enclosed_coat(&self) -> Option<&dyn Coat<Interval>> {
        self.interface.as_ref().and_then(|interface| interface.coat()).map(|(_, enclosed)| enclosed)
    }

    /// Returns the diffuse reflectivity of a body of this colour under the surface's coat.
    pub fn under_coat(&self, colour: Rgb) -> Rgb {
        self.coat().map_or(colour, |coat| coat.covers(colour.to_array()).into())
    }

    /// Returns a look with the diffuse reflectivity under the surface's coat.
    pub fn coated(&self, look: Look) -> Look {
        Look { diffuse: self.under_coat(look.diffuse), ..look }
    }

    /// Returns how rough the surface is for the rays that continue from it, from 0 to 1.
    pub fn roughness(&self) -> f64 {
        self.interface.as_ref().map_or(0.0, |interface| interface.roughness())
    }
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

impl Look {
    /// Returns one of them.
    #[inline(always)]
    pub fn reflectivity(&self, of: Reflectivity) -> Rgb {
        match of {
            Reflectivity::Ambient => self.ambient,
            Reflectivity::Diffuse => self.diffuse,
            Reflectivity::Specular => self.specular,
        }
    }
}
