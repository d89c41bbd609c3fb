//! Where a ray crosses a plane: the arithmetic behind planes and what is cut out of them.
//!
//! The notes' form subtracts two numbers that grow with the distance from the world's origin, and takes a ray for
//! parallel where the product is 0, which rounding hardly ever leaves it. Here the ray's origin is subtracted first,
//! and where a sum of products cancels it is computed with what rounding took from each (Ogita, Rump and Oishi 2005);
//! where even that is not enough, without rounding. A distance does not depend on how long the normal is, so it
//! comes from the scene's own one, not from the unit vector that rounding makes of it.

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

/// On the viewer's side of the screen there are no planes (the notes' "wrong side").
const SCREEN: f64 = 0.01;

/// How the notes compute crossings, in a few words.
pub const CLASSIC_METHOD: &str = "the notes' formula";

/// An infinite plane, crossed as exactly as its type has it.
#[derive(Clone, Copy, Debug)]
pub struct Plane<A> {
    /// The unit vector that stands on its lit side, rounded.
    pub normal: DVec3,
    /// The same direction as the scene has it: a vector whose greatest component is between 1/2 and 1.
    pub upright: [DoubleDouble; 3],
    /// A point of it.
    pub point: DVec3,
    /// Whether an axis stands upright on it: a sum of products has one part then, and nothing cancels.
    pub is_upright: bool,
    accuracy: PhantomData<A>,
}

/// Where a ray crosses a plane, as far as it is known quickly.
#[derive(Clone, Copy, Debug)]
pub struct Rough {
    /// The distance.
    pub distance: f64,
    /// How far off that is at most; without end where the ray is parallel but for rounding.
    pub error: f64,
    /// Whether the ray runs along the plane.
    pub is_parallel: bool,
}

/// The products whose quotient is a crossing's distance, in plain arithmetic.
struct Products {
    /// Of the normal and the way from the ray's origin to the plane's point, and how large the parts of that sum are.
    away: f64,
    away_size: f64,
    /// Of the normal and the ray's direction, likewise.
    toward: f64,
    toward_size: f64,
}

impl<A> Plane<A> {
    /// The plane through a point with a normal of any length.
    pub fn with_normal(normal: DVec3, point: DVec3) -> Self {
        let exponent = exponent_to_one(normal.abs().max_element());
        let upright = normal.to_array().map(|part| DoubleDouble::from(times_power_of_two(part, exponent)));
        Self::new(normal.normalize(), upright, point)
    }

    /// The plane through a point with a unit normal, rounded, and the same direction as exactly as it is known.
    pub fn new(normal: DVec3, upright: [DoubleDouble; 3], point: DVec3) -> Self {
        let is_upright = upright.iter().filter(|part| part.high == 0.0).count() == 2;
        Self { normal, upright, point, is_upright, accuracy: PhantomData }
    }

    /// The normal that the scene gives, but for a power of two: exactly, as nothing of it was rounded.
    pub fn given_normal<N: Scalar>(&self) -> [N; 3] {
        self.upright.map(|part| N::constant(part.high))
    }

    /// Whether a ray crosses it on the viewer's side of the screen: where z, which is the origin's and
    /// `away / toward` of the direction's, is beyond it.
    #[inline(never)]
    fn is_before_the_screen(&self, ray: &Ray) -> bool {
        let (away, toward) = self.exact_products(ray);
        let (one, other) =
            (DoubleDouble::difference(ray.origin.z, SCREEN) * toward, away * DoubleDouble::from(ray.dir.z));
        let beyond = (one + other).high * toward.high.signum();
        // DoubleDouble products and sums are off by 2^-103 of their parts; what is as near as that is on the screen itself.
        beyond > 2_f64.powi(-98) * (one.high.abs() + other.high.abs())
    }

    /// Whether a point lies on it, but for an error and what rounding makes of how far off it is: half a unit in the last
    /// place for each of three operations in each part of that sum, and of the normal.
    #[inline(always)]
    pub fn touches(&self, at: DVec3, error: f64) -> bool {
        let between = self.point - at;
        let size = (self.normal * between).abs().element_sum();
        self.normal.dot(between).abs() <= error + 4.0 * f64::EPSILON * size
    }

    /// The crossing but for a few of its last places, and what rounding may make of it, the ray's origin included.
    ///
    /// Units of 2^-53: the normal's components are off by 1 against each other, what is between the points by 1, a
    /// product by 1 and the sum of three by 2, so that `away` is off by 5 of its size and `toward` by 4; by 5 more
    /// because a camera's direction is off by 3 in each component, which is one of a vector of at most 1.74 in sum.
    /// That `toward` is more than 3 times its error makes 14 of the quotient's 9, less than the 16 here. Where the ray runs
    /// along the plane exactly, the reciprocal is no number, and neither are these.
    #[inline(always)]
    pub fn rough(&self, ray: &Ray, origin_error: f64) -> Rough {
        let Products { away, away_size, toward, .. } = self.products(self.normal, ray);
        let inverse = reciprocal(toward);
        let distance = away * inverse;
        // The reciprocal's own error is a part of the distance, which is no larger than `away_size` times it.
        const ERROR: f64 = RECIPROCAL_ERROR + 8.0 * f64::EPSILON;
        let error = inverse.abs() * (ERROR * (away_size + distance.abs()) + origin_error);
        // Upright on an axis, it is one component of the direction, and nothing that cancels.
        let is_parallel = (toward == 0.0) & self.is_upright;
        let error = if inverse.abs() >= LEAST_TOWARD.recip() { f64::INFINITY } else { error };
        Rough { distance, error, is_parallel }
    }

    /// The products with a normal of some length.
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

    /// The scene's normal, rounded.
    #[inline(always)]
    fn high(&self) -> DVec3 {
        DVec3::new(self.upright[0].high, self.upright[1].high, self.upright[2].high)
    }

    /// Between which distances a crossing within a span is.
    #[inline(always)]
    pub fn t_bounds(&self, rough: &Rough, ray: &Ray, range: &RayRange) -> Bracket {
        let Rough { distance, error, is_parallel } = *rough;
        let (low, high) = (distance - error, distance + error);
        let z = ray.origin.z + distance * ray.dir.z;
        // Of z; that of the product in it is far less than a reciprocal's.
        let z_error = error + 4.0 * f64::EPSILON * ray.origin.z.abs();
        // Where the error has no end, or the distance is no number, none of these is so but that it is parallel. What is
        // there is not missed.
        let is_missed = is_parallel | (high <= range.near) | (z - z_error > SCREEN);
        let is_there = (low > range.near) & (z + z_error < SCREEN);
        Bracket {
            near: if is_missed { MISS } else { larger(low, range.near) },
            far: if is_there { high } else { MISS },
        }
    }

    /// Whether it does not come into a region.
    #[inline(always)]
    pub fn is_clear_of(&self, region: &Aabb) -> bool {
        // How far the region's nearest and farthest corners are in front of it, and the sizes of what adds up to that.
        let (mut nearest, mut near_size, mut farthest, mut far_size) = (0.0, 0.0, 0.0, 0.0);
        for axis in 0..3 {
            let (normal, point) = (self.normal[axis], self.point[axis]);
            // Regions may be without an end, which is no matter where the plane is.
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

    /// The product of the normal and the way to the plane, but for a few units in the last place and for
    /// 2^-102 of the size of its parts.
    #[inline(always)]
    fn fine_away(&self, ray: &Ray) -> f64 {
        let (x, x_low) = two_sum(self.point.x, -ray.origin.x);
        let (y, y_low) = two_sum(self.point.y, -ray.origin.y);
        let (z, z_low) = two_sum(self.point.z, -ray.origin.z);
        dot(self.high().to_array(), [x, y, z], [x_low, y_low, z_low], self.rest([x, y, z]))
    }

    /// Likewise of the normal and the ray's direction.
    #[inline(always)]
    fn fine_toward(&self, ray: &Ray) -> f64 {
        dot(self.high().to_array(), ray.dir.to_array(), [0.0; 3], self.rest(ray.dir.to_array()))
    }

    /// The product of a vector and what rounding took from the normal: 0 but for triangles.
    #[inline(always)]
    fn rest(&self, of: [f64; 3]) -> f64 {
        self.upright[0].low * of[0] + self.upright[1].low * of[1] + self.upright[2].low * of[2]
    }

    /// Both products, each rounded once however much cancels: 0 only where they are.
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

    /// As [`crossing`](Self::crossing), in twice the precision.
    #[inline(never)]
    pub fn exact_crossing(&self, ray: &Ray) -> DoubleDouble {
        let (away, toward) = self.exact_products(ray);
        if toward.high == 0.0 { MISS.into() } else { away / toward }
    }
}

impl<A: Bounded> Plane<A> {
    /// The distance at which a ray crosses it, forward or backward; [`MISS`] for one that runs along it.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        let quick = self.quick_crossing(ray);
        if quick.is_nan() { self.exact_crossing(ray).high } else { quick }
    }

    /// As [`crossing`](Self::crossing), or NaN where it takes more than plain arithmetic.
    #[inline(always)]
    pub fn quick_crossing(&self, ray: &Ray) -> f64 {
        match A::ACCURACY {
            Accuracy::Draft => self.products(self.high(), ray).draft_distance(),
            Accuracy::Exact => {
                let products = self.products(self.high(), ray);
                let away = if products.away_cancels() { self.fine_away(ray) } else { products.away };
                let toward = if products.toward_cancels() { self.fine_toward(ray) } else { products.toward };
                products.quotient(away, toward)
            }
            _ => f64::NAN,
        }
    }

    /// What [`quick_crossing`](Self::quick_crossing) gives for each ray of a packet: where nothing cancels.
    #[inline(always)]
    fn refine_plain(&self, rays: RayPacket, out: &mut [f64]) {
        let rays = rays.first(out.len());
        for lane in 0..out.len() {
            out[lane] = self.products(self.high(), &rays.get(lane)).draft_distance();
        }
    }

    /// The same where something may: a sum is computed in both ways if it cancels for any of eight rays.
    #[inline(always)]
    fn refine_compensated(&self, rays: RayPacket, out: &mut [f64]) {
        for first in (0..out.len()).step_by(LANES) {
            let (rays, out) = (rays.part(first..first + LANES), &mut out[first..first + LANES]);
            let (mut away, mut toward) = ([0.0; LANES], [0.0; LANES]);
            let (mut away_size, mut toward_size) = ([0.0; LANES], [0.0; LANES]);
            let (mut away_cancels, mut toward_cancels) = ([0; LANES], [0; LANES]);
            for lane in 0..LANES {
                let products = self.products(self.high(), &rays.get(lane));
                (away[lane], toward[lane]) = (products.away, products.toward);
                (away_size[lane], toward_size[lane]) = (products.away_size, products.toward_size);
                away_cancels[lane] = u64::from(products.away_cancels());
                toward_cancels[lane] = u64::from(products.toward_cancels());
            }
            if away_cancels != [0; LANES] {
                for lane in 0..LANES {
                    let fine = self.fine_away(&rays.get(lane));
                    away[lane] = if away_cancels[lane] != 0 { fine } else { away[lane] };
                }
            }
            if toward_cancels != [0; LANES] {
                for lane in 0..LANES {
                    let fine = self.fine_toward(&rays.get(lane));
                    toward[lane] = if toward_cancels[lane] != 0 { fine } else { toward[lane] };
                }
            }
            for lane in 0..LANES {
                out[lane] = quotient((away[lane], away_size[lane]), (toward[lane], toward_size[lane]));
            }
        }
    }

    /// How a crossing is computed, in a few words.
    pub fn method(&self) -> &'static str {
        match A::ACCURACY {
            Accuracy::Draft => "plain arithmetic",
            Accuracy::Exact => "plain arithmetic, compensated for rounding where sums cancel",
            _ => "twice the precision",
        }
    }

    /// The distance within a span; none on the viewer's side of the screen, and none for a ray that leaves it.
    #[inline(always)]
    pub fn keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        let quick = self.quick_keep(distance, ray, range);
        if !quick.is_nan() {
            quick
        } else if self.is_before_the_screen(ray) {
            MISS
        } else {
            range.keep(distance)
        }
    }

    /// As [`keep`](Self::keep), or NaN where the point is on the screen but for rounding, and of NaN.
    #[inline(always)]
    pub fn quick_keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        let z = ray.at(distance).z;
        // Of 2^-53: a plain product is off by 5 of parts that add up to at most 1.3 times it, so that the distance is
        // off by 14, and the product and the sum here are by 1 each.
        let error = match A::ACCURACY {
            Accuracy::Draft => DRAFT_ERROR * (distance * ray.dir.z).abs() + f64::EPSILON * SCREEN,
            _ => 8.0 * f64::EPSILON * ((distance * ray.dir.z).abs() + SCREEN),
        };
        let origin_side = range.origin_side.is_some();
        let kept = if (z > SCREEN) | origin_side { MISS } else { range.keep(distance) };
        let is_doubtful = ((z - SCREEN).abs() <= error) & (distance < MISS);
        if (is_doubtful | distance.is_nan()) & !origin_side { f64::NAN } else { kept }
    }
}

/// A bracketed shape that is a part of a plane, or all of it.
pub trait Flat: Bracketed {
    /// How exactly that is crossed.
    type Accuracy: Bounded;

    /// The plane.
    fn flat(&self) -> &Plane<Self::Accuracy>;
}

/// Found by its brackets, and refined by its plane for eight rays at a time.
pub struct ByPlane;

impl<T: Flat> Shape<T> {
    /// Found by its brackets, and refined by its plane.
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

    /// A hit that is certain is in the plane, whatever is cut out of that.
    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, _sides: Option<&[Side]>, out: &mut [f64]) {
        let plane = *self.shape.flat();
        match T::Accuracy::ACCURACY {
            // Upright on an axis, sums have one part, and nothing cancels.
            Accuracy::Exact if !plane.is_upright => plane.refine_compensated(rays, out),
            Accuracy::Exact | Accuracy::Draft => plane.refine_plain(rays, out),
            _ => out.fill(f64::NAN),
        }
    }
}

impl Plane<Classic> {
    /// The distance at which a ray crosses it, forward or backward; [`MISS`] for one that runs along it.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        let toward = self.normal.dot(ray.dir);
        let away = self.normal.dot(self.point) - self.normal.dot(ray.origin);
        // Both are 0 for a ray in the plane.
        if toward == 0.0 { MISS } else { away / toward }
    }

    /// The distance within a span; none on the viewer's side of the screen, and none for a ray that leaves it.
    #[inline(always)]
    pub fn keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        let is_cut_off = (ray.at(distance).z > SCREEN) | range.origin_side.is_some();
        if is_cut_off { MISS } else { range.keep(distance) }
    }
}

/// The quotient of two products that [`dot`] has computed, each with the size of its parts; [`MISS`] where the second
/// is 0, and NaN where one is less than 2^-44 of its parts: then it could be off by more than half a unit in its last
/// place, or have another sign.
#[inline(always)]
fn quotient((away, away_size): (f64, f64), (toward, toward_size): (f64, f64)) -> f64 {
    const MOST: f64 = (1_u64 << 44) as f64;
    let is_doubtful = (away_size > MOST * away.abs()) | (toward_size > MOST * toward.abs());
    let distance = if toward == 0.0 { MISS } else { away / toward };
    if is_doubtful { f64::NAN } else { distance }
}

impl Products {
    /// [`quotient`] of better products.
    #[inline(always)]
    fn quotient(&self, away: f64, toward: f64) -> f64 {
        quotient((away, self.away_size), (toward, self.toward_size))
    }

    /// The quotient of plain products, off by at most [`DRAFT_ERROR`]; NaN where one is less than 1/64 of its parts.
    #[inline(always)]
    fn draft_distance(&self) -> f64 {
        const MOST: f64 = 64.0;
        let is_doubtful =
            (self.away_size > MOST * self.away.abs()) | (self.toward_size > MOST * self.toward.abs());
        let distance = if self.toward == 0.0 { MISS } else { self.away / self.toward };
        if is_doubtful { f64::NAN } else { distance }
    }

    /// Whether so much cancels in a sum that it should be computed better.
    #[inline(always)]
    fn away_cancels(&self) -> bool {
        self.away_size > 1.3 * self.away.abs()
    }

    /// Likewise.
    #[inline(always)]
    fn toward_cancels(&self) -> bool {
        self.toward_size > 1.3 * self.toward.abs()
    }
}

/// What a plain quotient of products may be off, as a part of it: each of them is off by 5 units of 2^-53 of parts that
/// add up to at most 64 times it.
pub const DRAFT_ERROR: f64 = 512.0 * f64::EPSILON;

/// A ray that comes no faster toward a plane, as a part of its way, runs along it but for rounding.
const LEAST_TOWARD: f64 = 17.0 * f64::EPSILON;

/// What a [`reciprocal`] may be off, as a part of it: twice the square of what it starts with.
const RECIPROCAL_ERROR: f64 = 1.0 / (1_u64 << 44) as f64;

/// The reciprocal of a number that single precision holds, but for a few of its last places: a step of Newton's method
/// from there, which takes a third of the time of a division.
#[inline(always)]
fn reciprocal(of: f64) -> f64 {
    let start = f64::from(1.0 / of as f32);
    start * (2.0 - of * start)
}
