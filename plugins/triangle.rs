//! A triangle.

use crate::accuracy::Accuracy;
use crate::bounds::Bounds;
use crate::certify::{self, Enclosure, Equation};
use crate::entity::{Entity, Refusal};
use crate::flat::Plane;
use crate::geometry::{Body, Bracket, Hittable, MISS, Ray, Span};
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

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        if self.plane.accuracy == Accuracy::Classic {
            return Bracket::exactly(self.quick_distance(ray, within));
        }
        let rough = self.plane.rough(ray);
        let Bracket { near, far } = self.plane.bracket(&rough, ray, within);
        let passed = self.passed(ray);
        Bracket {
            near: if passed == Some(false) { MISS } else { near },
            far: if passed == Some(true) { far } else { MISS },
        }
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.plane.quick_distance(ray, within);
        let is_inside = match self.plane.accuracy {
            Accuracy::Classic => Some(self.contains(ray.at(distance))),
            _ => self.passed(ray),
        };
        match is_inside {
            Some(true) => distance,
            Some(false) => MISS,
            None => f64::NAN,
        }
    }

    fn bounds(&self) -> Option<Bounds> {
        (self.plane.accuracy != Accuracy::Classic).then(|| Bounds::around(&self.corners))
    }

    fn is_clear_of(&self, region: &Bounds) -> bool {
        self.plane.is_clear_of(region) || self.bounds().is_some_and(|bounds| !bounds.overlaps(region))
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.plane.normal(at)
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Hittable::plane(&self.plane)
    }

    fn method(&self) -> String {
        self.plane.method().to_owned()
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
        self.passed(ray).unwrap_or_else(|| {
            let [a, b, c] = self.corners;
            let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| side_in_twice_the_precision(from, to, ray));
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    /// Likewise, or nothing where rounding could have turned a sign.
    #[inline(always)]
    fn passed(&self, ray: &Ray) -> Option<bool> {
        let [a, b, c] = self.corners.map(|corner| corner - ray.origin);
        let side = |from: DVec3, to: DVec3| {
            let side = from.cross(to).dot(ray.dir);
            let error = 32.0 * f64::EPSILON * from.abs().max_element() * to.abs().max_element();
            (side > error, side < -error)
        };
        let (one, two, three) = (side(a, b), side(b, c), side(c, a));
        let is_inside = (one.0 & two.0 & three.0) | (one.1 & two.1 & three.1);
        let is_outside = (one.0 | two.0 | three.0) & (one.1 | two.1 | three.1);
        if is_inside | is_outside { Some(is_inside) } else { None }
    }
}

/// On which side of the line from one point to another a ray passes: the sign tells.
fn side_in_twice_the_precision(from: DVec3, to: DVec3, ray: &Ray) -> f64 {
    let place = |of: DVec3| [0, 1, 2].map(|axis| Twofold::difference(of[axis], ray.origin[axis]));
    let (a, b) = (place(from), place(to));
    let part = |axis: usize| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        (a[next] * b[last] - a[last] * b[next]) * Twofold::from(ray.dir[axis])
    };
    (part(0) + part(1) + part(2)).high
}
