//! A shape of any type, together with the traits that it implements beyond [`Hittable`].

use crate::certify::{Enclosure, HitEnclosure, HitProofs, Precision, Premise, ProofMethods};
use crate::geometry::aabb::Aabb;
use crate::geometry::facet::Facet;
use crate::geometry::ray::{Bracket, Ray, RayRange, Side};
use crate::geometry::ray_packet::{HitRecordMut, RayPacket};
use crate::geometry::sight::Sight;
use crate::hittable::{Facts, Hittable, Shape, Sides, SurfaceHit};
use crate::packets::shape::{HitQueries, PacketIntersect, PacketShape};
use crate::simd::cpu::Cpu;
use glam::DVec3;
use std::ops::Deref;
use tabray_exact::interval::Fraction;

/// The shape of an object, of any type. It dereferences to [`Hittable`].
pub struct AnyShape {
    shape: Box<dyn PacketShape>,
    // The facts that each hit needs. All facts together would take more memory than most shapes.
    can_hit_itself: Sides,
    is_two_sided: bool,
    is_smooth: bool,
}

impl AnyShape {
    /// Wraps a shape with its own functions for packets and proofs.
    pub fn of_packets(shape: impl PacketShape + 'static) -> Self {
        let Facts { can_hit_itself, is_two_sided, is_smooth, .. } = shape.hittable().facts();
        Self { shape: Box::new(shape), can_hit_itself, is_two_sided, is_smooth }
    }

    /// Tells whether a ray that leaves the shape on a side may hit it again, according to its facts.
    #[inline]
    pub fn can_hit_itself(&self, leaving: Side) -> bool {
        self.can_hit_itself.contain(leaving)
    }

    /// Tells whether both sides of the surface are lit, as its facts say.
    #[inline]
    pub fn is_two_sided(&self) -> bool {
        self.is_two_sided
    }

    /// Tells whether the surface is anywhere shaded with normals other than its own, according to its facts.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.is_smooth
    }

    /// Returns a box that contains the shape; `None` for an unbounded shape. This is the box of its facts, widened by
    /// the rounding of its numbers.
    pub fn bounds(&self) -> Option<Aabb> {
        self.facts().widened()
    }

    /// Tells whether no part of the shape lies in a region. `false` is always correct.
    pub fn is_clear_of(&self, region: &Aabb) -> bool {
        let shape = self.shape.hittable();
        shape.is_clear_of(&region.with_slack(shape.facts().max_coordinate))
    }

    /// Returns the bounding box by which the shape may be culled, if there is one. Shapes of the notes are never
    /// culled, since the notes' program tests every ray against every shape.
    pub fn culling_bounds(&self) -> Option<Aabb> {
        self.bounds().filter(|_| !self.shape.is_of_the_notes())
    }

    /// Tells whether the shape may be culled because no part of it lies in a region.
    #[inline]
    pub fn is_culled_in(&self, region: &Aabb) -> bool {
        self.is_clear_of(region) && !self.shape.is_of_the_notes()
    }

    /// Returns the shape's interface for packets of rays.
    #[inline]
    pub fn packets(&self) -> &dyn PacketShape {
        &*self.shape
    }

    /// Returns a bracket of the distance of the ray's first hit, as tight as a quick computation makes it.
    pub fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        self.shape.t_bounds(&ray.into(), range)
    }

    /// Returns the distance of a hit that [`t_bounds`](Self::t_bounds) has found for certain, or NaN where it takes
    /// more than plain arithmetic. `origin_side` is the side of the shape that the ray starts on, if it starts on the
    /// shape.
    pub fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.shape.refine_one(ray, origin_side)
    }

    /// Tells whether a point lies on the surface, up to an error in world units.
    pub fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        self.shape.is_on_surface(at, error)
    }

    /// Tells whether a point lies in a closed shape; `None` where the surface may be within an error in world units
    /// along each axis. Where a box cuts a surface, the inside is what lies inside of both.
    pub fn contains(&self, at: DVec3, error: f64) -> Option<bool> {
        self.shape.contains(at, error)
    }

    /// Tells whether the shape is a part of a solid's surface: [`contains`](Self::contains) then tells what lies in the
    /// solid.
    pub fn is_of_solid(&self) -> bool {
        self.shape.is_of_solid()
    }

    /// Tells whether rays that cross the surface enter and leave a body: that of the shape, or the closed solid whose
    /// surface it is a part of.
    pub fn bounds_body(&self) -> bool {
        self.why_not_closed().is_none() || self.shape.is_of_closed_solid()
    }

    /// Returns the plane that contains all of a closed shape's surface within an error, in world units, of a point;
    /// `None` where that is not known.
    pub fn facet(&self, at: DVec3, error: f64) -> Option<Facet> {
        self.shape.facet(at, error)
    }

    /// Passes on the premises of proofs about the shape, each with the name of its entity type. That is `of`, or, where
    /// the shape is made of other shapes, as a copy or a solid is, the type of the other shape.
    pub fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        self.shape.premises(of, each);
    }

    /// Tells whether the shape and all shapes that it is made of have equations. For a shape without an equation, the
    /// only proof is that its hits lie in its bounds.
    pub fn is_certified(&self) -> bool {
        let mut is_certified = true;
        self.premises("", &mut |_, premise| is_certified &= premise != Premise::NoEquation);
        is_certified
    }

    /// Returns what is proven about a ray's first hit.
    pub fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        self.certify_part(sight, precision).0
    }

    /// Returns what is proven about a ray's first hit, and the part of the shape that is hit, of which
    /// [`surface_hit`](Self::surface_hit) tells the normal, u and v, and the face.
    pub fn certify_part(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        let (found, part) = self.shape.certify(sight, precision);
        let is_open = precision == Precision::Octuple && matches!(found, Enclosure::Doubtful(_));
        (if is_open && self.is_parallel(sight) { Enclosure::Misses } else { found }, part)
    }

    /// Returns the surface at the point where a ray hits the shape, at a distance in world units: that of the part that
    /// a proof names, or of the one that the tracer finds.
    pub fn surface_hit(&self, ray: &Ray, distance: f64, at: DVec3, part: Option<usize>) -> SurfaceHit {
        let by_point =
            || SurfaceHit { normal: self.normal(at), uv: self.uv(at), face: self.face_hit(ray, distance) };
        self.shape.surface_hit(ray, distance, at, part).unwrap_or_else(by_point)
    }

    /// Tells whether a ray is parallel to an unbounded shape, as the rays of a row of pixels at the horizon are to a
    /// plane. For numbers such as 1/3, no number of digits proves that, but fractions do.
    fn is_parallel(&self, sight: &Sight) -> bool {
        let found = |proven| HitProofs::<Fraction>::first_hit(proven, &sight.line(), None).0;
        self.facts().bounds.is_none()
            && self.proven().is_some_and(|proven| found(proven) == HitEnclosure::Misses)
    }

    /// Returns the functions for proofs about other rays than primary ones; `None` for a shape without an equation.
    pub fn proven(&self) -> Option<&dyn ProofMethods> {
        self.shape.proven()
    }

    /// Merges the hits of a packet's rays with this shape into the nearest hits so far, and tells whether the order of
    /// any two hits is in doubt. `id` is the object's index in the scene plus 1.
    #[inline]
    pub fn closest_hits(&self, cpu: Cpu, rays: RayPacket, id: u64, nearest: HitRecordMut) -> bool {
        self.shape.closest_hits(cpu, rays, id, nearest)
    }
}

impl Deref for AnyShape {
    type Target = dyn Hittable;

    fn deref(&self) -> &Self::Target {
        self.shape.hittable()
    }
}

/// Wraps a shape that implements none of the optional traits.
impl<T: Hittable + 'static> From<T> for AnyShape {
    fn from(shape: T) -> Self {
        Shape::new(shape).into()
    }
}

impl<T: Hittable + 'static, S: 'static, P: 'static> From<Shape<T, S, P>> for AnyShape
where
    Shape<T, S, P>: PacketIntersect + HitQueries,
{
    fn from(shape: Shape<T, S, P>) -> Self {
        Self::of_packets(shape)
    }
}
