//! A triangle.

use crate::numeric::twofold::{self, exponent_to_one, times_power_of_two, triple_product, unit};
use crate::prelude::*;
use crate::shapes::Plane;

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
        let plane = plane_through(corners, args.accuracy()).ok_or_else(|| Refusal {
            attribute: Some("vertex3"),
            message: "has its corners in one line".to_owned(),
            help: "three corners that are not in one line make a triangle",
        })?;
        Ok(Body::plain(Triangle { plane, corners }))
    })
}

/// The plane through three points; nothing where they are in one line.
fn plane_through([a, b, c]: [DVec3; 3], accuracy: Accuracy) -> Option<Plane> {
    let edge = |to: DVec3| {
        let edge = [0, 1, 2].map(|axis| Twofold::difference(to[axis], a[axis]));
        scaled_to_one(edge)
    };
    // Each component is rounded once, however thin the triangle is.
    let upright = scaled_to_one(twofold::cross(edge(b), edge(c)));
    let normal = match accuracy {
        Accuracy::Classic => (b - a).cross(c - a).try_normalize()?,
        _ if upright.iter().all(|part| part.high == 0.0) => return None,
        _ => DVec3::from(unit(upright).map(|part| part.high)),
    };
    Some(Plane { normal, upright, point: a, accuracy })
}

/// A vector times the power of two that makes its greatest component one between 1/2 and 1.
fn scaled_to_one(vector: [Twofold; 3]) -> [Twofold; 3] {
    let exponent = exponent_to_one(vector.iter().fold(0.0, |most, part| part.high.abs().max(most)));
    let scaled = |part: f64| times_power_of_two(part, exponent);
    vector.map(|Twofold { high, low }| Twofold { high: scaled(high), low: scaled(low) })
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
        let rough = self.plane.rough(ray, within.origin_error);
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

    fn meets_itself(&self, leaving: Side) -> bool {
        self.plane.meets_itself(leaving)
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        self.plane.touches(at, error)
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<Twofold> {
        (self.plane.accuracy != Accuracy::Classic).then(|| self.plane.exact_crossing(ray))
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

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }
}

impl Equation for Triangle {
    const IS_QUADRATIC: bool = true;

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let corner = self.corners[0].to_array();
        dot(self.upright(), [0, 1, 2].map(|axis| at[axis] - N::constant(corner[axis])))
    }

    fn kept<N: Number>(&self, at: [N; 3]) -> N {
        let normal = self.upright();
        let corners = self.corners.map(|corner| corner.to_array().map(N::constant));
        let inside = |from: [N; 3], to: [N; 3]| {
            // Upright on the edge, in the plane, toward the inside.
            let inward = cross(normal, [0, 1, 2].map(|axis| to[axis] - from[axis]));
            dot(inward, [0, 1, 2].map(|axis| at[axis] - from[axis]))
        };
        let [a, b, c] = corners;
        self.plane.kept(at).min(inside(a, b)).min(inside(b, c)).min(inside(c, a))
    }
}

impl Triangle {
    /// A vector upright on it, as long as twice its area.
    fn upright<N: Number>(&self) -> [N; 3] {
        let [a, b, c] = self.corners.map(|corner| corner.to_array().map(N::constant));
        let from_a = |corner: [N; 3]| [0, 1, 2].map(|axis| corner[axis] - a[axis]);
        cross(from_a(b), from_a(c))
    }

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
            let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| exact_side(from, to, ray));
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    /// Likewise, or nothing where rounding could have turned a sign.
    #[inline(always)]
    fn passed(&self, ray: &Ray) -> Option<bool> {
        let [a, b, c] = self.corners.map(|corner| corner - ray.origin);
        let side = |from: DVec3, to: DVec3| {
            let side = from.cross(to).dot(ray.dir);
            // Units of 2^-53 of the greatest components' product: a component of the cross product is off by 4 of its
            // two parts, a camera's direction by 3 and the product by 4; of at most 1.74 components in sum, 3 for the
            // direction: 14 + 6 * 3 + 14 = 46, less than 64.
            let error = 32.0 * f64::EPSILON * from.abs().max_element() * to.abs().max_element();
            (side > error, side < -error)
        };
        let (one, two, three) = (side(a, b), side(b, c), side(c, a));
        let is_inside = (one.0 & two.0 & three.0) | (one.1 & two.1 & three.1);
        let is_outside = (one.0 | two.0 | three.0) & (one.1 | two.1 | three.1);
        if is_inside | is_outside { Some(is_inside) } else { None }
    }
}

/// On which side of the line from one point to another a ray passes: the sign tells, and 0 where it meets the line.
#[inline(never)]
fn exact_side(from: DVec3, to: DVec3, ray: &Ray) -> f64 {
    let place =
        |of: DVec3| scaled_to_one([0, 1, 2].map(|axis| Twofold::difference(of[axis], ray.origin[axis])));
    triple_product(place(from), place(to), ray.dir.to_array()).high
}
