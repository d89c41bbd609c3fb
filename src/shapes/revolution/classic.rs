//! The course notes' method for surfaces of revolution, which loses some hits.

use glam::DVec3;
use tabray_exact::formula::written::Obstacle;
use tabray_exact::interval::Interval;
use tabray_exact::roots::bisection::bisect;
use tabray_exact::scalar::Scalar;
use tabray_world::certify::Equation;
use tabray_world::geometry::ray::{MISS, Ray, RayRange};
use tabray_world::scene::profile::ProfileLine;

/// A surface of revolution around the y axis, with the hits of the course notes' program.
pub struct ClassicRevolution {
    /// The profile that is revolved.
    pub line: ProfileLine,
    /// The height of the surface, in world units.
    pub height: f64,
}

impl ClassicRevolution {
    /// Returns the distance of a ray's hit by bisection to 1e-4 world units, between the ray's origin and its point
    /// closest to the axis. Grazing rays and the inner wall are lost.
    pub fn first_hit(&self, ray: &Ray, range: &RayRange) -> f64 {
        let outside = |at: DVec3| {
            let radius = self.line.radius.at(at.y);
            at.x * at.x - radius * radius + at.z * at.z
        };
        let closest = -(ray.origin.x * ray.dir.x + ray.origin.z * ray.dir.z)
            / (ray.dir.x * ray.dir.x + ray.dir.z * ray.dir.z);
        let at_origin = outside(ray.origin);
        if closest.is_nan() || closest <= 0.0 || at_origin * outside(ray.at(closest)) >= 0.0 {
            return MISS;
        }
        let is_across = |along: f64| at_origin * outside(ray.at(along)) < 0.0;
        let (near, far) = bisect(is_across, (0.0, closest), 1e-4);
        let distance = (near + far) / 2.0;
        let height = ray.at(distance).y;
        if (0.0..=self.height).contains(&height) { range.keep(distance) } else { MISS }
    }

    /// Returns the unit normal at a point of the surface, away from the axis.
    pub fn normal(&self, at: DVec3) -> DVec3 {
        let downhill = -self.line.radius.at(at.y) * self.line.slope_at(at.y);
        DVec3::new(2.0 * at.x, 2.0 * downhill, 2.0 * at.z).normalize()
    }
}

/// The surface that the course notes define, which differs from the hits of their program.
impl Equation for ClassicRevolution {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        x.powi(2) + z.powi(2) - self.line.radius.squared().at(y)
    }

    fn obstacle(&self, [_, y, _]: [Interval; 3]) -> Option<Obstacle> {
        Some(self.line.radius.obstacle(&[y]))
    }

    fn cost(&self) -> usize {
        self.line.radius.cost() as usize
    }

    fn inside_trim<N: Scalar>(&self, [_, y, _]: [N; 3]) -> N {
        y.min(N::constant(self.height) - y)
    }

    fn extent(&self) -> [DVec3; 2] {
        let widest = self.line.radius.at(Interval { low: 0.0, high: self.height }).magnitude();
        [DVec3::new(-widest, 0.0, -widest), DVec3::new(widest, self.height, widest)]
    }
}
