//! Materials of a file, as far as they are rendered.

use glam::{DVec2, DVec3};
use std::sync::Arc;
use tabray_world::material::Rgb;
use tabray_world::texture::Texture;

/// An image on a surface, by texture coordinates. Outside of 0 to 1, the image repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The image.
    pub texture: Arc<Texture>,
    /// The factor of the texture coordinates.
    pub scale: DVec2,
    /// The offset of the scaled texture coordinates.
    pub offset: DVec2,
}

/// A mask that cuts holes into a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// The image with the opacity of the surface. Without an image, the surface is opaque.
    map: Option<Map>,
    /// The minimum opacity outside of holes.
    least: f64,
}

impl Mask {
    /// Makes a mask from an image and the minimum opacity outside of holes, or `None` if there are no holes.
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

    /// Tells whether a point is in a hole. `place` returns its position in an image, in texels.
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
    /// The colour, or the factor of the image's colours.
    pub colour: Rgb,
    /// The image of the colours.
    pub colours: Option<Map>,
    /// The fraction of the colour that is reflected as by a mirror, not scattered.
    pub metal: f64,
    /// The further mirror reflectivity.
    pub specular: Rgb,
    /// The emitted light, or the factor of the image's light.
    pub emission: Rgb,
    /// The image of the emitted light.
    pub emissions: Option<Map>,
    /// The normal map, and the factor of its slopes.
    pub normals: Option<(Map, f64)>,
    /// The exponent of highlights.
    pub shininess: f64,
    /// The fraction of light that passes through.
    pub transparency: f64,
    /// The mask with the holes of the surface.
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
    /// Returns the images of the material.
    pub fn maps(&self) -> impl Iterator<Item = &Map> {
        let normals = self.normals.iter().map(|(map, _)| map);
        let masks = self.mask.iter().flat_map(|mask| &mask.map);
        self.colours.iter().chain(&self.emissions).chain(normals).chain(masks)
    }

    /// Calls a function with the contents of the material, as bytes.
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

    /// Sets the mirrored fraction of the colour for a metal of this roughness. A rough metal gives no clear mirror
    /// images, and the rest of its light is rendered as scattered.
    pub fn forge(&mut self, metal: f64, roughness: f64) {
        let smoothness = 1.0 - roughness.clamp(0.0, 1.0);
        self.metal = metal.clamp(0.0, 1.0) * smoothness * smoothness;
    }
}
