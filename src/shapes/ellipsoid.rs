//! Spheres stretched along the axes: the arithmetic behind ellipsoids.

mod hits;

use crate::sphere::{self, SphereLine};
use glam::DVec3;
use std::marker::PhantomData;
use tabray_exact::double_double::{DoubleDouble, exponent_to_one, times_power_of_two};
use tabray_exact::scalar::Scalar;
use tabray_world::accuracy::NotClassic;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::ray::{Bracket, Ray, RayBall, RayError, RayRange};

/// A sphere in a space divided by `scale` around the ellipsoid's centre.
pub struct Ellipsoid<A> {
    /// The centre, in world coordinates.
    pub center: DVec3,
    /// The radius in the divided space.
    pub radius: f64,
    /// The scale factors along the axes.
    pub scale: DVec3,
    /// The reciprocals of `scale`, in double-double arithmetic.
    inverse_scale: [DoubleDouble; 3],
    /// The reciprocal of the smallest component of `scale`.
    largest_inverse_scale: f64,
    accuracy: PhantomData<A>,
}

impl<A> Ellipsoid<A> {
    /// Returns the sphere of this radius, scaled along the axes around its centre.
    pub fn new(center: DVec3, radius: f64, scale: DVec3) -> Self {
        let inverse_scale = scale.to_array().map(|part| {
            // Scaling by a power of two loses no significant digit, and keeps products from overflowing.
            let exponent = exponent_to_one(part);
            let DoubleDouble { high, low } =
                DoubleDouble::from(1.0) / DoubleDouble::from(times_power_of_two(part, exponent));
            let [high, low] = [high, low].map(|digits| times_power_of_two(digits, exponent));
            DoubleDouble { high, low }
        });
        let largest_inverse_scale = 1.0 / scale.min_element();
        Self { center, radius, scale, inverse_scale, largest_inverse_scale, accuracy: PhantomData }
    }

    /// Returns the origin and the direction of a ray in the divided space. The direction is no longer a unit vector, so
    /// distances along the ray are unchanged.
    #[inline(always)]
    pub fn scaled(&self, ray: &Ray) -> (DVec3, DVec3) {
        ((ray.origin - self.center) / self.scale, ray.dir / self.scale)
    }

    /// Returns a ray in the divided space, in double-double arithmetic.
    #[inline(always)]
    pub fn line(&self, ray: &Ray) -> SphereLine {
        SphereLine::scaled(ray, self.center, &self.inverse_scale)
    }

    /// Returns the bounding box.
    pub fn around(&self) -> Aabb {
        let reach = self.radius * self.scale;
        Aabb { low: self.center - reach, high: self.center + reach }
    }

    /// Returns the unit normal at a point of the surface.
    #[inline(always)]
    pub fn unit_normal(&self, at: DVec3) -> DVec3 {
        ((at - self.center) / (self.scale * self.scale)).normalize()
    }

    /// Returns the left side of the equation at a point in world space, which is 0 on the ellipsoid.
    pub fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| {
            ((at[axis] - N::constant(self.center[axis])) / N::constant(self.scale[axis])).powi(2)
        };
        part(0) + part(1) + part(2) - N::constant(self.radius).powi(2)
    }

    /// Tells whether a point with an error of at most `error`, in world units, may lie on the ellipsoid.
    pub fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        // To first order, an error changes the distance from the centre of the divided space by at most the error times
        // the gradient of this distance.
        let from = (at - self.center) / self.scale;
        let gradient = (from / self.scale).length() / from.length();
        sphere::is_on_surface(from, self.radius, error * gradient)
    }
}

impl<A: NotClassic> Ellipsoid<A> {
    /// Returns the ellipsoid, with its scale normalized for the solver.
    pub fn exact(center: DVec3, radius: f64, scale: DVec3) -> Self {
        // Moving a power of two from the scale to the radius only changes the magnitude of the squares, which then do
        // not overflow or underflow as easily.
        let exponent = exponent_to_one(scale.min_element());
        let scale = DVec3::from(scale.to_array().map(|part| times_power_of_two(part, exponent)));
        Self::new(center, times_power_of_two(radius, -exponent), scale)
    }

    /// Returns a bracket of the distance of the first hit, for all rays that `ray` stands for.
    #[inline(always)]
    pub fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        let (from, dir) = self.scaled(ray);
        let (inverse, error) = (1.0 / dir.dot(dir), range.origin_error / self.scale.min_element());
        let spread = self.largest_inverse_scale * inverse.sqrt();
        let RayError { origin, dir: turn } = ray.drift;
        let drift = RayError { origin: origin * self.largest_inverse_scale, dir: turn * spread };
        let spread =
            if ray.is_single() { spread } else { 1.0 + spread + sphere::spread(from, self.radius, drift) };
        sphere::t_bounds(from, dir, inverse, spread, self.radius, range.origin_side, error)
    }
}
