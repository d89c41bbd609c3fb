//! Where a ray crosses a plane: the arithmetic behind planes and what is cut out of them.
//!
//! The notes' form subtracts two numbers that grow with the distance from the world's origin, and takes a ray for
//! parallel where the product is 0, which rounding hardly ever leaves it. Here the ray's origin is subtracted first,
//! and where a sum of products cancels it is computed with what rounding took from each (Ogita, Rump and Oishi 2005).

use crate::accuracy::Accuracy;
use crate::bounds::{Bounds, SLACK, larger};
use crate::cpu::{Cpu, kernels};
use crate::geometry::{Bracket, MISS, Ray, Span};
use crate::packet::{self, Rays, STEP};
use crate::twofold::{Twofold, dot, two_sum};
use glam::DVec3;

/// On the viewer's side of the screen there are no planes (the notes' "wrong side").
const SCREEN: f64 = 0.01;

/// An infinite plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// The unit vector that stands on its lit side.
    pub normal: DVec3,
    /// The vector that the scene gives for that, of any length: it is not rounded.
    pub given: DVec3,
    /// A point of it.
    pub point: DVec3,
    /// How exactly it is crossed.
    pub accuracy: Accuracy,
}

/// Where a ray crosses a plane, as far as it is known quickly.
#[derive(Clone, Copy, Debug)]
pub struct Rough {
    /// The distance.
    pub distance: f64,
    /// How far off that is at most.
    pub error: f64,
    /// Whether there is none.
    pub is_parallel: bool,
}

/// The products whose quotient is a crossing's distance, in plain arithmetic.
struct Products {
    /// Of the normal and the way from the ray's origin to the plane's point, and how large the parts of that sum are.
    away: f64,
    away_size: f64,
    /// Of the normal and the ray's direction, likewise; no larger than 1.
    toward: f64,
    toward_size: f64,
}

impl Plane {
    /// The distance at which a ray crosses it, forward or backward; [`MISS`] for one that runs along it.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        match self.accuracy {
            Accuracy::Strict => self.crossing_in_twice_the_precision(ray),
            _ => self.quick_crossing(ray),
        }
    }

    /// As [`crossing`](Self::crossing), or NaN where it takes more than plain arithmetic.
    #[inline(always)]
    pub fn quick_crossing(&self, ray: &Ray) -> f64 {
        match self.accuracy {
            Accuracy::Classic => {
                let toward = self.normal.dot(ray.dir);
                let away = self.normal.dot(self.point) - self.normal.dot(ray.origin);
                if toward == 0.0 { MISS } else { away / toward }
            }
            Accuracy::Draft => self.products(ray).distance(),
            Accuracy::Exact => {
                let products = self.products(ray);
                let away = if products.away_cancels() { self.fine_away(ray) } else { products.away };
                let toward = if products.toward_cancels() { self.fine_toward(ray) } else { products.toward };
                if products.is_parallel() { MISS } else { away / toward }
            }
            Accuracy::Strict => f64::NAN,
        }
    }

    /// The distances of a packet's hits, as [`crossing`](Self::crossing) and [`keep`](Self::keep) have them, or NaN.
    pub fn distances(&self, cpu: Cpu, rays: Rays, out: &mut [f64]) {
        // Upright on an axis, sums have one part, and nothing cancels.
        let is_upright = self.normal.to_array().into_iter().filter(|part| *part != 0.0).count() == 1;
        match self.accuracy {
            Accuracy::Exact if !is_upright => compensated(cpu, self, rays, out),
            Accuracy::Exact | Accuracy::Draft => plain(cpu, self, rays, out),
            _ => packet::distances(cpu, self, rays, None, out),
        }
    }

    /// How a crossing is computed, in a few words.
    pub fn method(&self) -> &'static str {
        match self.accuracy {
            Accuracy::Classic => "the notes' formula",
            Accuracy::Draft => "plain arithmetic",
            Accuracy::Exact => "plain arithmetic, and what rounding takes from it where sums cancel",
            Accuracy::Strict => "twice the precision",
        }
    }

    /// The distance within a span; none on the viewer's side of the screen, and none for a ray that leaves it.
    #[inline(always)]
    pub fn keep(&self, distance: f64, ray: &Ray, within: &Span) -> f64 {
        if within.leaves.is_some() | (ray.at(distance).z > SCREEN) { MISS } else { within.keep(distance) }
    }

    /// Whether a point lies on it, but for an error and what rounding makes of how far off it is: half a unit in the last
    /// place for each of three operations in each part of that sum, and of the normal.
    #[inline(always)]
    pub fn touches(&self, at: DVec3, error: f64) -> bool {
        let between = self.point - at;
        let size = (self.normal * between).abs().element_sum();
        self.normal.dot(between).abs() <= error + 4.0 * f64::EPSILON * size
    }

    /// The crossing in twice the precision, of the plane that the scene gives.
    pub fn fine_crossing(&self, ray: &Ray) -> Twofold {
        crossing(self.given.to_array().map(Twofold::from), self.point, ray)
    }

    /// The crossing but for a few of its last places, and what rounding may make of it, the ray's origin included.
    #[inline(always)]
    pub fn rough(&self, ray: &Ray, origin_error: f64) -> Rough {
        let products = self.products(ray);
        let Products { away, away_size, toward, .. } = products;
        let inverse = reciprocal(toward);
        let distance = away * inverse;
        let error = inverse.abs() * (8.0 * f64::EPSILON * (away_size + distance.abs()) + origin_error);
        let error = error + RECIPROCAL_ERROR * distance.abs();
        Rough { distance, error, is_parallel: products.is_parallel() }
    }

    #[inline(always)]
    fn products(&self, ray: &Ray) -> Products {
        let between = self.point - ray.origin;
        let size = |of: DVec3| (self.normal * of).abs().element_sum();
        Products {
            away: self.normal.dot(between),
            away_size: size(between),
            toward: self.normal.dot(ray.dir),
            toward_size: size(ray.dir),
        }
    }

    /// Between which distances a crossing within a span is.
    #[inline(always)]
    pub fn bracket(&self, rough: &Rough, ray: &Ray, within: &Span) -> Bracket {
        let Rough { distance, error, is_parallel } = *rough;
        let (low, high) = (distance - error, distance + error);
        let z = ray.origin.z + distance * ray.dir.z;
        // Of z; that of the product in it is far less than a reciprocal's.
        let z_error = error + 4.0 * f64::EPSILON * ray.origin.z.abs();
        let is_missed = is_parallel | (high <= within.near) | (z - z_error > SCREEN);
        let is_there = (low > within.near) & (z + z_error < SCREEN);
        Bracket {
            near: if is_missed { MISS } else { larger(low, within.near) },
            far: if is_there & !is_missed { high } else { MISS },
        }
    }

    /// Whether it does not come into a region.
    #[inline(always)]
    pub fn is_clear_of(&self, region: &Bounds) -> bool {
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
        self.accuracy != Accuracy::Classic && (nearest > SLACK * near_size || farthest < -SLACK * far_size)
    }

    /// The product of the normal and the way to the plane to a few units in the last place, whatever cancels.
    #[inline(always)]
    fn fine_away(&self, ray: &Ray) -> f64 {
        let (x, x_low) = two_sum(self.point.x, -ray.origin.x);
        let (y, y_low) = two_sum(self.point.y, -ray.origin.y);
        let (z, z_low) = two_sum(self.point.z, -ray.origin.z);
        dot(self.normal.to_array(), [x, y, z], [x_low, y_low, z_low])
    }

    /// Likewise of the normal and the ray's direction.
    #[inline(always)]
    fn fine_toward(&self, ray: &Ray) -> f64 {
        dot(self.normal.to_array(), ray.dir.to_array(), [0.0; 3])
    }

    fn crossing_in_twice_the_precision(&self, ray: &Ray) -> f64 {
        crossing(self.normal.to_array().map(Twofold::from), self.point, ray).high
    }
}

/// Where a ray crosses the plane through a point that stands upright on a vector, in twice the precision.
pub fn crossing(normal: [Twofold; 3], point: DVec3, ray: &Ray) -> Twofold {
    let product = |of: [Twofold; 3]| normal[0] * of[0] + normal[1] * of[1] + normal[2] * of[2];
    let between = [0, 1, 2].map(|axis| Twofold::difference(point[axis], ray.origin[axis]));
    product(between) / product(ray.dir.to_array().map(Twofold::from))
}

kernels! {
    /// Distances where nothing cancels.
    fn plain(plane: &Plane, rays: Rays, out: &mut [f64]) {
        let (plane, rays) = (*plane, rays.first(out.len()));
        for lane in 0..out.len() {
            let ray = rays.get(lane);
            out[lane] = plane.keep(plane.products(&ray).distance(), &ray, &Span::RAY);
        }
    }

    /// Distances where something may: a sum is computed in both ways if it cancels for any of eight rays.
    fn compensated(plane: &Plane, rays: Rays, out: &mut [f64]) {
        let plane = *plane;
        for first in (0..out.len()).step_by(STEP) {
            let (rays, out) = (rays.part(first..first + STEP), &mut out[first..first + STEP]);
            let (mut away, mut toward, mut is_parallel) = ([0.0; STEP], [0.0; STEP], [0; STEP]);
            let (mut away_cancels, mut toward_cancels) = ([0; STEP], [0; STEP]);
            for lane in 0..STEP {
                let products = plane.products(&rays.get(lane));
                (away[lane], toward[lane]) = (products.away, products.toward);
                away_cancels[lane] = u64::from(products.away_cancels());
                toward_cancels[lane] = u64::from(products.toward_cancels());
                is_parallel[lane] = u64::from(products.is_parallel());
            }
            if away_cancels != [0; STEP] {
                for lane in 0..STEP {
                    let fine = plane.fine_away(&rays.get(lane));
                    away[lane] = if away_cancels[lane] != 0 { fine } else { away[lane] };
                }
            }
            if toward_cancels != [0; STEP] {
                for lane in 0..STEP {
                    let fine = plane.fine_toward(&rays.get(lane));
                    toward[lane] = if toward_cancels[lane] != 0 { fine } else { toward[lane] };
                }
            }
            for lane in 0..STEP {
                let distance = if is_parallel[lane] != 0 { MISS } else { away[lane] / toward[lane] };
                out[lane] = plane.keep(distance, &rays.get(lane), &Span::RAY);
            }
        }
    }
}

impl Products {
    #[inline(always)]
    fn distance(&self) -> f64 {
        if self.is_parallel() { MISS } else { self.away / self.toward }
    }

    /// But for what rounding makes of unit vectors.
    #[inline(always)]
    fn is_parallel(&self) -> bool {
        self.toward.abs() <= 4.0 * f64::EPSILON
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

/// What a [`reciprocal`] may be off, as a part of it: twice the square of what it starts with.
const RECIPROCAL_ERROR: f64 = 1.0 / (1_u64 << 44) as f64;

/// The reciprocal of a number that single precision holds, but for a few of its last places: a step of Newton's method
/// from there, which takes a third of the time of a division.
#[inline(always)]
fn reciprocal(of: f64) -> f64 {
    let start = f64::from(1.0 / of as f32);
    start * (2.0 - of * start)
}
