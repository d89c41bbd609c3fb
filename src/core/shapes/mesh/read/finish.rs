//! Materials of a file, as far as they are shown.

use crate::world::material::Rgb;
use crate::world::texture::Texture;
use glam::{DVec2, DVec3};
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

/// Where a surface is not there.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// The image that gives the opacity of the surface; without an image, the surface is opaque everywhere.
    map: Option<Map>,
    /// How far it must be opaque to be there.
    least: f64,
}

impl Mask {
    /// Makes a mask from an image and the least opacity at which the surface is there; `None` where nothing is cut out.
    pub fn new(map: Option<Map>, least: f64) -> Option<Self> {
        let [width, height] = map.as_ref().map_or([1, 1], |map| map.texture.size());
        let mask = Self { map, least };
        let mut texels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        texels.any(|(column, row)| mask.opacity(column, row) < least).then_some(mask)
    }

    /// Returns the opacity of a texel: its alpha or, in an opaque image, its brightness.
    fn opacity(&self, column: u32, row: u32) -> f64 {
        let Some(Map { texture, .. }) = &self.map else { return 1.0 };
        if texture.has_alpha() {
            texture.alpha(column, row)
        } else {
            texture.numbers(column, row).element_sum() / 3.0
        }
    }

    /// Tells whether a surface is not there. `place` returns where in an image, in texels.
    pub fn cuts_out(&self, place: impl FnOnce(&Map) -> Option<DVec2>) -> bool {
        let blended = |map: &Map| {
            let opacity = |column, row| DVec3::splat(self.opacity(column, row));
            place(map).map(|place| map.texture.blended(place, opacity).x)
        };
        self.map.as_ref().and_then(blended).unwrap_or(1.0) < self.least
    }
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
    /// Where it is cut out.
    pub mask: Option<Mask>,
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
            mask: None,
        }
    }
}

impl Finish {
    /// Returns the images that it shows.
    pub fn maps(&self) -> impl Iterator<Item = &Map> {
        let normals = self.normals.iter().map(|(map, _)| map);
        let masks = self.mask.iter().flat_map(|mask| &mask.map);
        self.colours.iter().chain(&self.emissions).chain(normals).chain(masks)
    }

    /// Passes on all that it shows, as bytes.
    pub fn bytes_of(&self, each: &mut dyn FnMut(&[u8])) {
        let Self { colour, metal, specular, emission, shininess, transparency, .. } = self;
        let colours = [colour, specular, emission].into_iter().flat_map(|colour| colour.to_array());
        let slopes = self.normals.as_ref().map_or(0.0, |(_, slopes)| *slopes);
        let mask = self.mask.as_ref();
        let least = mask.map_or(0.0, |mask| mask.least);
        let numbers = colours.chain([*metal, *shininess, *transparency, slopes, least]);
        numbers.for_each(|number| each(&number.to_le_bytes()));
        let normals = self.normals.as_ref().map(|(map, _)| map);
        let masks = mask.and_then(|mask| mask.map.as_ref());
        for map in [self.colours.as_ref(), self.emissions.as_ref(), normals, masks] {
            each(&[u8::from(map.is_some())]);
            let Some(Map { texture, scale, offset }) = map else { continue };
            let numbers = scale.to_array().into_iter().chain(offset.to_array());
            numbers.for_each(|number| each(&number.to_le_bytes()));
            texture.load().into_iter().for_each(|texels| each(&texels.raw()));
        }
    }

    /// Makes a metal from the fraction of the colour that a metal of this roughness mirrors. A rough metal mirrors
    /// nothing clearly, and is shown as if it scattered the rest.
    pub fn forge(&mut self, metal: f64, roughness: f64) {
        let smoothness = 1.0 - roughness.clamp(0.0, 1.0);
        self.metal = metal.clamp(0.0, 1.0) * smoothness * smoothness;
    }
}
