//! Materials of a file, as far as they are rendered.

use glam::{DMat2, DVec2, DVec3};
use std::sync::Arc;
use tabray_world::material::Rgb;
use tabray_world::texture::Texture;

/// What an image shows beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// It repeats.
    #[default]
    Repeat,
    /// It repeats, every other time mirrored.
    Mirror,
    /// Its edge goes on.
    Clamp,
}

impl Wrap {
    /// Returns the place within an image of this size, in texels, that shows what a place beyond its edges does.
    fn fold(self, at: f64, size: f64) -> f64 {
        let folded = match self {
            Self::Repeat => return at,
            Self::Mirror => size - (at.rem_euclid(2.0 * size) - size).abs(),
            Self::Clamp => at,
        };
        // Blends at the edge are those of equal texels.
        folded.max(0.5).min(size - 0.5)
    }

    /// Returns the texel that is seen at a column or row beyond the edges of an image of this size.
    pub fn texel(self, at: i64, size: u32) -> u32 {
        let size = i64::from(size.max(1));
        let folded = match self {
            Self::Repeat => at.rem_euclid(size),
            Self::Mirror => {
                let at = at.rem_euclid(2 * size);
                at.min(2 * size - 1 - at)
            }
            Self::Clamp => at.clamp(0, size - 1),
        };
        folded as u32
    }
}

/// An image on a surface, by texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The image.
    pub texture: Arc<Texture>,
    /// The matrix of the texture coordinates.
    pub matrix: DMat2,
    /// The offset that is added then.
    pub offset: DVec2,
    /// What is seen beyond the edges, along u and along v.
    pub wrap: [Wrap; 2],
    /// Whether texels are seen as squares from near by.
    pub is_sharp: bool,
}

impl Map {
    /// Makes an image that repeats, and spans the texture coordinates from 0 to 1.
    pub fn new(texture: Arc<Texture>) -> Self {
        let (matrix, offset) = (DMat2::IDENTITY, DVec2::ZERO);
        Self { texture, matrix, offset, wrap: [Wrap::Repeat; 2], is_sharp: false }
    }

    /// Returns where texture coordinates lie, and an extent along them, both in texels.
    pub fn place(&self, at: DVec2, extent: DVec2) -> [DVec2; 2] {
        let size = DVec2::from(self.texture.size().map(f64::from));
        let place = (self.matrix * at + self.offset) * size;
        let folded = |axis: usize| self.wrap[axis].fold(place[axis], size[axis]);
        let extent = DMat2::from_cols(self.matrix.x_axis.abs(), self.matrix.y_axis.abs()) * extent;
        [DVec2::new(folded(0), folded(1)), extent * size]
    }

    /// Returns a blend of the four texels around a place or, if texels are squares, the texel there.
    pub fn blended(&self, place: DVec2, texel: impl Fn(u32, u32) -> DVec3) -> DVec3 {
        self.texture.blended(if self.is_sharp { place.floor() + 0.5 } else { place }, texel)
    }
}

/// A number from 0 to 1 that an image may change from place to place.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// The number, or the factor of the image's numbers.
    factor: f64,
    /// The image, unless the number is the same everywhere, and the channel that has its numbers.
    map: Option<(Map, usize)>,
    /// The least number.
    least: f64,
}

impl From<f64> for Factor {
    fn from(number: f64) -> Self {
        let number = number.clamp(0.0, 1.0);
        Self { factor: number, map: None, least: number }
    }
}

impl Factor {
    /// Makes a number that is that of a channel of an image, from 0 to 2, times a factor.
    pub fn of_image(factor: f64, map: Map, channel: usize) -> Self {
        let [width, height] = map.texture.size();
        let texels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        let numbers = texels.map(|(column, row)| map.texture.numbers(column, row)[channel]);
        let [low, high] = numbers.fold([1.0_f64, 0.0_f64], |[low, high], of| [low.min(of), high.max(of)]);
        let Self { factor, .. } = factor.into();
        match low < high {
            true => Self { factor, map: Some((map, channel)), least: factor * low },
            false => (factor * high).into(),
        }
    }

    /// Tells whether the number changes from place to place.
    pub fn varies(&self) -> bool {
        self.map.is_some()
    }

    /// Returns the least and the greatest number.
    pub fn range(&self) -> [f64; 2] {
        [self.least, self.factor]
    }

    /// Returns the number at a point. `place` returns its position in an image, in texels.
    pub fn at(&self, place: impl FnOnce(&Map) -> Option<DVec2>) -> f64 {
        let Some((map, channel)) = &self.map else { return self.factor };
        let Some(place) = place(map) else { return self.factor };
        let number = map.blended(place, |column, row| map.texture.numbers(column, row))[*channel];
        (self.factor * number).clamp(self.least, self.factor)
    }
}

/// How opaque a surface is from place to place.
#[derive(Clone, Debug, PartialEq)]
pub struct Opacity {
    /// The image of the opacity. Without an image, it is the same everywhere.
    map: Option<Map>,
    /// The opacity, or the factor of the image's.
    factor: f64,
    /// The minimum opacity outside of holes: with it, all else is opaque. Without it, the surface covers as much of
    /// what is behind it as it is opaque.
    cutoff: Option<f64>,
}

impl Opacity {
    /// Returns the opacity of a surface, or `None` if it is opaque everywhere.
    pub fn new(map: Option<Map>, factor: f64, cutoff: Option<f64>) -> Option<Self> {
        let [width, height] = map.as_ref().map_or([1, 1], |map| map.texture.size());
        let opacity = Self { map, factor: factor.clamp(0.0, 1.0), cutoff };
        let least = cutoff.unwrap_or(1.0);
        let mut texels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        texels.any(|(column, row)| opacity.factor * opacity.texel(column, row) < least).then_some(opacity)
    }

    /// Returns the opacity of a texel: its alpha or, in an opaque image, its brightness.
    fn texel(&self, column: u32, row: u32) -> f64 {
        let Some(Map { texture, .. }) = &self.map else { return 1.0 };
        if texture.has_alpha() {
            texture.alpha(column, row)
        } else {
            texture.numbers(column, row).element_sum() / 3.0
        }
    }

    /// Returns the opacity at a point. `place` returns its position in an image, in texels.
    fn at(&self, place: impl FnOnce(&Map) -> Option<DVec2>) -> f64 {
        let blended = |map: &Map| {
            let opacity = |column, row| DVec3::splat(self.texel(column, row));
            place(map).map(|place| map.blended(place, opacity).x)
        };
        self.factor * self.map.as_ref().and_then(blended).unwrap_or(1.0)
    }

    /// Tells whether any point is in a hole.
    pub fn has_holes(&self) -> bool {
        self.cutoff.is_some() || self.map.is_some() || self.factor == 0.0
    }

    /// Tells whether a point is in a hole, as [`coverage`](Self::coverage) takes it.
    pub fn is_hole(&self, place: impl FnOnce(&Map) -> Option<DVec2>) -> bool {
        let opacity = self.at(place);
        self.cutoff.map_or(opacity <= 0.0, |least| opacity < least)
    }

    /// Tells whether points that are in no hole cover a part of what is behind them.
    pub fn covers_in_part(&self) -> bool {
        self.cutoff.is_none()
    }

    /// Returns the fraction that a point in no hole covers of what is behind it. `place` returns its position in an
    /// image, in texels.
    pub fn coverage(&self, place: impl FnOnce(&Map) -> Option<DVec2>) -> f64 {
        if self.covers_in_part() { self.at(place) } else { 1.0 }
    }

    /// Returns the least and the greatest [`coverage`](Self::coverage).
    pub fn range(&self) -> [f64; 2] {
        match (self.covers_in_part(), &self.map) {
            (false, _) => [1.0; 2],
            (true, None) => [self.factor; 2],
            (true, Some(_)) => [0.0, self.factor],
        }
    }
}

/// How light continues at a surface of a file, as the materials of the scene that are made for it say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Polish {
    /// Glass.
    Glass {
        /// The refractive index inside, relative to outside.
        index: f64,
        /// How rough it is, from 0 to 1.
        roughness: f64,
        /// Whether the roughness changes from place to place.
        varies: bool,
        /// The fractions of light that are left after a path of length `at` through it.
        left: Rgb,
        /// A length, in the units of the file.
        at: f64,
    },
    /// Metal of one colour.
    Metal {
        /// The fraction of the light along the normal that is reflected.
        colour: Rgb,
        /// How rough it is, from 0 to 1.
        roughness: f64,
    },
    /// Metal in the fraction that [`Finish::metal`] says at each point, and matt for the rest.
    Metallic,
    /// A clear coat over a matt body.
    Coat {
        /// The refractive index of the coat.
        index: f64,
        /// How rough it is, from 0 to 1.
        roughness: f64,
    },
}

impl Polish {
    fn numbers(self) -> [f64; 7] {
        match self {
            Self::Glass { index, roughness, left, at, .. } => {
                [1.0, index, roughness, left.x, left.y, left.z, at]
            }
            Self::Metal { colour, roughness } => [2.0, roughness, colour.x, colour.y, colour.z, 0.0, 0.0],
            Self::Coat { index, roughness } => [3.0, index, roughness, 0.0, 0.0, 0.0, 0.0],
            Self::Metallic => [4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }
}

/// A material of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// The colour, or the factor of the image's colours.
    pub colour: Rgb,
    /// The image of the colours.
    pub colours: Option<Map>,
    /// The fraction of the surface that is metal.
    pub metal: Factor,
    /// How rough the metal is, or the glass.
    pub roughness: Factor,
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
    /// The reflectivity for highlights of lamps alone, without mirror images.
    pub highlight: Rgb,
    /// How light continues at the surface; `None` if it is transmitted unbent, and mirrored by `metal` and `specular`.
    pub polish: Option<Polish>,
    /// The fraction of light that passes through.
    pub transparency: f64,
    /// How opaque the surface is, if it is not opaque everywhere.
    pub opacity: Option<Opacity>,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            colour: Rgb::ONE,
            colours: None,
            metal: 0.0.into(),
            roughness: 1.0.into(),
            specular: Rgb::ZERO,
            emission: Rgb::ZERO,
            emissions: None,
            normals: None,
            shininess: 0.0,
            highlight: Rgb::ZERO,
            polish: None,
            transparency: 0.0,
            opacity: None,
        }
    }
}

impl Finish {
    /// Returns the images of the material.
    pub fn maps(&self) -> impl Iterator<Item = &Map> {
        let normals = self.normals.iter().map(|(map, _)| map);
        let opacity = self.opacity.iter().flat_map(|opacity| &opacity.map);
        let numbers = [&self.metal, &self.roughness].into_iter().flat_map(|factor| &factor.map);
        let numbers = numbers.map(|(map, _)| map);
        self.colours.iter().chain(&self.emissions).chain(normals).chain(opacity).chain(numbers)
    }

    /// Calls a function with the contents of the material, as bytes.
    pub fn bytes_of(&self, each: &mut dyn FnMut(&[u8])) {
        let Self { colour, metal, roughness, specular, emission, shininess, highlight, transparency, .. } =
            self;
        let colours =
            [colour, specular, emission, highlight].into_iter().flat_map(|colour| colour.to_array());
        let slopes = self.normals.as_ref().map_or(0.0, |(_, slopes)| *slopes);
        let opacity = self.opacity.as_ref();
        let least = opacity.and_then(|opacity| opacity.cutoff).unwrap_or(0.0);
        let factor = opacity.map_or(1.0, |opacity| opacity.factor);
        let channel = |of: &Factor| of.map.as_ref().map_or(0.0, |(_, channel)| *channel as f64);
        let forged = [metal, roughness].into_iter().flat_map(|of| [of.factor, channel(of)]);
        let numbers = colours.chain(forged).chain([*shininess, *transparency, slopes, least, factor]);
        let polish = self.polish.map_or([0.0; 7], Polish::numbers);
        numbers.chain(polish).for_each(|number| each(&number.to_le_bytes()));
        let normals = self.normals.as_ref().map(|(map, _)| map);
        let opacity = opacity.and_then(|opacity| opacity.map.as_ref());
        let [metal, roughness] = [metal, roughness].map(|of| of.map.as_ref().map(|(map, _)| map));
        for map in [self.colours.as_ref(), self.emissions.as_ref(), normals, opacity, metal, roughness] {
            each(&[u8::from(map.is_some())]);
            let Some(Map { texture, matrix, offset, wrap, is_sharp }) = map else { continue };
            let numbers = matrix.to_cols_array().into_iter().chain(offset.to_array());
            numbers.for_each(|number| each(&number.to_le_bytes()));
            each(&[wrap[0] as u8, wrap[1] as u8, u8::from(*is_sharp)]);
            texture.load().into_iter().for_each(|texels| each(&texels.raw()));
        }
    }

    /// Returns the fraction of the colour that a point reflects as by a mirror, and does not scatter. `place` returns its
    /// position in an image, in texels.
    pub fn mirrored(&self, place: impl Fn(&Map) -> Option<DVec2>) -> f64 {
        self.mirrored_by(self.metal.at(&place), self.roughness.at(&place))
    }

    /// Returns the least and the greatest [mirrored](Self::mirrored) fraction.
    pub fn mirrored_range(&self) -> [f64; 2] {
        let ([little, much], [smooth, rough]) = (self.metal.range(), self.roughness.range());
        [self.mirrored_by(little, rough), self.mirrored_by(much, smooth)]
    }

    /// Returns the mirrored fraction of a metal. A rough one without facets gives no clear mirror images, and the rest of its
    /// light is rendered as scattered.
    fn mirrored_by(&self, metal: f64, roughness: f64) -> f64 {
        let smoothness = 1.0 - roughness;
        match self.polish {
            Some(Polish::Metal { .. }) => 1.0,
            Some(Polish::Metallic) => metal,
            _ => metal * smoothness * smoothness,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beyond_an_edge_repeats_is_mirrored_or_goes_on() {
        for (wrap, columns) in [
            (Wrap::Repeat, [1, 2, 0, 1, 2, 0, 1]),
            (Wrap::Mirror, [1, 0, 0, 1, 2, 2, 1]),
            (Wrap::Clamp, [0, 0, 0, 1, 2, 2, 2]),
        ] {
            for (at, column) in (-2..).zip(columns) {
                assert_eq!(wrap.texel(at, 3), column, "{wrap:?} {at}");
                // In the middle of the texel, or half a texel from the edge.
                let folded = wrap.fold(at as f64 + 0.5, 3.0).rem_euclid(3.0);
                assert_eq!(folded, f64::from(column) + 0.5, "{wrap:?} {at}");
            }
        }
    }
}
