//! Proofs about the hits of a shape, by the way in which its distances are found.

use crate::certify::{self, Assumption, Enclosure, Equation, Precision, Premise, ProofMethods};
use crate::coincidence::ROUNDING;
use crate::geometry::facet::Facet;
use crate::geometry::ray::{MISS, Ray, RayRange};
use crate::geometry::sight::Sight;
use crate::hittable::{ByEquation, ByFormula, Certified, Hittable, Shape, SurfaceHit, Unproven};
use glam::DVec3;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::interval::{Float, Fraction};
use tabray_exact::roots::Method;

/// A shape about whose hits something may be proven.
pub trait HitQueries: Send + Sync {
    /// Tells whether a point lies on the surface, up to an error in world units and to the rounding of the shape's own
    /// numbers. Rays that start at such a point leave the shape.
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool;

    /// Tells whether a point lies in a closed shape; `None` where the surface may be within an error, in world units,
    /// along each axis: in a cube around the point.
    fn contains(&self, _at: DVec3, _error: f64) -> Option<bool> {
        None
    }

    /// Tells whether the shape is a part of a solid's surface, for which [`contains`](Self::contains) tells whether a
    /// point lies in the solid.
    fn is_of_solid(&self) -> bool {
        false
    }

    /// Returns the facet whose plane contains all of a closed shape's surface within an error, in world units, of a
    /// point; `None` where that is not known.
    fn facet(&self, _at: DVec3, _error: f64) -> Option<Facet> {
        None
    }

    /// Returns the distance of the hit near `distance` in double-double arithmetic, or `None` where no such distance
    /// can be computed.
    fn fine_distance(&self, _ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        None
    }

    /// Passes on the premises of proofs about the shape, each with the name of its entity type. That is `of`, or, where
    /// the shape is made of other shapes, as a copy or a solid is, the type of the other shape.
    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise));

    /// Returns what is proven about a ray's first hit, and the part of the shape that is hit: 0 of a shape of one part.
    fn certify(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        let open = (Enclosure::Doubtful(Fraction::of(0.0)), 0);
        self.proven().map_or(open, |proven| certify::first_part(proven, sight, precision))
    }

    /// Returns the surface of the part that a proof names, where a ray hits it at a distance in world units; without a
    /// part, of the one that the tracer finds. `None` for a shape whose points tell their surface.
    fn surface_hit(
        &self,
        _ray: &Ray,
        _distance: f64,
        _at: DVec3,
        _part: Option<usize>,
    ) -> Option<SurfaceHit> {
        None
    }

    /// Returns the proofs about other rays than primary ones; `None` for a shape without an equation.
    fn proven(&self) -> Option<&dyn ProofMethods> {
        None
    }

    /// Tells whether the shape is a part of the surface of a closed solid.
    fn is_of_closed_solid(&self) -> bool {
        false
    }

    /// Tells whether hits are found by a formula of the notes, whose program tests every ray against every shape.
    fn is_of_the_notes(&self) -> bool {
        false
    }

    /// Returns the distance by another root-finding method, or `None` where the shape's hits are not the roots of a
    /// function along the ray, or are found in closed form.
    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}

impl<T: Hittable, S> HitQueries for Shape<T, S, Unproven> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        is_met_within(&self.shape, at, error)
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        each(of, Premise::NoEquation);
        if self.shape.facts().bounds.is_some() {
            each(of, Premise::Assumed(Assumption::Bounds));
        }
    }

    fn certify(&self, sight: &Sight, _precision: Precision) -> (Enclosure, usize) {
        (certify::first_hit_in(self.shape.facts().widened(), &sight.line()).into(), 0)
    }
}

impl<T: Hittable + Equation, S> HitQueries for Shape<T, S, ByFormula> {
    fn is_of_the_notes(&self) -> bool {
        true
    }

    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        is_met_within(&self.shape, at, error)
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        assumed(&self.shape, of, each);
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        (certify::first_hit(&self.shape, sight, precision), 0)
    }
}

/// Implements [`HitQueries`] for a type by the equation of a shape: the type, between its parameters and the shape as a
/// place in `self`.
#[macro_export]
macro_rules! queries_by_equation {
    ([$($parameters:tt)*] $Type:ty, |$self:ident| $shape:expr) => {
        impl<$($parameters)*> $crate::packets::shape::HitQueries for $Type {
            fn is_on_surface(&$self, at: $crate::glam::DVec3, error: f64) -> bool {
                $crate::hittable::Certified::is_on_surface($shape, at, error)
            }

            fn contains(&$self, at: $crate::glam::DVec3, error: f64) -> Option<bool> {
                $crate::certify::contains($shape, at, error)
            }

            fn facet(
                &$self,
                at: $crate::glam::DVec3,
                error: f64,
            ) -> Option<$crate::geometry::facet::Facet> {
                $crate::hittable::Certified::facet($shape, at, error)
            }

            fn fine_distance(
                &$self,
                ray: &$crate::geometry::ray::Ray,
                distance: f64,
            ) -> Option<$crate::exact::double_double::DoubleDouble> {
                $crate::hittable::Certified::fine_distance($shape, ray, distance)
            }

            fn premises(
                &$self,
                of: &'static str,
                each: &mut dyn FnMut(&'static str, $crate::certify::Premise),
            ) {
                $crate::packets::shape::assumed($shape, of, each);
            }

            fn certify(
                &$self,
                sight: &$crate::geometry::sight::Sight,
                precision: $crate::certify::Precision,
            ) -> ($crate::certify::Enclosure, usize) {
                ($crate::certify::first_hit($shape, sight, precision), 0)
            }

            fn proven(&$self) -> Option<&dyn $crate::certify::ProofMethods> {
                Some($shape)
            }

            fn distance_by(
                &$self,
                method: $crate::exact::roots::Method,
                ray: &$crate::geometry::ray::Ray,
                range: &$crate::geometry::ray::RayRange,
            ) -> Option<f64> {
                $crate::hittable::Certified::distance_by($shape, method, ray, range)
            }
        }
    };
}

pub use queries_by_equation;

queries_by_equation!([T: Certified, S] Shape<T, S, ByEquation>, |self| &self.shape);

/// Passes on the assumptions of proofs by a shape's equation.
pub fn assumed(shape: &impl Hittable, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
    shape.assumes(&mut |assumption| each(of, Premise::Assumed(assumption)));
}

/// Tells whether a short ray through a point, perpendicular to a shape, hits the shape within an error in world units.
fn is_met_within(shape: &impl Hittable, at: DVec3, error: f64) -> bool {
    let dir = shape.normal(at);
    // Twice the error, so that a surface at the error itself lies inside the range; and the rounding of the new origin.
    let half_length = 2.0 * error + ROUNDING * at.abs().max_element();
    let ray = Ray { origin: at - half_length * dir, dir };
    shape.distance(&ray, &RayRange { far: 2.0 * half_length, ..RayRange::ALL }) < MISS
}
