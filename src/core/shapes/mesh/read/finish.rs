//! Materials of a file, as far as they are shown.

use crate::world::material::Rgb;
use crate::world::texture::Texture;
use glam::DVec2;
use std::sync::Arc;

/// An image on a surface, by its texture coordinates. Beyond 0 and 1, it repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The image.
    pub texture: Arc<Texture>,
    /// What texture coordinates are multiplied by.
    pub scale: DVec2,
    /// What is added to them then.
    pub offset: DVec2,
}

/// A material of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// The colour, or the factor of that of the image.
    pub colour: Rgb,
    /// The image of its colours.
    pub colours: Option<Map>,
    /// The part of the colour that is mirrored, not scattered.
    pub metal: f64,
    /// What is mirrored beside that.
    pub specular: Rgb,
    /// The light that it emits, or the factor of that of the image.
    pub emission: Rgb,
    /// The image of the light that it emits.
    pub emissions: Option<Map>,
    /// The normal map, and the factor of its slopes.
    pub normals: Option<(Map, f64)>,
    /// The exponent of highlights.
    pub shininess: f64,
    /// The fraction of light that passes through.
    pub transparency: f64,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            colour: Rgb::ONE,
            colours: None,
            metal: 0.0,
            specular: Rgb::ZERO,
            emission: Rgb::ZERO,
            emissions: None,
            normals: None,
            shininess: 0.0,
            transparency: 0.0,
        }
    }
}

impl Finish {
    /// Returns the images that it shows.
    pub fn maps(&self) -> impl Iterator<Item = &Map> {
        let normals = self.normals.iter().map(|(map, _)| map);
        self.colours.iter().chain(&self.emissions).chain(normals)
    }

    /// Passes on all that it shows, as bytes.
    pub fn bytes_of(&self, each: &mut dyn FnMut(&[u8])) {
        let Self { colour, metal, specular, emission, shininess, transparency, .. } = self;
        let colours = [colour, specular, emission].into_iter().flat_map(|colour| colour.to_array());
        let slopes = self.normals.as_ref().map_or(0.0, |(_, slopes)| *slopes);
        let numbers = colours.chain([*metal, *shininess, *transparency, slopes]);
        numbers.for_each(|number| each(&number.to_le_bytes()));
        for map in [self.colours.as_ref(), self.emissions.as_ref(), self.normals.as_ref().map(|(map, _)| map)]
        {
            each(&[u8::from(map.is_some())]);
            let Some(Map { texture, scale, offset }) = map else { continue };
            let numbers = scale.to_array().into_iter().chain(offset.to_array());
            numbers.for_each(|number| each(&number.to_le_bytes()));
            texture.load().into_iter().for_each(|texels| each(&texels.raw()));
        }
    }

    /// Makes a metal of the part of the colour that a metal so rough mirrors. A rough one mirrors nothing clearly, and is shown
    /// as if it scattered the rest.
    pub fn forge(&mut self, metal: f64, roughness: f64) {
        let smoothness = 1.0 - roughness.clamp(0.0, 1.0);
        self.metal = metal.clamp(0.0, 1.0) * smoothness * smoothness;
    }
}
