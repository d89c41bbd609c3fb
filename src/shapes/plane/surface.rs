//! A plane, and its crossings in plain arithmetic.

use super::products::{MIN_TOWARD, Products, RECIPROCAL_ERROR, reciprocal};
use glam::DVec3;
use std::marker::PhantomData;
use tabray_exact::double_double::{DoubleDouble, scaled};
use tabray_exact::scalar::{Scalar, dot, per_axis};
use tabray_world::certify::Equation;
use tabray_world::geometry::aabb::{Aabb, SLACK, larger};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange};

/// A z beyond all hits, in world units. Its products with differences of coordinates are finite.
const NO_END: f64 = 1e200;

/// An infinite plane. Its type selects the accuracy of crossings.
#[derive(Clone, Copy, Debug)]
pub struct Plane<A> {
    /// The unit normal, rounded. It points to the lit side.
    pub normal: DVec3,
    /// The normal of the scene, scaled by a power of two to a largest component between 1/2 and 1.
    pub upright: [DoubleDouble; 3],
    /// A point of the plane, in world coordinates.
    pub point: DVec3,
    /// Whether the normal is along an axis. Each dot product with it then has one term, and nothing cancels.
    pub is_upright: bool,
    /// The z, in world units, at which the plane ends: on the viewer's side of the image plane (the course notes'
    /// "wrong side").
    pub max_z: f64,
    accuracy: PhantomData<A>,
}

/// A ray's crossing of a plane in plain arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct RoughCrossing {
    /// The distance along the ray, in world units.
    pub distance: f64,
    /// A bound of the distance's error, in world units, or infinity if the ray is parallel up to rounding.
    pub error: f64,
    /// A bound of the distance between points at the same distance along this ray and along the rays that it stands
    /// for.
    pub aside: f64,
    /// Whether the ray is parallel to the plane.
    pub is_parallel: bool,
}

impl<A> Plane<A> {
    /// Returns the plane through a point with a normal of any length.
    pub fn with_normal(normal: DVec3, point: DVec3) -> Self {
        let normal = scaled(normal);
        Self::new(normal.normalize(), normal.to_array().map(DoubleDouble::from), point)
    }

    /// Returns the plane through a point with a rounded unit normal, and a vector along the normal in the best known
    /// precision.
    #[inline(always)]
    pub fn new(normal: DVec3, upright: [DoubleDouble; 3], point: DVec3) -> Self {
        let is_upright = upright.iter().filter(|part| part.high == 0.0).count() == 2;
        Self { normal, upright, point, is_upright, max_z: NO_END, accuracy: PhantomData }
    }

    /// Returns the same plane, given by its point nearest to the world's origin if its normal is along an axis. A
    /// distant point in the plane would cost digits.
    pub fn from_nearest_point(self) -> Self {
        let along = |axis: usize| if self.upright[axis].high == 0.0 { 0.0 } else { self.point[axis] };
        let point = if self.is_upright { DVec3::new(along(0), along(1), along(2)) } else { self.point };
        Self { point, ..self }
    }

    /// Returns the plane, ending at a z, in world units, if one is given.
    pub fn up_to(self, max_z: Option<f64>) -> Self {
        Self { max_z: max_z.unwrap_or(NO_END), ..self }
    }

    /// Returns the normal of the scene, times a power of two, without rounding.
    pub fn given_normal<N: Scalar>(&self) -> [N; 3] {
        per_axis(|axis| N::constant(self.upright[axis].high))
    }

    /// Returns whether a point is on the plane to within `error`, in world units, and the rounding error of its
    /// distance from the plane. That is at most 4 EPSILON of the terms: half an ulp each for three operations on each
    /// term, and for the normal.
    #[inline(always)]
    pub fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        let between = self.point - at;
        let size = (self.normal * between).abs().element_sum();
        self.normal.dot(between).abs() <= error + 4.0 * f64::EPSILON * size
    }

    /// Computes the crossing with an error of a few ulps, and bounds. These include the error of the ray's origin, and
    /// the crossings of all rays that `ray` stands for.
    ///
    /// In units of 2^-53: the relative error between the normal's components is 1, that of the vector between the
    /// points 1, of a product 1, and of a sum of three 2. The error of `away` is thus 5 times its size, and that of
    /// `toward` 4 times. A camera ray's direction adds 5, because the error of each component is 3, and these add up to
    /// at most 1.74. As `toward` is more than 3 times its error of 9, this becomes at most 14 in the quotient, less
    /// than the 16 here. For a ray exactly along the plane, the reciprocal is infinite or NaN, and so are the results.
    ///
    /// A drift changes `away` by at most the drift of the origin, and `toward` by at most that of the direction.
    /// `toward` is more than 3 times that drift, too, which less than doubles it in the quotient.
    #[inline(always)]
    pub fn rough_crossing(&self, ray: &RayBall, origin_error: f64) -> RoughCrossing {
        let Products { away, away_size, toward, .. } = self.products(self.normal, ray);
        let inverse = reciprocal(toward);
        let distance = away * inverse;
        // The reciprocal's own error is relative to the distance, which is at most `away_size` times the reciprocal.
        const ERROR: f64 = RECIPROCAL_ERROR + 8.0 * f64::EPSILON;
        let error = inverse.abs() * (ERROR * (away_size + distance.abs()) + origin_error);
        // For a normal along an axis, `toward` is one component of the direction, and nothing cancels.
        let is_parallel = (toward == 0.0) & self.is_upright;
        if ray.is_single() {
            let error = if inverse.abs() >= MIN_TOWARD.recip() { f64::INFINITY } else { error };
            return RoughCrossing { distance, error, aside: 0.0, is_parallel };
        }
        let RayError { origin, dir } = ray.drift;
        let aside = origin + distance.abs() * dir;
        let is_steep = inverse.abs() * (MIN_TOWARD + 4.0 * dir) < 1.0;
        let error = if is_steep { error + 2.0 * inverse.abs() * aside } else { f64::INFINITY };
        RoughCrossing { distance, error, aside, is_parallel: false }
    }

    /// Computes the dot products with a normal of any length.
    #[inline(always)]
    pub(super) fn products(&self, normal: DVec3, ray: &Ray) -> Products {
        let between = self.point - ray.origin;
        let size = |of: DVec3| (normal * of).abs().element_sum();
        Products {
            away: normal.dot(between),
            away_size: size(between),
            toward: normal.dot(ray.dir),
            toward_size: size(ray.dir),
        }
    }

    /// Returns the normal of the scene, rounded.
    #[inline(always)]
    pub(super) fn rounded_normal(&self) -> DVec3 {
        DVec3::new(self.upright[0].high, self.upright[1].high, self.upright[2].high)
    }

    /// Returns bounds of the distance of a crossing in a range.
    #[inline(always)]
    pub fn t_bounds(&self, rough: &RoughCrossing, ray: &Ray, range: &RayRange) -> Bracket {
        let RoughCrossing { distance, error, aside, is_parallel } = *rough;
        let (low, high) = (distance - error, distance + error);
        let z = ray.origin.z + distance * ray.dir.z;
        // The error of z comes from the distance and from the sum. The error of the product is far less than a
        // reciprocal's.
        let z_error = error + aside + 4.0 * f64::EPSILON * ray.origin.z.abs();
        // If the error is infinite or the distance is NaN, only `is_parallel` can be true: neither a hit nor a miss is
        // certain.
        let is_missed = is_parallel | (high <= range.near) | (z - z_error > self.max_z);
        let is_there = (low > range.near) & (z + z_error < self.max_z);
        Bracket {
            near: if is_missed { MISS } else { larger(low, range.near) },
            far: if is_there { high } else { MISS },
        }
    }

    /// Returns whether the plane certainly misses a region.
    #[inline(always)]
    pub fn is_clear_of(&self, region: &Aabb) -> bool {
        // The signed distances of the region's nearest and farthest corners from the plane, and the sizes of their
        // terms.
        let (mut nearest, mut near_size, mut farthest, mut far_size) = (0.0, 0.0, 0.0, 0.0);
        for axis in 0..3 {
            let (normal, point) = (self.normal[axis], self.point[axis]);
            // Regions may be infinite along an axis, which does not matter if the plane is parallel to the axis.
            if normal != 0.0 {
                let low = normal * (region.low[axis] - point);
                let high = normal * (region.high[axis] - point);
                let (near, far) = if normal > 0.0 { (low, high) } else { (high, low) };
                let size = 2.0 * (normal * point).abs();
                nearest += near;
                near_size += near.abs() + size;
                farthest += far;
                far_size += far.abs() + size;
            }
        }
        nearest > SLACK * near_size || farthest < -SLACK * far_size
    }
}

impl<A> Equation for Plane<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        dot(self.given_normal(), per_axis(|axis| at[axis] - N::constant(self.point[axis])))
    }

    fn inside_trim<N: Scalar>(&self, [_, _, z]: [N; 3]) -> N {
        N::constant(self.max_z) - z
    }
}
