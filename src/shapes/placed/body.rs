//! Copies as objects, and their reflectivities.

use super::object_space::object_points;
use super::packets::PART;
use super::shape::Placed;
use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::scalar::constants;
use tabray_world::any_shape::AnyShape;
use tabray_world::body::{AnyShader, Body, MakeBoundary};
use tabray_world::geometry::placement::Placement;
use tabray_world::geometry::ray_packet::split;
use tabray_world::interface::Gloss;
use tabray_world::luminous::Luminous;
use tabray_world::material::{Look, Material, Reflectivity, Rgb};
use tabray_world::number::Number;
use tabray_world::packets::shader::PacketShader;
use tabray_world::patch::{Patch, PatchOf};
use tabray_world::shader::{EachPart, Plain, Shader, SurfacePoints};
use tabray_world::simd::cpu::Cpu;
use tabray_world::simd::soa::Vectors;
use tabray_world::surface_point::{Point, ShaderInputs, SurfacePoint};

impl Placed {
    /// Makes a copy of an object with this material. If the object ends like planes do, the copy ends at `max_z`, in
    /// world space.
    pub fn body(body: &Arc<Body>, (placement, max_z): (Placement, Option<f64>), material: &Material) -> Body {
        let shape = AnyShape::of_packets(Self::new(body, placement).up_to(max_z));
        let is_plain = body.shader.uniform(material) == Plain.uniform(material) && !body.shader.bends();
        let shaded = |shape| Body::shaded(shape, PlacedShader::new(body, placement, None));
        let copy = if is_plain { Body::plain(shape) } else { shaded(shape) };
        let original = Arc::clone(body);
        let to_object_space = move |shader: AnyShader| -> AnyShader {
            Arc::new(PlacedShader::new(&original, placement, Some(shader)))
        };
        let own = Arc::clone(body);
        let boundary = move || {
            let inner = Body { entity: own.entity, ..Body::plain(own.boundary()?) };
            Some(AnyShape::of_packets(Self::new(&Arc::new(inner), placement)))
        };
        Body {
            boundary: body.boundary.is_some().then(|| -> MakeBoundary { Box::new(boundary) }),
            depth: body.depth + 1,
            anchor: Some(body.anchor()),
            to_object_space: Some(Box::new(to_object_space)),
            ..copy
        }
    }
}

/// The reflectivities of an object, in object space.
struct PlacedShader {
    placed: Placed,
    /// The shader of the copy, or `None` for the object's shader.
    shader: Option<AnyShader>,
    /// The map of normals from world space to object space, up to their length.
    normal_to_own: DMat3,
}

impl PlacedShader {
    fn new(body: &Arc<Body>, placement: Placement, shader: Option<AnyShader>) -> Self {
        let placed = Placed::new(body, placement);
        // Normals are mapped to world space by the transposed matrix, and back by its inverse.
        let normal_to_own = placed.to_object_space.transpose().inverse();
        Self { placed, shader, normal_to_own }
    }

    fn own(&self) -> &dyn PacketShader {
        self.shader.as_deref().unwrap_or(&*self.placed.body.shader)
    }

    /// Calls a function with a point in object space.
    fn in_own<N: Number, R>(&self, at: &Point<N>, call: impl FnOnce(&Point<N>) -> R) -> R {
        if let Some(at) = at.plain {
            return call(&Point::of(&self.object_point(at)));
        }
        let placement = &self.placed.placement;
        let patch = at.patch.map(|patch| PatchOf {
            middle: placement.point(patch.middle),
            sides: patch.sides.map(|side| placement.vector(side)),
            ..patch
        });
        call(&Point { position: placement.point(at.position), normal: None, patch, tangents: None, ..*at })
    }

    /// Maps a point from world space to object space.
    fn object_point(&self, at: &SurfacePoint) -> SurfacePoint {
        let normal = (self.normal_to_own * at.normal).normalize_or_zero();
        let own = |tangent: DVec3| (self.placed.to_object_space * tangent).normalize_or_zero();
        let tangents = at.tangents.map(|tangents| tangents.map(own));
        let sides = |patch: Patch| patch.sides.map(|side| self.placed.to_object_space * side);
        let patch = at.patch.map(|patch| Patch { sides: sides(patch), ..patch });
        SurfacePoint { position: self.placed.object_point(at.position), normal, tangents, patch, ..*at }
    }
}

impl Shader for PlacedShader {
    fn sees(&self) -> ShaderInputs {
        self.own().sees()
    }

    fn reflectivity<N: Number>(
        &self,
        of: Reflectivity,
        material: &Material,
        at: &Point<N>,
    ) -> Option<[N; 3]> {
        self.in_own(at, |at| N::looks(self.own()).reflects(of, material, at))
    }

    fn emission(&self, at: &SurfacePoint) -> Rgb {
        self.own().emission(&self.object_point(at))
    }

    fn glowing(&self) -> Vec<(Luminous, Rgb)> {
        let mapped = |(part, light): (Luminous, Rgb)| Some((self.placed.mapped(&part)?, light));
        self.own().glowing().into_iter().filter_map(mapped).collect()
    }

    fn tile(&self, at: &SurfacePoint) -> DVec2 {
        self.own().tile(&self.object_point(at))
    }

    fn level(&self, at: &SurfacePoint) -> f64 {
        self.own().level(&self.object_point(at))
    }

    fn in_object_space(&self, cpu: Cpu, points: SurfacePoints, each: EachPart) -> bool {
        for part in split(points.positions.len(), PART) {
            let mut positions = Vectors::<PART>::ZERO;
            object_points(
                cpu,
                &self.placed,
                points.positions.part(part.clone()),
                positions.view_mut(part.len()),
            );
            // No points are given to a shader that sees only their positions.
            let seen = points.seen.get(part.clone()).unwrap_or_default();
            let seen: Vec<_> = seen.iter().map(|at| self.object_point(at)).collect();
            each(self.own(), SurfacePoints { positions: positions.view(part.len()), seen: &seen }, part);
        }
        true
    }

    fn bends(&self) -> bool {
        self.own().bends()
    }

    /// Proofs know no bent normals of copies.
    fn bend<N: Number>(&self, at: &Point<N>, _normal: [N; 3]) -> Option<[N; 3]> {
        let at = at.plain?;
        let own = self.own().normal_at(&self.object_point(at));
        let bent = (self.placed.to_object_space.transpose() * own).try_normalize();
        Some(constants(bent.unwrap_or(at.normal)))
    }

    // The holes of the object's shader are already holes of its shape.
    fn cuts_out(&self) -> bool {
        self.shader.as_ref().is_some_and(|shader| shader.cuts_out())
    }

    fn is_cut_out(&self, at: &SurfacePoint) -> bool {
        self.own().is_cut_out(&self.object_point(at))
    }

    fn covers_in_part(&self) -> bool {
        self.own().covers_in_part()
    }

    fn coverage<N: Number>(&self, at: &Point<N>) -> N {
        self.in_own(at, |at| N::looks(self.own()).covers(at))
    }

    fn gloss(&self, at: &SurfacePoint) -> Option<Gloss> {
        self.own().gloss(&self.object_point(at))
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.own().uniform(material)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.own().brightest(material)
    }
}
