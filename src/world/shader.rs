//! Shaders: the trait that a plugin implements for one point of a surface.

use crate::interface::Gloss;
use crate::luminous::Luminous;
use crate::material::{Look, Material, Reflectivity, Rgb};
use crate::number::Number;
use crate::simd::cpu::Cpu;
use crate::simd::soa::{View, ViewMut};
use crate::surface_point::{Point, ShaderInputs, SurfacePoint};
use glam::{DVec2, DVec3};
use std::ops::Range;
use tabray_exact::affine::Affine;
use tabray_exact::interval::{Interval, Wide};
use tabray_exact::scalar::constants;

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

    /// Returns a reflectivity at a point, or bounds of it at all points of a box; `None` where it is open, which it is not in
    /// plain numbers. Pictures ask in plain numbers, and proofs of colours in numbers that enclose others.
    #[inline]
    fn reflectivity<N: Number>(&self, of: Reflectivity, material: &Material, _at: &Point<N>) -> Option<[N; 3]>
    where
        Self: Sized,
    {
        Some(constants(material.reflectivity(of)))
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

    /// Returns the outward unit normal with which a point is shaded instead of this one, if the shader
    /// [bends](Self::bends) normals; `None` where it is open, which it is not in plain numbers. Lights and mirrors use
    /// the bent normal. The surface itself stays as it is: light from behind does not reach it, and rays leave it on the
    /// side that they hit.
    #[inline]
    fn bend<N: Number>(&self, _at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]>
    where
        Self: Sized,
    {
        Some(normal)
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
    fn coverage<N: Number>(&self, _at: &Point<N>) -> N
    where
        Self: Sized,
    {
        N::constant(1.0)
    }

    /// Returns how rays cross the surface at a point, if its material's interface
    /// [varies](crate::interface::Interface::varies); `None` where they cross it as that says.
    fn gloss(&self, _at: &SurfacePoint) -> Option<Gloss> {
        None
    }

    /// Returns the three reflectivities, if each is the same at every point. Then only [`bend`](Self::bend) is called
    /// for each point, not the methods above. `None` is always correct.
    fn uniform(&self, _material: &Material) -> Option<Look> {
        None
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

/// A shader of any type, asked in any number. Every [`Shader`] is one.
pub trait EnclosedShader: Shader + Looks<f64> + Looks<Interval> + Looks<Affine> + Looks<Wide> {}

impl<T: Shader> EnclosedShader for T {}

/// A shader of any type, asked in one number. Every [`Shader`] is one.
pub trait Looks<N> {
    /// Calls [`Shader::reflectivity`].
    fn reflects(&self, of: Reflectivity, material: &Material, at: &Point<N>) -> Option<[N; 3]>;

    /// Calls [`Shader::coverage`].
    fn covers(&self, at: &Point<N>) -> N;

    /// Calls [`Shader::bend`].
    fn leans(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]>;
}

impl<T: Shader, N: Number> Looks<N> for T {
    fn reflects(&self, of: Reflectivity, material: &Material, at: &Point<N>) -> Option<[N; 3]> {
        self.reflectivity(of, material, at)
    }

    fn covers(&self, at: &Point<N>) -> N {
        self.coverage(at)
    }

    fn leans(&self, at: &Point<N>, normal: [N; 3]) -> Option<[N; 3]> {
        self.bend(at, normal)
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
    /// Evaluates the ambient and the specular [reflectivities](Shader::reflectivity) of many points. Returns whether any
    /// specular reflectivity is not 0.
    fn ambient_and_specular(
        &self,
        cpu: Cpu,
        material: &Material,
        points: SurfacePoints,
        ambients: ViewMut,
        speculars: ViewMut,
    ) -> bool;

    /// Evaluates the diffuse [reflectivities](Shader::reflectivity) of many points. Returns whether any reflectivity is not 0.
    fn diffuses(&self, cpu: Cpu, material: &Material, points: SurfacePoints, out: ViewMut) -> bool;

    /// Writes the [`tile`](Shader::tile) at each point, as one number.
    fn tiles(&self, cpu: Cpu, points: SurfacePoints, out: &mut [u64]);

    /// Returns a reflectivity at one point.
    fn colour_at(&self, of: Reflectivity, material: &Material, at: &SurfacePoint) -> Rgb {
        self.reflects(of, material, &Point::<f64>::of(at)).map_or(Rgb::ZERO, Rgb::from)
    }

    /// Returns the [`coverage`](Shader::coverage) of one point.
    fn coverage_at(&self, at: &SurfacePoint) -> f64 {
        self.covers(&Point::<f64>::of(at))
    }

    /// Returns the normal at one point, [bent](Shader::bend).
    fn normal_at(&self, at: &SurfacePoint) -> DVec3 {
        self.leans(&Point::<f64>::of(at), at.normal.to_array()).map_or(at.normal, DVec3::from)
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
