//! A rectangle as a shape: its hits for rays, packets and proofs.

use super::rectangle::{FinitePlane, Rectangle, along_sides};
use glam::{DVec2, DVec3};
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{Scalar, constants, per_axis};
use tabray_world::accuracy::{AccuracyTag, NotClassic};
use tabray_world::certify::Equation;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::hittable::{Bracketed, Certified, Facts, Hittable};
use tabray_world::luminous::Luminous;
use tabray_world::panel::Panel;

impl<A: AccuracyTag> Hittable for FinitePlane<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let distance = self.plane.keep(self.plane.crossing(ray), ray, range);
        if self.has_crossing(ray, distance) { distance } else { MISS }
    }

    #[inline]
    fn normal(&self, _at: DVec3) -> DVec3 {
        self.plane.normal
    }

    #[inline]
    fn facts(&self) -> Facts {
        let (bounds, max_coordinate) = (Some(self.rectangle.around()), self.reach);
        Facts { bounds, max_coordinate, ..self.plane.facts() }
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(self.rectangle.coordinates(at) / self.rectangle.dimensions)
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.plane.is_clear_of(region) || !self.rectangle.around().overlaps(region)
    }

    fn luminous(&self) -> Option<Luminous> {
        let Rectangle { corner, dimensions, sides } = self.rectangle;
        let half = [0.5 * dimensions.x * sides[0], 0.5 * dimensions.y * sides[1]];
        Some(Luminous::Panel(Panel { middle: corner + half[0] + half[1], half, is_round: false }))
    }

    fn method(&self) -> String {
        self.plane.method().to_owned()
    }
}

impl<A: NotClassic> Bracketed for FinitePlane<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        FinitePlane::t_bounds(self, ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, _origin_side: Option<Side>) -> f64 {
        // A certain hit lies inside the rectangle.
        self.plane.quick_crossing(ray)
    }

    #[inline(always)]
    fn refine_each(&self, rays: RayPacket, out: &mut [f64]) -> bool {
        self.plane.refine_each(rays, out);
        true
    }
}

impl<A: NotClassic> Certified for FinitePlane<A> {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        // A ray that starts on the plane beside the rectangle does not hit the rectangle either.
        self.plane.is_on_surface(at, error)
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        Some(self.plane.exact_crossing(ray))
    }
}

impl<A> Equation for FinitePlane<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        self.plane.value(at)
    }

    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        let from_corner = per_axis(|axis| at[axis] - Interval::constant(self.rectangle.corner[axis]));
        let [u, v] = along_sides(self.plane.given_normal(), constants(self.given_xdir), from_corner);
        let DVec2 { x, y } = self.rectangle.dimensions;
        Some([u / Interval::constant(x), v / Interval::constant(y)])
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        self.plane.inside_trim(at).min(self.inside_of(at))
    }
}
