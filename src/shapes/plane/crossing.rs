//! The distance at which a ray crosses a plane, by the methods of each accuracy.

use super::products::quotient;
use super::surface::Plane;
use tabray_exact::double_double::exact::exact_sum;
use tabray_exact::double_double::{DoubleDouble, dot, power_of_two, two_product, two_sum};
use tabray_exact::scalar::per_axis;
use tabray_world::accuracy::{Accuracy, AccuracyTag};
use tabray_world::geometry::ray::{MISS, Ray, RayRange};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::soa::LANES;

impl<A> Plane<A> {
    /// Returns whether a ray crosses the plane on the viewer's side of the image plane: whether the z of the crossing
    /// is beyond it. This z is the origin's plus `away / toward` times the direction's.
    #[inline(never)]
    fn is_before_image_plane(&self, ray: &Ray) -> bool {
        let (away, toward) = self.exact_products(ray);
        let (one, other) = (
            DoubleDouble::difference(ray.origin.z, self.max_z) * toward,
            away * DoubleDouble::from(ray.dir.z),
        );
        let beyond = (one + other).high * toward.high.signum();
        // The relative error of double-double products and sums is 2^-103. A crossing within that error is on the image
        // plane itself.
        beyond > power_of_two(-98) * (one.high.abs() + other.high.abs())
    }

    /// Computes the dot product of the normal and the vector from the ray's origin to the plane, with an error of a few
    /// ulps plus 2^-102 of the size of its terms.
    #[inline(always)]
    fn compensated_away(&self, ray: &Ray) -> f64 {
        let (x, x_low) = two_sum(self.point.x, -ray.origin.x);
        let (y, y_low) = two_sum(self.point.y, -ray.origin.y);
        let (z, z_low) = two_sum(self.point.z, -ray.origin.z);
        dot(self.rounded_normal().to_array(), [x, y, z], [x_low, y_low, z_low], self.normal_error([x, y, z]))
    }

    /// Computes the dot product of the normal and the ray's direction, with an error of a few ulps plus 2^-102 of the
    /// size of its terms.
    #[inline(always)]
    fn compensated_toward(&self, ray: &Ray) -> f64 {
        dot(
            self.rounded_normal().to_array(),
            ray.dir.to_array(),
            [0.0; 3],
            self.normal_error(ray.dir.to_array()),
        )
    }

    /// Computes the dot product of a vector and the rounding error of the normal, which is 0 except for triangles.
    #[inline(always)]
    fn normal_error(&self, of: [f64; 3]) -> f64 {
        self.upright[0].low * of[0] + self.upright[1].low * of[1] + self.upright[2].low * of[2]
    }

    /// Computes both dot products, each rounded once regardless of cancellation. They are 0 only if they are exactly 0.
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
        let between = per_axis(|axis| DoubleDouble::difference(self.point[axis], ray.origin[axis]));
        (product(between), product(ray.dir.to_array().map(DoubleDouble::from)))
    }

    /// Returns the unrounded distance of [`crossing`](Self::crossing) as a double-double.
    #[inline(never)]
    pub fn exact_crossing(&self, ray: &Ray) -> DoubleDouble {
        let (away, toward) = self.exact_products(ray);
        if toward.high == 0.0 { MISS.into() } else { away / toward }
    }
}

impl<A: AccuracyTag> Plane<A> {
    /// Returns the distance in world units at which a ray crosses the plane, forward or backward, or [`MISS`] for a
    /// parallel ray.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        if A::IS_CLASSIC {
            let toward = self.normal.dot(ray.dir);
            let away = self.normal.dot(self.point) - self.normal.dot(ray.origin);
            // For a ray in the plane, `away` is 0, too.
            return if toward == 0.0 { MISS } else { away / toward };
        }
        let quick = self.quick_crossing(ray);
        if quick.is_nan() { self.exact_crossing(ray).high } else { quick }
    }

    /// Computes [`crossing`](Self::crossing), or NaN if plain and compensated arithmetic are not enough.
    #[inline(always)]
    pub fn quick_crossing(&self, ray: &Ray) -> f64 {
        match A::ACCURACY {
            Accuracy::Draft | Accuracy::Exact => {
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
    pub(super) fn refine_plain(&self, rays: RayPacket, out: &mut [f64]) {
        let rays = rays.first(out.len());
        for lane in 0..out.len() {
            out[lane] = self.products(self.rounded_normal(), &rays.get(lane)).plain_quotient();
        }
    }

    /// Computes [`quick_crossing`](Self::quick_crossing) for each ray of a packet, with compensation where sums cancel.
    #[inline(always)]
    pub(super) fn refine_compensated(&self, rays: RayPacket, out: &mut [f64]) {
        for first in (0..out.len()).step_by(LANES) {
            let eight = first..first + LANES;
            Self::compensated(|_| *self, rays.part(eight.clone()), &mut out[eight]);
        }
    }

    /// Computes [`quick_crossing`](Self::quick_crossing) for eight rays, each with its own plane.
    #[inline(always)]
    pub fn quick_crossings(plane: impl Fn(usize) -> Self, rays: RayPacket, out: &mut [f64; LANES]) {
        match A::ACCURACY {
            Accuracy::Draft | Accuracy::Exact => Self::compensated(plane, rays, out),
            _ => out.fill(f64::NAN),
        }
    }

    /// Computes the distances of eight rays from a plane each. If a dot product cancels for any of them, all are also
    /// computed with compensation.
    #[inline(always)]
    fn compensated(plane: impl Fn(usize) -> Self, rays: RayPacket, out: &mut [f64]) {
        let (rays, out) = (rays.first(LANES), &mut out[..LANES]);
        let (mut away, mut toward) = ([0.0; LANES], [0.0; LANES]);
        let (mut away_size, mut toward_size) = ([0.0; LANES], [0.0; LANES]);
        let (mut away_cancels, mut toward_cancels) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            let plane = plane(lane);
            let products = plane.products(plane.rounded_normal(), &rays.get(lane));
            (away[lane], toward[lane]) = (products.away, products.toward);
            (away_size[lane], toward_size[lane]) = (products.away_size, products.toward_size);
            away_cancels[lane] = u64::from(products.away_cancels());
            toward_cancels[lane] = u64::from(products.toward_cancels());
        }
        if away_cancels != [0; LANES] {
            for lane in 0..LANES {
                let fine = plane(lane).compensated_away(&rays.get(lane));
                away[lane] = if away_cancels[lane] != 0 { fine } else { away[lane] };
            }
        }
        if toward_cancels != [0; LANES] {
            for lane in 0..LANES {
                let fine = plane(lane).compensated_toward(&rays.get(lane));
                toward[lane] = if toward_cancels[lane] != 0 { fine } else { toward[lane] };
            }
        }
        for lane in 0..LANES {
            out[lane] = quotient((away[lane], away_size[lane]), (toward[lane], toward_size[lane]));
        }
    }

    /// Returns a short description of the method.
    pub fn method(&self) -> &'static str {
        match A::ACCURACY {
            Accuracy::Classic => "the notes' formula",
            Accuracy::Draft | Accuracy::Exact => {
                "plain arithmetic, compensated for rounding where sums cancel"
            }
            Accuracy::Strict => "twice the precision",
        }
    }

    /// Returns the distance, or [`MISS`] if it is outside of the range or on the viewer's side of the image plane, or
    /// if the ray leaves the plane.
    #[inline(always)]
    pub fn keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        if A::IS_CLASSIC {
            let is_cut_off = (ray.at(distance).z > self.max_z) | range.origin_side.is_some();
            return if is_cut_off { MISS } else { range.keep(distance) };
        }
        let quick = self.quick_keep(distance, ray, range);
        if !quick.is_nan() {
            quick
        } else if self.is_before_image_plane(ray) {
            MISS
        } else {
            range.keep(distance)
        }
    }

    /// Computes [`keep`](Self::keep), or NaN if the point is on the image plane up to rounding, or if the distance is
    /// NaN.
    #[inline(always)]
    pub fn quick_keep(&self, distance: f64, ray: &Ray, range: &RayRange) -> f64 {
        let z = ray.at(distance).z;
        // In units of 2^-53: the error of a plain dot product is 5 times the sum of its terms, at most 1.3 times the
        // product. The error of the distance is thus 14, and the product and the sum here add 1 each.
        let error = 8.0 * f64::EPSILON * ((distance * ray.dir.z).abs() + self.max_z);
        let origin_side = range.origin_side.is_some();
        let kept = if (z > self.max_z) | origin_side { MISS } else { range.keep(distance) };
        let is_doubtful = ((z - self.max_z).abs() <= error) & (distance < MISS);
        if (is_doubtful | distance.is_nan()) & !origin_side { f64::NAN } else { kept }
    }
}
