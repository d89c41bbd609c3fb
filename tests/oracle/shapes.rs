//! Where a ray first meets the shapes that have a formula for it, in [`Twofold`].
//!
//! The numbers are those of a scene's text; a plane's unit normal and sides are what the program makes of them.

use super::{Hit, Truth};
use glam::{DVec2, DVec3};
use tabray::geometry::Ray;
use tabray::number::Number;
use tabray::twofold::Twofold;

type Vector = [Twofold; 3];

/// A plane, or a part of one.
#[derive(Clone, Copy)]
pub struct Plane {
    /// A unit vector that stands upright on it.
    pub normal: DVec3,
    /// A point of it.
    pub point: DVec3,
}

/// How near to the edge of a part of a plane a point is neither in it nor out of it, against the size of the numbers
/// that it was computed from: the hit of a ray is a rounded number, too.
const EDGE: f64 = 8.0 * f64::EPSILON;

impl Plane {
    /// The plane through a point with a normal of any length.
    pub fn new(normal: DVec3, point: DVec3) -> Self {
        Self { normal: normal.normalize(), point }
    }

    /// Where a ray crosses it. On the viewer's side of the screen there are no planes (the notes).
    pub fn first_hit(&self, ray: &Ray) -> Truth {
        const SCREEN: f64 = 0.01;
        let normal = vector(self.normal);
        let toward = dot(normal, vector(ray.dir));
        // A unit vector is not exactly one, nor upright on another.
        if toward.high.abs() <= 8.0 * f64::EPSILON {
            return Truth::Undecided;
        }
        let t = dot(normal, difference(self.point, ray.origin)) / toward;
        if t <= 0.0.into() {
            return Truth::Miss;
        }
        let z = (Twofold::difference(ray.origin.z, SCREEN) + t * ray.dir.z.into()).high;
        if z.abs() <= EDGE * (ray.origin.z.abs() + t.high) {
            Truth::Undecided
        } else if z > 0.0 {
            Truth::Miss
        } else {
            Truth::Hit(Hit { t, slope: toward.high })
        }
    }

    /// As [`first_hit`](Self::first_hit), for the part of it that is left of these edges, each given by a point and
    /// by a vector across it.
    fn part_hit(&self, ray: &Ray, edges: &[(DVec3, DVec3)]) -> Truth {
        let Truth::Hit(hit) = self.first_hit(ray) else { return self.first_hit(ray) };
        let size = ray.origin.abs().max_element() + self.point.abs().max_element() + hit.t.high;
        let inward = |(point, across): &(DVec3, DVec3)| {
            let from_edge = add(difference(ray.origin, *point), times(vector(ray.dir), hit.t));
            (dot(from_edge, vector(*across)).high, EDGE * size * across.length())
        };
        let inward: Vec<_> = edges.iter().map(inward).collect();
        if inward.iter().any(|(depth, edge)| *depth < -edge) {
            Truth::Miss
        } else if inward.iter().any(|(depth, edge)| *depth <= *edge) {
            Truth::Undecided
        } else {
            Truth::Hit(hit)
        }
    }
}

/// A rectangle of these dimensions.
pub fn rectangle(plane: &Plane, xdir: DVec3, dimensions: DVec2, ray: &Ray) -> Truth {
    let x = (xdir - plane.normal.dot(xdir) * plane.normal).normalize();
    let y = plane.normal.cross(x);
    let corner = plane.point;
    let opposite = corner + dimensions.x * x + dimensions.y * y;
    plane.part_hit(ray, &[(corner, x), (corner, y), (opposite, -x), (opposite, -y)])
}

/// A triangle.
pub fn triangle([a, b, c]: [DVec3; 3], ray: &Ray) -> Truth {
    let plane = Plane::new((b - a).cross(c - a), a);
    let edge = |from: DVec3, to: DVec3| (from, plane.normal.cross(to - from));
    plane.part_hit(ray, &[edge(a, b), edge(b, c), edge(c, a)])
}

/// A sphere stretched along the axes, as far as it is farther than `near`: rays that start inside meet its far wall.
pub fn ellipsoid(center: DVec3, radius: f64, scale: DVec3, ray: &Ray, near: f64) -> Truth {
    let squeezed = |vector: Vector| {
        let scale = scale.to_array();
        std::array::from_fn(|axis| vector[axis] / scale[axis].into())
    };
    let (origin, dir): (Vector, Vector) =
        (squeezed(difference(ray.origin, center)), squeezed(vector(ray.dir)));
    // From the point nearest to the center no digits are lost.
    let square = dot(dir, dir);
    let nearest = -dot(origin, dir) / square;
    let at = add(origin, times(dir, nearest));
    let radius = Twofold::from(radius);
    let room = radius * radius - dot(at, at);
    if room.high.abs() < 1e-24 * radius.powi(2).high {
        return Truth::Undecided;
    }
    if room.is_negative() {
        return Truth::Miss;
    }
    let half = (room / square).sqrt();
    let slope = 2.0 * (half * square).high;
    if nearest - half > near.into() {
        Truth::Hit(Hit { t: nearest - half, slope: -slope })
    } else if nearest + half > near.into() {
        Truth::Hit(Hit { t: nearest + half, slope })
    } else {
        Truth::Miss
    }
}

/// A sphere, likewise.
pub fn sphere(center: DVec3, radius: f64, ray: &Ray, near: f64) -> Truth {
    ellipsoid(center, radius, DVec3::ONE, ray, near)
}

/// The part in a box of what solves Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J, counted from a center.
pub struct Quadric {
    /// A to J.
    pub coefficients: [f64; 10],
    /// Where x, y and z are 0.
    pub center: DVec3,
    /// The corners of the box.
    pub corners: [DVec3; 2],
}

impl Quadric {
    /// The first hit of a ray farther than `near`.
    pub fn first_hit(&self, ray: &Ray, near: f64) -> Truth {
        let [a, b, c, d, e, f, g, h, i, j] = self.coefficients.map(Twofold::from);
        let half = Twofold::from(0.5);
        let square = |[x, y, z]: Vector| {
            [a * x + half * (d * y + e * z), b * y + half * (d * x + f * z), c * z + half * (e * x + f * y)]
        };
        let dir = vector(ray.dir);
        let origin = difference(ray.origin, self.center);
        // From the point nearest to the center few digits are lost.
        let nearest = -dot(origin, dir) / dot(dir, dir);
        let at = add(origin, times(dir, nearest));
        let quadratic = dot(dir, square(dir));
        let linear = (Twofold::from(2.0) * dot(at, square(dir)) + dot([g, h, i], dir)) * half;
        let constant = dot(at, square(at)) + dot([g, h, i], at) - j;
        let discriminant = linear * linear - quadratic * constant;
        let size = linear.powi(2).high + (quadratic * constant).high.abs();
        if discriminant.high.abs() < 1e-24 * size {
            return Truth::Undecided;
        }
        if discriminant.is_negative() {
            return Truth::Miss;
        }
        // Neither root is a difference of like numbers (Press et al., "Numerical Recipes", 5.6).
        let root = discriminant.sqrt();
        let sum = if linear.is_negative() { root - linear } else { -root - linear };
        let mut roots = [sum / quadratic, constant / sum].map(|root| root + nearest);
        roots.sort_by(|one, other| one.high.total_cmp(&other.high));
        for t in roots.into_iter().filter(|t| t.high.is_finite() && *t > near.into()) {
            let from_start = t - nearest;
            match self.keeps(add(at, times(dir, from_start)), t.high + ray.origin.abs().max_element()) {
                Some(true) => {
                    let slope = Twofold::from(2.0) * (quadratic * from_start + linear);
                    return Truth::Hit(Hit { t, slope: slope.high });
                }
                Some(false) => {}
                None => return Truth::Undecided,
            }
        }
        Truth::Miss
    }

    /// Whether a point, counted from the center, is in the box, as far as numbers of this size tell.
    fn keeps(&self, at: Vector, size: f64) -> Option<bool> {
        let [low, high] = self.corners.map(|corner| corner.to_array());
        let depth =
            (0..3).map(|axis| (at[axis] - low[axis].into()).min(Twofold::from(high[axis]) - at[axis]));
        let depth = depth.map(|number| number.high).fold(f64::INFINITY, f64::min);
        if depth.abs() <= EDGE * size { None } else { Some(depth > 0.0) }
    }
}

fn vector(vector: DVec3) -> Vector {
    vector.to_array().map(Twofold::from)
}

/// The way from one point to another, exactly.
fn difference(to: DVec3, from: DVec3) -> Vector {
    let (to, from) = (to.to_array(), from.to_array());
    std::array::from_fn(|axis| Twofold::difference(to[axis], from[axis]))
}

fn dot(a: Vector, b: Vector) -> Twofold {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

fn times(a: Vector, factor: Twofold) -> Vector {
    a.map(|part| part * factor)
}
