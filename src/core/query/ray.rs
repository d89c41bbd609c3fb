//! Rays whose numbers are exact.

use glam::DVec3;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_world::certify;
use tabray_world::geometry::sight::Sight;

/// A ray whose digits all count: the half-line from a point along a direction, which need not be a unit vector.
#[derive(Clone, Debug)]
pub struct QueryRay {
    sight: Sight,
    /// The t of this ray at t = 1 of the sight, a power of 2; `None` where t counts world units.
    scale: Option<f64>,
    leaves: Option<Start>,
}

/// The surface on which a ray starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Start {
    /// The object, by its index.
    pub object: usize,
    /// The part of the object, as an [`Answer`](super::Answer) names it.
    pub part: usize,
}

impl QueryRay {
    /// Returns the ray from a point along a direction, whose length is the unit of t. `None` where the direction is 0
    /// or any number is not finite.
    pub fn new(origin: DVec3, dir: DVec3) -> Option<Self> {
        if !origin.is_finite() || !dir.is_finite() || dir == DVec3::ZERO {
            return None;
        }
        // The squares of the largest and the smallest numbers of f64 overflow or underflow in plain arithmetic.
        let exponent = libm::ilogb(dir.abs().max_element());
        let scale = libm::scalbn(1.0, exponent.clamp(-1000, 1000));
        let scaled = dir / scale;
        let is_exact = scaled * scale == dir;
        let (dir, scale) = if is_exact { (scaled, scale) } else { (dir, 1.0) };
        Some(Self { sight: Sight::exactly(origin, dir), scale: Some(1.0 / scale), leaves: None })
    }

    /// Returns a camera's ray, along which t is measured in world units.
    pub(super) fn of_camera(sight: Sight) -> Self {
        Self { sight, scale: None, leaves: None }
    }

    /// Returns the ray as one that starts on a surface, at the point nearest to its origin, which is rounded. It does not
    /// hit that surface there. Bounds of its t hold for all starts within the error of its origin.
    #[must_use]
    pub fn leaving(self, start: Start) -> Self {
        Self { leaves: Some(start), ..self }
    }

    /// Returns the surface on which the ray starts, if one is told.
    pub fn leaves(&self) -> Option<Start> {
        self.leaves
    }

    /// Returns a bound on the error of an origin that was computed as a point on a surface, in world units along each axis:
    /// 4 units in the last place of the largest coordinate.
    pub(super) fn origin_error(&self) -> f64 {
        4.0 * f64::EPSILON * self.sight.ray().origin.abs().max_element()
    }

    /// Returns the sight along the ray.
    pub fn sight(&self) -> &Sight {
        &self.sight
    }

    /// Returns bounds of t in the ray's own unit, given bounds in lengths of the sight's direction, rounded outward.
    pub fn t(&self, at: Wide) -> Interval {
        match self.scale {
            None => certify::bounds_in_world_units(at, &self.sight),
            Some(scale) => {
                // A product with a power of 2 is exact: these numbers have exponents to spare.
                let scale = Fraction::of(scale);
                Interval { low: rounded_down(at.low * scale), high: -rounded_down(-(at.high * scale)) }
            }
        }
    }

    /// Returns t in the ray's own unit, given in lengths of the sight's direction, rounded to the nearest.
    pub(super) fn rounded_t(&self, at: Fraction) -> f64 {
        match self.scale {
            None => certify::in_world_units(Wide::point(at), &self.sight).high,
            Some(scale) => (at * Fraction::of(scale)).to_f64(),
        }
    }

    /// Returns t in the ray's own unit at a distance in world units, rounded.
    pub fn t_at(&self, distance: f64) -> f64 {
        match self.scale {
            None => distance,
            Some(scale) => {
                let [x, y, z] = self.sight.line::<f64>().dir;
                // Scaled, so no square overflows.
                let largest = x.abs().max(y.abs()).max(z.abs());
                let length = largest * (DVec3::new(x, y, z) / largest).length();
                distance / length * scale
            }
        }
    }

    /// Returns the point at a distance in world units, rounded.
    pub fn at(&self, distance: f64) -> DVec3 {
        self.sight.ray().at(distance)
    }
}

/// Rounds a number down to an f64.
fn rounded_down(number: Fraction) -> f64 {
    let nearest = number.to_f64();
    if Fraction::of(nearest) > number { nearest.next_down() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ray: &QueryRay, t: f64) -> Interval {
        ray.t(Wide::point(Fraction::of(t)))
    }

    #[test]
    fn t_counts_lengths_of_the_direction_as_it_is_given() {
        for dir in [DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 1e-200, 0.0), DVec3::new(1e250, 1e-30, 5e-324)]
        {
            let ray = QueryRay::new(DVec3::ONE, dir).expect("a ray");
            let inner = ray.sight().line::<f64>().dir;
            let times = dir.max_element() / inner.iter().copied().fold(0.0, f64::max);
            assert_eq!(at(&ray, times), Interval { low: 1.0, high: 1.0 }, "{dir}");
        }
    }

    #[test]
    fn what_is_no_ray_is_none() {
        for dir in [DVec3::ZERO, DVec3::new(f64::NAN, 1.0, 0.0), DVec3::new(f64::INFINITY, 0.0, 0.0)] {
            assert!(QueryRay::new(DVec3::ZERO, dir).is_none(), "{dir}");
        }
        assert!(QueryRay::new(DVec3::new(0.0, f64::NAN, 0.0), DVec3::X).is_none());
    }

    #[test]
    fn bounds_are_rounded_outward() {
        let ray = QueryRay::new(DVec3::ZERO, DVec3::X).expect("a ray");
        let third = Fraction::of(1.0) / Fraction::of(3.0);
        let Interval { low, high } = ray.t(Wide::point(third));
        assert!(Fraction::of(low) < third && third < Fraction::of(high) && low.next_up() == high);
    }
}
