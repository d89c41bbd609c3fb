//! A triangle.

use super::plane::Plane;
use crate::accuracy::Accuracy;
use crate::certify::{self, Enclosure, Equation};
use crate::entity::{Entity, Refusal};
use crate::geometry::{Body, Hittable, MISS, Ray, Span};
use crate::interval::Interval;
use crate::number::Number;
use crate::pparm::{Pparm, Table};
use crate::twofold::Twofold;
use glam::DVec3;

static VERTEX1: Pparm<DVec3> = Pparm::required("vertex1", "its first corner").unit("world coordinates");
static VERTEX2: Pparm<DVec3> =
    Pparm::required("vertex2", "its second corner, against the clock as seen from its lit side")
        .unit("world coordinates");
static VERTEX3: Pparm<DVec3> = Pparm::required("vertex3", "its third corner").unit("world coordinates");
// The course's program had them read and never used them.
static NORMAL: Pparm<DVec3> =
    Pparm::or("normal", "nothing: its corners say which way it faces", DVec3::Z).not_dumped();
static POINT: Pparm<DVec3> =
    Pparm::or("point", "nothing: its corners say where it is", DVec3::ZERO).not_dumped();

const TABLE: Table = &[&VERTEX1, &VERTEX2, &VERTEX3, &NORMAL, &POINT];

inventory::submit! {
    Entity::shape("triangle", "a triangle", &[TABLE], |args| {
        let corners = [args.get(&VERTEX1), args.get(&VERTEX2), args.get(&VERTEX3)];
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize().ok_or_else(|| Refusal {
            attribute: Some("vertex3"),
            message: "has its corners in one line".to_owned(),
            help: "three corners that are not in one line make a triangle",
        })?;
        let plane = Plane { normal, point: a, accuracy: args.accuracy() };
        Ok(Body::plain(Triangle { plane, corners }))
    })
}

struct Triangle {
    plane: Plane,
    corners: [DVec3; 3],
}

impl Hittable for Triangle {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.plane.distance(ray, within);
        let is_inside = match self.plane.accuracy {
            Accuracy::Classic => self.contains(ray.at(distance)),
            _ => self.is_passed_by(ray),
        };
        if is_inside { distance } else { MISS }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.plane.normal(at)
    }

    fn certify(&self, ray: &Ray) -> Enclosure {
        certify::first_hit(self, ray)
    }
}

impl Equation for Triangle {
    fn value<N: Number>(&self, at: [N; 3]) -> N {
        self.plane.value(at)
    }

    fn kept(&self, at: [Interval; 3]) -> Interval {
        let [a, b, c] = self.corners;
        let inside = |from: DVec3, to: DVec3| {
            // Upright on the edge, in the plane, toward the inside.
            let inward = self.plane.normal.cross(to - from);
            let part =
                |axis: usize| (at[axis] - Interval::constant(from[axis])) * Interval::constant(inward[axis]);
            part(0) + part(1) + part(2)
        };
        self.plane.kept(at).min(inside(a, b)).min(inside(b, c)).min(inside(c, a))
    }
}

impl Triangle {
    /// Whether a point of the plane is to the left of every edge.
    #[inline(always)]
    fn contains(&self, at: DVec3) -> bool {
        let left_of = |from: DVec3, to: DVec3| (to - from).cross(at - from).dot(self.plane.normal) >= 0.0;
        let [a, b, c] = self.corners;
        left_of(a, b) && left_of(b, c) && left_of(c, a)
    }

    /// Whether a ray, continued both ways, passes every edge on the same side.
    ///
    /// Of an edge that two triangles share, each computes the same number but for its sign, so that no ray falls
    /// through between them (Woop, Benthin and Wald 2013).
    #[inline(always)]
    fn is_passed_by(&self, ray: &Ray) -> bool {
        let [a, b, c] = self.corners;
        let sides = [side(a, b, ray), side(b, c, ray), side(c, a, ray)];
        sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
    }
}

/// On which side of the line from one point to another a ray passes: the sign tells.
#[inline(always)]
fn side(from: DVec3, to: DVec3, ray: &Ray) -> f64 {
    let (a, b) = (from - ray.origin, to - ray.origin);
    let side = a.cross(b).dot(ray.dir);
    // What rounding could have turned is computed in twice the precision.
    let size = a.abs().max_element() * b.abs().max_element();
    if side.abs() > 32.0 * f64::EPSILON * size { side } else { side_in_twice_the_precision(from, to, ray) }
}

fn side_in_twice_the_precision(from: DVec3, to: DVec3, ray: &Ray) -> f64 {
    let place = |of: DVec3| [0, 1, 2].map(|axis| Twofold::difference(of[axis], ray.origin[axis]));
    let (a, b) = (place(from), place(to));
    let part = |axis: usize| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        (a[next] * b[last] - a[last] * b[next]) * Twofold::from(ray.dir[axis])
    };
    (part(0) + part(1) + part(2)).high
}
