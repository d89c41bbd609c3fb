//! Ray-plane intersection: the arithmetic behind planes and shapes that are cut out of them.
//!
//! The course notes' form subtracts two numbers that grow with the distance from the world's origin, and takes a ray
//! for parallel where the dot product is 0, which it hardly ever is after rounding. Here the ray's origin is subtracted
//! first, a dot product that cancels is computed with compensation for its rounding errors (Ogita, Rump and Oishi
//! 2005), and where that is not enough, it is computed exactly. A distance does not depend on the length of the normal,
//! so it comes from the scene's own normal, not from the rounded unit vector.

use crate::geometry::aabb::{Aabb, SLACK, larger};
use crate::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use crate::geometry::ray_packet::RayPacket;
use crate::numeric::double_double::{
    DoubleDouble, dot, exact_sum, exponent_to_one, times_power_of_two, two_product, two_sum,
};
use crate::numeric::scalar::Scalar;
use crate::simd::soa::LANES;
use crate::world::accuracy::{Accuracy, Bounded, Classic};
use crate::world::hittable::Bracketed;
use crate::world::packets::shape::OneRay;
use crate::world::shape::Shape;
use glam::DVec3;
use std::marker::PhantomData;

/// The z, in world units, beyond which planes are cut off: the viewer's side of the image plane (the course notes'
/// "wrong side").
const MAX_Z: f64 = 0.01;

/// The course notes' method, in a few words.
pub const CLASSIC_METHOD: &str = "the notes' formula";

/// An infinite plane; its type selects the accuracy of intersections.
#[derive(Clone, Copy, Debug)]
pub struct Plane<A> {
    /// The unit normal, rounded; it points to the lit side.
    pub normal: DVec3,
    /// The normal as the scene gives it, scaled by a power of two so that its largest component is between 1/2 and 1.
    pub upright: [DoubleDouble; 3],
    /// A point of the plane, in world coordinates.
    pub point: DVec3,
    /// Whether the normal is along an axis: dot products with it have one term then, and nothing cancels.
    pub is_upright: bool,
    accuracy: PhantomData<A>,
}

/// A ray's intersection with a plane in plain arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct Rough {
    /// The distance along the ray, in world units.
    pub distance: f64,
    /// A bound of the distance's error, in world units; infinite where the ray is parallel to within rounding.
    pub error: f64,
    /// Whether the ray is parallel to the plane.
    pub is_parallel: bool,
}

/// The dot products whose quotient is the distance of an intersection, in plain arithmetic.
struct Products {
    /// The dot product of the normal and the vector from the ray's origin to the plane's point, and the sum of the
    /// absolute values of its terms.
    away: f64,
    away_size: f64,
    /// The dot product of the normal and the ray's direction, and the sum of the absolute values of its terms.
    toward: f64,
    toward_size: f64,
}

impl<A> Plane<A> {
    /// Returns the plane through a point with a normal of any length.
    pub fn with_normal(normal: DVec3, point: DVec3) -> Self {
        let exponent = exponent_to_one(normal.abs().max_element());
        let upright = normal.to_array().map(|part| DoubleDouble::from(times_power_of_two(part, exponent)));
        Self::new(normal.normalize(), upright, point)
    }

    /// Returns the plane through a point with a rounded unit normal, and a vector along the normal as exact as it is
    /// known.
    pub fn new(normal: DVec3, upright: [DoubleDouble; 3], point: DVec3) -> Self {
        let is_upright = upright.iter().filter(|part| part.high == 0.0).count() == 2;
        Self { normal, upright, point, is_upright, accuracy: PhantomData }
    }

    /// Returns the normal that the scene gives, times a power of two, without rounding.
    pub fn given_normal<N: Scalar>(&self) -> [N; 3] {
        self.upright.map(|part| N::constant(part.high))
    }

    /// Returns whether a ray intersects the plane on the viewer's side of the image plane: whether z, which is the
    /// origin's plus `away / toward` of the direction's, is beyond it.
    #[inline(never)]
    fn is_before_image_plane(&self, ray: &Ray) -> bool {
        let (away, toward) = self.exact_products(ray);
        let (one, other) =
            (DoubleDouble::difference(ray.origin.z, MAX_Z) * toward, away * DoubleDouble::from(ray.dir.z));
        let beyond = (one + other).high * toward.high.signum();
        // Double-double products and sums are off by 2^-103 of their terms; an intersection as near as that is on the
        // image plane itself.
        beyond > 2_f64.powi(-98) * (one.high.abs() + other.high.abs())
    }

    /// Returns whether a point is on the plane to within `error` world units and the rounding error of its distance
    /// from the plane, which is at most 4 EPSILON of the terms: half an ulp each for three operations on each term, and
    /// for the normal.
    #[inline(always)]
    pub fn touches(&self, at: DVec3, error: f64) -> bool {
        let between = self.point - at;
        let size = (self.normal * between).abs().element_sum();
        self.normal.dot(between).abs() <= error + 4.0 * f64::EPSILON * size
    }

    /// Computes the intersection to within a few ulps, and a bound of its error, which includes that of the ray's
    /// origin.
    ///
    /// Units of 2^-53: the normal's components are off by 1 against each other, the vector between the points by 1, a
    /// product by 1 and the sum of three by 2, so that `away` is off by 5 of its size and `toward` by 4; by 5 more
    /// because a camera ray's direction is off by 3 in each component, which add up to at most 1.74. As `toward` is
    /// more than 3 times its error of 9, these 9 become at most 14 in the quotient, less than the 16 here. Where the
    /// ray runs exactly along the plane, the reciprocal is infinite or NaN, and so are the results.
    #[inline(always)]
    pub fn rough(&self, ray: &Ray, origin_error: f64) -> Rough {
        let Products { away, away_size, toward, .. } = self.products(self.normal, ray);
        let inverse = reciprocal(toward);
        let distance = away * inverse;
        // The reciprocal's own error is relative to the distance, which is at most `away_size` times the reciprocal.
        const ERROR: f64 = RECIPROCAL_ERROR + 8.0 * f64::EPSILON;
        let error = inverse.abs() * (ERROR * (away_size + distance.abs()) + origin_error);
        // For a normal along an axis, `toward` is one component of the direction, in which nothing cancels.
        let is_parallel = (toward == 0.0) & self.is_upright;
        let error = if inverse.abs() >= MIN_TOWARD.recip() { f64::INFINITY } else { error };
        Rough { distance, error, is_parallel }
    }

    /// Computes the dot products with a normal of any length.
    #[inline(always)]
    fn products(&self, normal: DVec3, ray: &Ray) -> Products {
        let between = self.point - ray.origin;
        let size = |of: DVec3| (normal * of).abs().element_sum();
        Products {
            away: normal.dot(between),
            away_size: size(between),
            toward: normal.dot(ray.dir),
            toward_size: size(ray.dir),
        }
    }

    /// Returns the scene's normal, rounded.
    #[inline(always)]
    fn rounded_normal(&self) -> DVec3 {
        DVec3::new(self.upright[0].high, self.upright[1].high, self.upright[2].high)
    }

    /// Returns bounds of the distance of an intersection in a range.
    #[inline(always)]
    pub fn t_bounds(&self, rough: &Rough, ray: &Ray, range: &RayRange) -> Bracket {
        let Rough { distance, error, is_parallel } = *rough;
        let (low, high) = (distance - error, distance + error);
        let z = ray.origin.z + distance * ray.dir.z;
        // The error of z: that of the distance, and of the sum. The error of the product is far less than a
        // reciprocal's.
        let z_error = error + 4.0 * f64::EPSILON * ray.origin.z.abs();
        // If the error is infinite or the distance is NaN, all of these are false but `is_parallel`: neither a hit nor
        // a miss is certain.
        let is_missed = is_parallel | (high <= range.near) | (z - z_error > MAX_Z);
        let is_there = (low > range.near) & (z + z_error < MAX_Z);
        Bracket {
            near: if is_missed { MISS } else { larger(low, range.near) },
            far: if is_there { high } else { MISS },
        }
    }

    /// Returns whether the plane does not intersect a region.
    #[inline(always)]
    pub fn is_clear_of(&self, region: &Aabb) -> bool {
        // The signed distances of the region's nearest and farthest corners in front of the plane, and the sizes of
        // their terms.
        let (mut nearest, mut near_size, mut farthest, mut far_size) = (0.0, 0.0, 0.0, 0.0);
        for axis in 0..3 {
            let (normal, point) = (self.normal[axis], self.point[axis]);
            // Regions may be infinite along an axis, which is of no matter where the plane is parallel to it.
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

    /// Computes the dot product of the normal and the vector from the ray's origin to the plane, off by a few ulps and
    /// 2^-102 of the size of its terms.
    #[inline(always)]
    fn compensated_away(&self, ray: &Ray) -> f64 {
        let (x, x_low) = two_sum(self.point.x, -ray.origin.x);
        let (y, y_low) = two_sum(self.point.y, -ray.origin.y);
        let (z, z_low) = two_sum(self.point.z, -ray.origin.z);
        dot(self.rounded_normal().to_array(), [x, y, z], [x_low, y_low, z_low], self.normal_error([x, y, z]))
    }

    /// Computes the dot product of the normal and the ray's direction, off by a few ulps and 2^-102 of the size of its
    /// terms.
    #[inline(always)]
    fn compensated_toward(&self, ray: &Ray) -> f64 {
        dot(
            self.rounded_normal().to_array(),
            ray.dir.to_array(),
            [0.0; 3],
            self.normal_error(ray.dir.to_array()),
        )
    }

    /// Computes the dot product of a vector and the rounding error of the normal: 0 except for triangles.
    #[inline(always)]
    fn normal_error(&self, of: [f64; 3]) -> f64 {
        self.upright[0].low * of[0] + self.upright[1].low * of[1] + self.upright[2].low * of[2]
    }

    /// Computes both dot products, each rounded once however much of it cancels: 0 only where they are exactly 0.
    fn exact_products(&self, ray: &Ray) -> (DoubleDouble, DoubleDouble) {
        let product = |of: [DoubleDouble; 3]| {
            exact_sum((0..3).flat_map(|axis| {
                let (one, other) = (self.upright[axis], of[axis]);
                let parts = [(one.high, other.high), (one.high, other.low), (one.low, other.high)];
                let parts =
                    parts.into_iter().flat_map(|(one, other)| <[f64; 2]>::from(two_product(one, other)));
                parts.chain([one.low * other.low])
            }))
        };
        let between = [0, 1, 2].map(|axis| DoubleDouble::difference(self.point[axis], ray.origin[axis]));
        (product(between), product(ray.dir.to_array().map(DoubleDouble::from)))
    }

    /// Returns the distance that [`crossing`](Self::crossing) rounds, as a double-double.
    #[inline(never)]
    pub fn exact_crossing(&self, ray: &Ray) -> DoubleDouble {
        let (away, toward) = self.exact_products(ray);
        if toward.high == 0.0 { MISS.into() } else { away / toward }
    }
}

impl<A: Bounded> Plane<A> {
    /// Returns the distance in world units at which a ray intersects the plane, forward or backward; [`MISS`] for a
    /// parallel ray.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        let quick = self.quick_crossing(ray);
        if quick.is_nan() { self.exact_crossing(ray).high } else { quick }
    }

    /// Returns what [`crossing`](Self::crossing) does, or NaN where that takes more than plain or compensated
    /// arithmetic.
    #[inline(always)]
    pub fn quick_crossing(&self, ray: &Ray) -> f64 {
        match A::ACCURACY {
            Accuracy::Draft => self.products(self.rounded_normal(), ray).draft_distance(),
            Accuracy::Exact => {
                let products = self.products(self.rounded_normal(), ray);
                let away = if products.away_cancels() { self.compensated_away(ray) } else { products.away };
                let toward =
                    if products.toward_cancels() { self.compensated_toward(ray) } else { products.toward };
                products.quotient(away, toward)
            }
            _ => f64::NAN,
        }
    }

    /// Computes [`quick_crossing`](Self::quick_crossing) for each ray of a packet in plain arithmetic.
    #[inline(always)]
    fn refine_plain(&self, rays: RayPacket, out: &mut [f64]) {
        let rays = rays.first(out.len());
        for lane in 0..out.len() {
            out[lane] = self.products(self.rounded_normal(), &rays.get(lane)).draft_distance();
        }
    }

    /// Computes [`quick_crossing`](Self::quick_crossing) for each ray of a packet; a dot product that cancels for any
    /// of eight rays is computed with compensation as well.
    #[inline(always)]
    fn refine_compensated(&self, rays: RayPacket, out: &mut [f64]) {
        for first in (0..out.len()).step_by(LANES) {
            let (rays, out) = (rays.part(first..first + LANES), &mut out[first..first + LANES]);
            let (mut away, mut toward) = ([0.0; LANES], [0.0; LANES]);
            let (mut away_size, mut toward_size) = ([0.0; LANES], [0.0; LANES]);
            let (mut away_cancels, mut toward_cancels) = ([0; LANES], [0; LANES]);
            for lane in 0..LANES {
                let products = self.products(self.rounded_normal(), &rays.get(lane));
                (away[lane], toward[lane]) = (products.away, products.toward);
                (away_size[lane], toward_size[lane]) = (products.away_size, products.toward_size);
                away_cancels[lane] = u64::from(products.away_cancels());
                toward_cancels[lane] = u64::from(products.toward_cancels());
            }
            if away_cancels != [0; LANES] {
                for lane in 0..LANES {
                    let fine = self.compensated_away(&rays.get(lane));
                    away[lane] = if away_cancels[lane] != 0 { fine } else { away[lane] };
                }
            }
            if toward_cancels != [0; LANES] {
                for lane in 0..LANES {
                    let fine = self.compensated_toward(&rays.get(lane));
                    toward[lane] = if toward_cancels[lane] != 0 { fine } else { toward[lane] };
                }
            }
            for lane in 0..LANES {
                out[lane] = quotient((away[lane], away_size[lane]), (toward[lane], toward_size[lane]));
            }
        }
    }

    /// Returns the method of intersection, in a few words.
    pub fn method(&self) -> &'static str {
        match A::ACCURACY {
            Accuracy::Draft => "plain arithmetic",
            Accuracy::Exact => "plain arithmetic, compensated for rounding where sums cancel",
            _ => "twice the precision",
        }
    }

    /// Returns the distance if it is in the range, else [`MISS`]; also [`MISS`] on the viewer's side of the image
    /// plane, and for a ray that leaves the plane.
    #[inline(always)]
    pub fn keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        let quick = self.quick_keep(distance, ray, range);
        if !quick.is_nan() {
            quick
        } else if self.is_before_image_plane(ray) {
            MISS
        } else {
            range.keep(distance)
        }
    }

    /// Returns what [`keep`](Self::keep) does, or NaN where the point is on the image plane to within rounding; NaN for
    /// NaN.
    #[inline(always)]
    pub fn quick_keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        let z = ray.at(distance).z;
        // Units of 2^-53: a plain dot product is off by 5 of terms that add up to at most 1.3 times it, so that the
        // distance is off by 14; the product and the sum here are off by 1 each.
        let error = match A::ACCURACY {
            Accuracy::Draft => DRAFT_ERROR * (distance * ray.dir.z).abs() + f64::EPSILON * MAX_Z,
            _ => 8.0 * f64::EPSILON * ((distance * ray.dir.z).abs() + MAX_Z),
        };
        let origin_side = range.origin_side.is_some();
        let kept = if (z > MAX_Z) | origin_side { MISS } else { range.keep(distance) };
        let is_doubtful = ((z - MAX_Z).abs() <= error) & (distance < MISS);
        if (is_doubtful | distance.is_nan()) & !origin_side { f64::NAN } else { kept }
    }
}

/// A bracketed shape that is all or a part of a plane.
pub trait Flat: Bracketed {
    /// The accuracy of intersections with the plane.
    type Accuracy: Bounded;

    /// Returns the plane.
    fn flat(&self) -> &Plane<Self::Accuracy>;
}

/// The strategy of shapes that are found by their brackets and refined by their plane, eight rays at a time.
pub struct ByPlane;

impl<T: Flat> Shape<T> {
    /// Returns the shape, found by its brackets and refined by its plane.
    pub fn flat(self) -> Shape<T, ByPlane> {
        self.by()
    }
}

impl<T: Flat, P> OneRay for Shape<T, ByPlane, P> {
    type Author = T;

    #[inline(always)]
    fn author(&self) -> &T {
        &self.shape
    }

    #[inline(always)]
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        self.shape.t_bounds(ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.shape.refine(ray, origin_side)
    }

    /// Refines by the plane alone: a hit that is certain is in the plane, whatever is cut out of it.
    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, _sides: Option<&[Side]>, out: &mut [f64]) {
        let plane = *self.shape.flat();
        match T::Accuracy::ACCURACY {
            // With a normal along an axis, dot products have one term, and nothing cancels.
            Accuracy::Exact if !plane.is_upright => plane.refine_compensated(rays, out),
            Accuracy::Exact | Accuracy::Draft => plane.refine_plain(rays, out),
            _ => out.fill(f64::NAN),
        }
    }
}

impl Plane<Classic> {
    /// Returns the distance in world units at which a ray intersects the plane, forward or backward; [`MISS`] for a
    /// parallel ray.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        let toward = self.normal.dot(ray.dir);
        let away = self.normal.dot(self.point) - self.normal.dot(ray.origin);
        // Both are 0 for a ray in the plane.
        if toward == 0.0 { MISS } else { away / toward }
    }

    /// Returns the distance if it is in the range, else [`MISS`]; also [`MISS`] on the viewer's side of the image
    /// plane, and for a ray that leaves the plane.
    #[inline(always)]
    pub fn keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        let is_cut_off = (ray.at(distance).z > MAX_Z) | range.origin_side.is_some();
        if is_cut_off { MISS } else { range.keep(distance) }
    }
}

/// Returns the quotient of two dot products computed by [`dot`], each given with the size of its terms. The result is
/// [`MISS`] where the divisor is 0, and NaN where one of them is less than 2^-44 of its terms: it could then be off by
/// more than half an ulp, or have the other sign.
#[inline(always)]
fn quotient((away, away_size): (f64, f64), (toward, toward_size): (f64, f64)) -> f64 {
    const MAX_RATIO: f64 = (1_u64 << 44) as f64;
    let is_doubtful = (away_size > MAX_RATIO * away.abs()) | (toward_size > MAX_RATIO * toward.abs());
    let distance = if toward == 0.0 { MISS } else { away / toward };
    if is_doubtful { f64::NAN } else { distance }
}

impl Products {
    /// Returns the [`quotient`] of dot products computed with compensation.
    #[inline(always)]
    fn quotient(&self, away: f64, toward: f64) -> f64 {
        quotient((away, self.away_size), (toward, self.toward_size))
    }

    /// Returns the quotient of the plain dot products, off by at most [`DRAFT_ERROR`]; NaN where one is less than 1/64
    /// of its terms.
    #[inline(always)]
    fn draft_distance(&self) -> f64 {
        const MAX_RATIO: f64 = 64.0;
        let is_doubtful = (self.away_size > MAX_RATIO * self.away.abs())
            | (self.toward_size > MAX_RATIO * self.toward.abs());
        let distance = if self.toward == 0.0 { MISS } else { self.away / self.toward };
        if is_doubtful { f64::NAN } else { distance }
    }

    /// Returns whether so much of `away` cancels that it should be computed with compensation.
    #[inline(always)]
    fn away_cancels(&self) -> bool {
        self.away_size > 1.3 * self.away.abs()
    }

    /// Returns whether so much of `toward` cancels that it should be computed with compensation.
    #[inline(always)]
    fn toward_cancels(&self) -> bool {
        self.toward_size > 1.3 * self.toward.abs()
    }
}

/// A bound of the relative error of the quotient of plain dot products: each is off by 5 units of 2^-53 of terms that
/// add up to at most 64 times it, which makes 320 EPSILON for both.
pub const DRAFT_ERROR: f64 = 512.0 * f64::EPSILON;

/// The `toward` below which a ray is parallel to the plane to within rounding: 34 units of 2^-53, more than three times
/// the error of 9 that [`Plane::rough`] derives.
const MIN_TOWARD: f64 = 17.0 * f64::EPSILON;

/// A bound of the relative error of [`reciprocal`]. The initial guess is off by at most 2^-23, two roundings to single
/// precision; a step of Newton's method squares that.
const RECIPROCAL_ERROR: f64 = 1.0 / (1_u64 << 44) as f64;

/// Returns the reciprocal of a number in the range of single precision, to within a few ulps: one step of Newton's
/// method from the reciprocal in single precision, which takes a third of the time of a division.
#[inline(always)]
fn reciprocal(of: f64) -> f64 {
    let start = f64::from(1.0 / of as f32);
    start * (2.0 - of * start)
}
