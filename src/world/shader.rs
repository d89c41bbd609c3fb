//! Shaders: the trait that a plugin implements for one point of a surface.

use crate::certify::Precise;
use crate::luminous::Luminous;
use crate::material::{Look, Material, Rgb};
use crate::patch::PatchBounds;
use crate::simd::cpu::Cpu;
use crate::simd::soa::{View, ViewMut};
use crate::surface_point::{PointBounds, ShaderInputs, SurfacePoint};
use f256::f256;
use glam::{DVec2, DVec3};
use std::ops::Range;
use tabray_exact::interval::{Fine, Float, Fraction, Interval};
use tabray_exact::scalar::{Scalar, per_axis};

/// The origin and the unit of length of the pattern of a shader on one object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// The point of the plane or the centre of the sphere, in world units; of other objects, the middle of their box.
    pub origin: DVec3,
    /// The length that counts as 1, in world units: 1 on a plane, the diameter of a sphere; of other objects, the
    /// longest side of their box.
    pub unit: f64,
}

/// The reflectivities of a surface, which may differ from point to point.
///
/// The defaults are the material's, as in the notes' `material_getamb`, `material_getdiff` and `material_getspec`.
pub trait Shader: Send + Sync {
    /// Tells which properties of a point the shader sees besides its position. The answer is the same in every call.
    #[inline(always)]
    fn sees(&self) -> ShaderInputs {
        ShaderInputs::POSITION
    }

    /// Returns the reflectivity for ambient light at a point.
    #[inline]
    fn ambient(&self, material: &Material, _at: &SurfacePoint) -> Rgb {
        material.ambient
    }

    /// Returns the diffuse reflectivity for light from the scene's lights at a point.
    #[inline]
    fn diffuse(&self, material: &Material, _at: &SurfacePoint) -> Rgb {
        material.diffuse
    }

    /// Returns the mirror reflectivity at a point.
    #[inline]
    fn specular(&self, material: &Material, _at: &SurfacePoint) -> Rgb {
        material.specular
    }

    /// Returns the part of the ambient light at a point that the surface gives by itself, besides the material's
    /// emission: where light bounces, it lights other surfaces.
    #[inline]
    fn emission(&self, _at: &SurfacePoint) -> Rgb {
        Rgb::ZERO
    }

    /// Returns parts of the surface that give the same light everywhere, as rays aim at them, and the light of each: at
    /// their points, [`emission`](Self::emission) is exactly this light, and at no others. None is always correct: what
    /// gives light is then met by chance.
    fn glowing(&self) -> Vec<(Luminous, Rgb)> {
        Vec::new()
    }

    /// Calls a function with the shader of a copied object, and parts of these points in its coordinates, if this is the
    /// shader of a copy; tells whether it is.
    #[doc(hidden)]
    fn in_object_space(&self, _cpu: Cpu, _points: SurfacePoints, _each: EachPart) -> bool {
        false
    }

    /// Tells whether the shader bends normals. It is the same in every call.
    #[inline(always)]
    fn bends(&self) -> bool {
        false
    }

    /// Returns the outward unit normal with which a point is shaded, if the shader [bends](Self::bends) normals; such
    /// a shader [sees](Self::sees) them. Lights and mirrors use the bent normal. The surface itself stays as it is:
    /// light from behind does not reach it, and rays leave it on the side that they hit.
    #[inline]
    fn bend(&self, at: &SurfacePoint) -> DVec3 {
        at.normal
    }

    /// Tells whether the shader cuts parts out of the surface. It is the same in every call.
    #[inline(always)]
    fn cuts_out(&self) -> bool {
        false
    }

    /// Tells whether a point is cut out, if the shader [cuts parts out](Self::cuts_out). Rays pass through it.
    #[inline]
    fn is_cut_out(&self, _at: &SurfacePoint) -> bool {
        false
    }

    /// Tells whether the surface covers only a part of what is behind it anywhere, by the free rules of light. It is
    /// the same in every call.
    #[inline(always)]
    fn covers_in_part(&self) -> bool {
        false
    }

    /// Returns the fraction of what is behind a point that it covers, from 0 to 1, if the shader [covers in
    /// part](Self::covers_in_part). The rest is seen through it unbent, and shadows are as light.
    #[inline]
    fn coverage(&self, _at: &SurfacePoint) -> f64 {
        1.0
    }

    /// Encloses the [`coverage`](Self::coverage) of every point of a box, before any rounding. The default is always
    /// correct.
    fn enclose_coverage<F: Precise>(&self, _at: &PointBounds<F>) -> Interval<F>
    where
        Self: Sized,
    {
        let least = if self.covers_in_part() { 0.0 } else { 1.0 };
        Interval::constant(least).hull(Interval::constant(1.0))
    }

    /// Encloses the unit normals that the shader makes of these outward ones, which the shader of
    /// [`colours`](Self::colours) has already bent, before any rounding, at every point of a box; `None` where the
    /// bent normals are not known. `None` is always correct.
    fn enclose_bend<F: Precise>(
        &self,
        _at: &PointBounds<F>,
        _normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]>
    where
        Self: Sized,
    {
        None
    }

    /// Returns the shader that gives the colours, and the normals to bend, if this shader only bends normals.
    fn colours(&self) -> Option<&(dyn EnclosedShader + 'static)> {
        None
    }

    /// Returns the three reflectivities, if each is the same at every point. Then only [`bend`](Self::bend) is called
    /// for each point, not the methods above. `None` is always correct.
    fn uniform(&self, _material: &Material) -> Option<Look> {
        None
    }

    /// Encloses the three reflectivities, before any rounding, at every point of a box; `None` where they are not
    /// known. Proofs of colours ask for them. `None` is always correct.
    fn enclose<F: Precise>(&self, material: &Material, _at: &PointBounds<F>) -> Option<LookBounds<F>>
    where
        Self: Sized,
    {
        self.uniform(material).map(LookBounds::from)
    }

    /// Returns the tile or the texel at a point, as two integers that differ from those of its neighbours. Adaptive
    /// sampling takes more samples between points on different tiles than their colours alone would suggest. Two
    /// zeros everywhere are correct.
    #[inline]
    fn tile(&self, _at: &SurfacePoint) -> DVec2 {
        DVec2::ZERO
    }

    /// Returns the number of the region between level lines in which a point lies, for drawings of these lines.
    fn level(&self, _at: &SurfacePoint) -> f64 {
        0.0
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

/// Takes the reflectivities as exact.
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
    /// Returns the bounds of weighted means of both. `part` is the weight of the other.
    pub fn mean(&self, other: &Self, part: Interval<F>) -> Self {
        let either = self.hull(other);
        let mean = |one: [Interval<F>; 3], other: [Interval<F>; 3], either: [Interval<F>; 3]| {
            per_axis(|channel| {
                let Interval { low, high } = one[channel] + part * (other[channel] - one[channel]);
                Interval { low: low.max(either[channel].low), high: high.min(either[channel].high) }
            })
        };
        Self {
            ambient: mean(self.ambient, other.ambient, either.ambient),
            diffuse: mean(self.diffuse, other.diffuse, either.diffuse),
            specular: mean(self.specular, other.specular, either.specular),
        }
    }

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

/// A shader that is enclosed in each precision. Every [`Shader`] is one.
pub trait EnclosedShader: Shader + EncloseLook<f64> + EncloseLook<f256> + EncloseLook<Fraction> {}

impl<T: Shader> EnclosedShader for T {}

/// A shader whose looks are enclosed in one precision. Every [`Shader`] is one.
pub trait EncloseLook<F> {
    /// Calls [`Shader::enclose`].
    fn look(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>>;

    /// Calls [`Shader::enclose_coverage`].
    fn coverage_bounds(&self, at: &PointBounds<F>) -> Interval<F>;

    /// Calls [`Shader::enclose_bend`].
    fn bent(&self, at: &PointBounds<F>, normal: [Interval<F>; 3]) -> Option<[Interval<F>; 3]>;
}

impl<T: Shader, F: Precise> EncloseLook<F> for T {
    fn look(&self, material: &Material, at: &PointBounds<F>) -> Option<LookBounds<F>> {
        self.enclose(material, at)
    }

    fn coverage_bounds(&self, at: &PointBounds<F>) -> Interval<F> {
        self.enclose_coverage(at)
    }

    fn bent(&self, at: &PointBounds<F>, normal: [Interval<F>; 3]) -> Option<[Interval<F>; 3]> {
        self.enclose_bend(at, normal)
    }
}

/// Encloses the look of a shader of any type, as [`Shader::enclose`] does.
pub fn enclosed<F: Precise>(
    shader: &dyn EnclosedShader,
    material: &Material,
    at: &PointBounds<F>,
) -> Option<LookBounds<F>> {
    let look = EncloseLook::<Fraction>::look(shader, material, &widened(at))?;
    let narrow = |colour: [Fine; 3]| colour.map(F::narrow);
    let LookBounds { ambient, diffuse, specular } = look;
    Some(LookBounds { ambient: narrow(ambient), diffuse: narrow(diffuse), specular: narrow(specular) })
}

/// Encloses the coverage of a shader of any type, as [`Shader::enclose_coverage`] does.
pub fn enclosed_coverage<F: Precise>(shader: &dyn EnclosedShader, at: &PointBounds<F>) -> Interval<F> {
    F::narrow(EncloseLook::<Fraction>::coverage_bounds(shader, &widened(at)))
}

/// Returns the bounds of a point as fractions.
fn widened<F: Precise>(at: &PointBounds<F>) -> PointBounds<Fraction> {
    PointBounds {
        position: at.position.map(F::widen),
        normal: at.normal.map(|normal| normal.map(F::widen)),
        uv: at.uv,
        face: at.face,
        patch: at.patch.map(|PatchBounds { middle, sides, uv }| PatchBounds {
            middle: middle.map(F::widen),
            sides: sides.map(|side| side.map(F::widen)),
            uv,
        }),
        tangents: at.tangents.map(|tangents| tangents.map(|along| along.map(F::widen))),
    }
}

/// Points of a surface, as a shader sees them.
#[derive(Clone, Copy)]
pub struct SurfacePoints<'p> {
    /// The positions, in world coordinates.
    pub positions: View<'p>,
    /// The points, as many as there are positions; empty for a shader that sees only their positions.
    pub seen: &'p [SurfacePoint],
}

/// Takes the shader of a copied object, and a part of the points in its coordinates, with their indices.
pub type EachPart<'e> = &'e mut dyn FnMut(&dyn PacketShader, SurfacePoints, Range<usize>);

/// A shader for packets. Every [`Shader`] is one.
pub trait PacketShader: EnclosedShader {
    /// Evaluates [`ambient`](Shader::ambient) and [`specular`](Shader::specular) at many points. Returns whether any
    /// specular reflectivity is not 0.
    fn ambient_and_specular(
        &self,
        cpu: Cpu,
        material: &Material,
        points: SurfacePoints,
        ambients: ViewMut,
        speculars: ViewMut,
    ) -> bool;

    /// Evaluates [`diffuse`](Shader::diffuse) at many points. Returns whether any reflectivity is not 0.
    fn diffuses(&self, cpu: Cpu, material: &Material, points: SurfacePoints, out: ViewMut) -> bool;

    /// Writes the [`tile`](Shader::tile) at each point, as one number.
    fn tiles(&self, cpu: Cpu, points: SurfacePoints, out: &mut [u64]);
}

/// The shader of an object that has none of its own: the material everywhere.
pub struct Plain;

impl Shader for Plain {
    fn uniform(&self, material: &Material) -> Option<Look> {
        let Material { ambient, diffuse, specular, .. } = *material;
        Some(Look { ambient, diffuse, specular })
    }
}
