//! Points of surfaces, and boxes of them, as shaders see them.

use crate::certify::{Precise, ProofMethods};
use crate::geometry::aabb::Aabb;
use crate::geometry::ray::Side;
use crate::hittable::{Curvature, Hittable};
use crate::number::Number;
use crate::patch::{Patch, PatchOf};
use glam::{DVec2, DVec3};
use tabray_exact::interval::Interval;
use tabray_exact::scalar::constants;

/// A point of a surface, as a shader sees it. On a copy of an object, the point is in the coordinates of the original.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, in world coordinates.
    pub position: DVec3,
    /// The unit normal for shading, outward. It is 0 unless the shader [sees](ShaderInputs) it.
    pub normal: DVec3,
    /// The side that a ray hits. It is the outside unless the shader sees normals.
    pub side: Side,
    /// The coordinates u and v on the surface, mostly from 0 to 1; `None` where the shape has none, or the shader does
    /// not see them.
    pub uv: Option<DVec2>,
    /// The index of the face, from 0; `None` where the shape has none, or the shader does not see it.
    pub face: Option<u32>,
    /// The unit directions along the surface in which u and v grow; `None` where the shape has no u and v, or the
    /// shader does not see these directions.
    pub tangents: Option<[DVec3; 2]>,
    /// The curvature of the surface at the point; `None` where it has no formula, or the shader does not see it.
    pub curvature: Option<Curvature>,
    /// The part of the surface around the point over which the shader takes the mean of its pattern; `None` where the
    /// pattern shows as it is at the point, or the shader does not see the patch.
    pub patch: Option<Patch>,
}

impl SurfacePoint {
    /// Returns a point with nothing but its position.
    #[inline(always)]
    pub fn at(position: DVec3) -> Self {
        Self {
            position,
            normal: DVec3::ZERO,
            side: Side::Outside,
            uv: None,
            face: None,
            tangents: None,
            curvature: None,
            patch: None,
        }
    }

    /// Returns a point of a shape with the properties that a shader sees. `normal` is the outward one.
    pub fn seen(
        shape: &dyn Hittable,
        sees: ShaderInputs,
        position: DVec3,
        normal: DVec3,
        side: Side,
    ) -> Self {
        let (uv, face) = (sees.uv.then(|| shape.uv(position)), sees.face.then(|| shape.face(position)));
        let (uv, face) = (uv.flatten(), face.flatten());
        let tangents = if sees.tangents { tangents(shape, position, normal) } else { None };
        let curvature = if sees.curvature { shape.curvature(position) } else { None };
        let (normal, side) = if sees.normal { (normal, side) } else { (DVec3::ZERO, Side::Outside) };
        Self { position, normal, side, uv, face, tangents, curvature, patch: None }
    }
}

/// The distance between the places where u and v are compared, as a fraction of the size of a shape.
pub const NEAR: f64 = 1e-6;

/// Returns the size of a shape, in world units; if the shape has no bounds, the distance of one of its points from the
/// origin.
pub fn size_of(shape: &dyn Hittable, distance: impl FnOnce() -> f64) -> f64 {
    shape.facts().bounds.map_or_else(distance, |Aabb { low, high }| (high - low).length())
}

/// Returns the unit directions along a surface in which u and v grow; `None` where it has no u and v, or they do not
/// change.
fn tangents(shape: &dyn Hittable, position: DVec3, normal: DVec3) -> Option<[DVec3; 2]> {
    let size = size_of(shape, || position.length());
    let (across, up) = normal.any_orthonormal_pair();
    // A coordinate that grows beyond 1 begins at 0 again.
    let wrapped = |difference: DVec2| difference - difference.round();
    let slopes = |dir: DVec3| {
        let at = |part: f64| shape.uv(position + part * NEAR * size * dir);
        Some(wrapped(at(1.0)? - at(-1.0)?))
    };
    let (right, above) = (slopes(across)?, slopes(up)?);
    let [u, v] = [right.x * across + above.x * up, right.y * across + above.y * up];
    // Along one direction, the other coordinate does not change.
    let [along_u, along_v] = [v.cross(normal), normal.cross(u)];
    let turned = |along: DVec3, grows: DVec3| (along.dot(grows).signum() * along).try_normalize();
    Some([turned(along_u, u)?, turned(along_v, v)?])
}

/// The properties of a point that a shader needs besides its position. The others are not computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShaderInputs {
    /// Whether it sees the normal and the side.
    pub normal: bool,
    /// Whether it sees u and v.
    pub uv: bool,
    /// Whether it sees the face on which the point lies.
    pub face: bool,
    /// Whether it sees the directions in which u and v grow.
    pub tangents: bool,
    /// Whether it sees the curvature.
    pub curvature: bool,
    /// Whether it sees the patch around the point.
    pub patch: bool,
}

impl ShaderInputs {
    /// Only the position.
    pub const POSITION: Self =
        Self { normal: false, uv: false, face: false, tangents: false, curvature: false, patch: false };
    /// The position, the normal and the side.
    pub const NORMAL: Self = Self { normal: true, ..Self::POSITION };
    /// The position, and u and v.
    pub const UV: Self = Self { uv: true, ..Self::POSITION };
    /// The position and the face.
    pub const FACE: Self = Self { face: true, ..Self::POSITION };

    /// The position, and the patch around it.
    pub const PATCH: Self = Self { patch: true, ..Self::POSITION };

    /// Returns the properties that either sees.
    pub fn and(self, other: Self) -> Self {
        Self {
            normal: self.normal | other.normal,
            uv: self.uv | other.uv,
            face: self.face | other.face,
            tangents: self.tangents | other.tangents,
            curvature: self.curvature | other.curvature,
            patch: self.patch | other.patch,
        }
    }

    /// Tells whether the position is all that is seen, where there are no patches.
    #[inline(always)]
    pub fn is_position(self) -> bool {
        Self { patch: false, ..self } == Self::POSITION
    }
}

/// A point of a surface as a rule of light sees it, in any number: one point, or all points of a box.
#[derive(Clone, Copy, Debug)]
pub struct Point<'p, N> {
    /// The position, in world coordinates, or on a copy in those of the original.
    pub position: [N; 3],
    /// The unit normal for shading, outward; `None` where it is not known.
    pub normal: Option<[N; 3]>,
    /// The coordinates u and v; `None` where the shape has none, they are not known, or the shader does not see them.
    pub uv: Option<[N; 2]>,
    /// The index of the face; `None` where the shape has none, it is not known, or the shader does not see it.
    pub face: Option<u32>,
    /// The patch over which the mean is shown; `None` where a point is shown, or the patch is not known.
    pub patch: Option<PatchOf<N>>,
    /// The unit directions along the surface in which u and v grow; `None` where they are not known, or the shader
    /// does not see them.
    pub tangents: Option<[[N; 3]; 2]>,
    /// The point itself, in plain numbers: for a rule that pictures compute in another way than proofs.
    pub plain: Option<&'p SurfacePoint>,
}

impl<'p, N: Number> Point<'p, N> {
    /// Returns a point in any number.
    #[inline(always)]
    pub fn of(at: &'p SurfacePoint) -> Self {
        let pair = |of: DVec2| [N::constant(of.x), N::constant(of.y)];
        Self {
            position: constants(at.position),
            normal: Some(constants(at.normal)),
            uv: at.uv.map(pair),
            face: at.face,
            patch: at.patch.map(|patch| PatchOf {
                middle: constants(at.position),
                sides: [constants(patch.sides[0]), constants(patch.sides[1])],
                uv: patch.uv.map(|[low, high]| [pair(low), pair(high)]),
            }),
            tangents: at.tangents.map(|[u, v]| [constants(u), constants(v)]),
            plain: Some(at),
        }
    }
}

impl<F: Precise> Point<'_, Interval<F>> {
    /// Returns bounds of points of a part of a shape, with what a shader sees of them.
    pub fn seen(
        shape: &dyn ProofMethods,
        sees: ShaderInputs,
        part: usize,
        position: [Interval<F>; 3],
        normal: Option<[Interval<F>; 3]>,
    ) -> Self {
        let shape = F::proofs(shape);
        let uv = if sees.uv { shape.uv_bounds(position, part) } else { None };
        let face = if sees.face { shape.face(position, part) } else { None };
        let uv = uv.map(|uv| uv.map(Interval::from_f64));
        Self { position, normal, uv, face, patch: None, tangents: None, plain: None }
    }
}
