//! Shaders: the trait that a plugin implements for one point of a surface.

use crate::numeric::interval::{Float, Interval};
use crate::numeric::scalar::{Scalar, per_axis};
use crate::world::certify::Precise;
use crate::world::material::{Look, Material, Rgb};
use glam::{DVec2, DVec3};

/// The reflectivities of a surface, which may differ from point to point.
///
/// The defaults are the material's, as in the notes' `material_getamb`, `material_getdiff` and `material_getspec`.
pub trait Shader: Send + Sync {
    /// Returns the reflectivity for ambient light at a point, in world coordinates.
    #[inline]
    fn ambient(&self, material: &Material, _at: DVec3) -> Rgb {
        material.ambient
    }

    /// Returns the diffuse reflectivity for light from the scene's lights at a point, in world coordinates.
    #[inline]
    fn diffuse(&self, material: &Material, _at: DVec3) -> Rgb {
        material.diffuse
    }

    /// Returns the mirror reflectivity at a point, in world coordinates.
    #[inline]
    fn specular(&self, material: &Material, _at: DVec3) -> Rgb {
        material.specular
    }

    /// Returns the three reflectivities, if each is the same at every point. Then the methods above are not called for
    /// each point. `None` is always correct.
    fn uniform(&self, _material: &Material) -> Option<Look> {
        None
    }

    /// Encloses the three reflectivities, as mathematics has them, at every point of a box; `None` where they are not
    /// known. Proofs of colours ask for them. `None` is always correct.
    fn enclose<F: Precise>(&self, material: &Material, _at: [Interval<F>; 3]) -> Option<LookBounds<F>>
    where
        Self: Sized,
    {
        self.uniform(material).map(LookBounds::from)
    }

    /// Returns the tile or the texel at a point, as two whole numbers that differ from those of its neighbours. Between
    /// points in different ones, an image may need more samples than their colours tell. Two zeros everywhere are
    /// correct.
    #[inline]
    fn tile(&self, _at: DVec3) -> DVec2 {
        DVec2::ZERO
    }

    /// Returns the largest magnitudes of the three reflectivities over all points, with either sign. They decide how
    /// deep rays are followed into mirrors and glass. Returns `None` where they are not known, or where a surface that
    /// is not uniform has a negative diffuse channel somewhere. `None` is always correct.
    fn brightest(&self, material: &Material) -> Option<Look> {
        self.uniform(material)
    }
}

/// Enclosures of a surface's reflectivities, per channel.
#[derive(Clone, Copy, Debug)]
pub struct LookBounds<F> {
    /// The reflectivity for ambient light.
    pub ambient: [Interval<F>; 3],
    /// The reflectivity for light from the scene's lights, scattered diffusely.
    pub diffuse: [Interval<F>; 3],
    /// The mirror reflectivity.
    pub specular: [Interval<F>; 3],
}

/// Takes the numbers for exact.
impl<F: Float> From<Look> for LookBounds<F> {
    fn from(Look { ambient, diffuse, specular }: Look) -> Self {
        let exactly = |colour: Rgb| per_axis(|channel| Interval::constant(colour[channel]));
        Self { ambient: exactly(ambient), diffuse: exactly(diffuse), specular: exactly(specular) }
    }
}

impl<F: Float> From<&Material> for LookBounds<F> {
    fn from(material: &Material) -> Self {
        let Material { ambient, diffuse, specular, .. } = *material;
        Look { ambient, diffuse, specular }.into()
    }
}

impl<F: Float> LookBounds<F> {
    /// Returns the smallest bounds that contain both.
    pub fn hull(&self, other: &Self) -> Self {
        let hull = |one: [Interval<F>; 3], other: [Interval<F>; 3]| {
            per_axis(|channel| one[channel].hull(other[channel]))
        };
        Self {
            ambient: hull(self.ambient, other.ambient),
            diffuse: hull(self.diffuse, other.diffuse),
            specular: hull(self.specular, other.specular),
        }
    }
}

/// The shader of an object that has none of its own: the material everywhere.
pub struct Plain;

impl Shader for Plain {
    fn uniform(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        Some(Look { ambient, diffuse, specular })
    }
}
