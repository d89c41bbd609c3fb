//! A triangle.

use crate::geometry::bounds::Bounds;
use crate::geometry::ray::{Bracket, MISS, Ray, Side, Span};
use crate::numeric::number::{Number, cross, dot};
use crate::numeric::twofold::{self, Twofold, exponent_to_one, times_power_of_two, triple_product, unit};
use crate::scene::entity::{Args, Entity, Refusal};
use crate::scene::pparm::{Pparm, Table};
use crate::shapes::flat::{CLASSIC_METHOD, Flat, Plane};
use crate::world::accuracy::{Accuracy, Bounded, Classic, Draft, Exact, Strict};
use crate::world::any_shape::AnyShape;
use crate::world::body::Body;
use crate::world::certify::Equation;
use crate::world::hittable::{Bracketed, Certified, Hittable};
use crate::world::shape::Shape;
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
        let shape = shape(args).ok_or_else(|| Refusal {
            attribute: Some("vertex3"),
            message: "has its corners in one line".to_owned(),
            help: "three corners that are not in one line make a triangle",
        })?;
        Ok(Body::plain(shape))
    })
}

/// The shape of a triangle; nothing where its corners are in one line.
fn shape(args: &Args) -> Option<AnyShape> {
    let corners = [args.get(&VERTEX1), args.get(&VERTEX2), args.get(&VERTEX3)];
    let [a, b, c] = corners;
    let upright = upright(corners);
    if args.accuracy() == Accuracy::Classic {
        let plane = Plane::<Classic>::new((b - a).cross(c - a).try_normalize()?, upright, a);
        return Some(Shape::new(Triangle { plane, corners }).classic().into());
    }
    if upright.iter().all(|part| part.high == 0.0) {
        return None;
    }
    Some(match args.accuracy() {
        Accuracy::Draft => exact::<Draft>(corners, upright),
        Accuracy::Strict => exact::<Strict>(corners, upright),
        _ => exact::<Exact>(corners, upright),
    })
}

fn exact<A: Bounded>(corners: [DVec3; 3], upright: [Twofold; 3]) -> AnyShape {
    let normal = DVec3::from(unit(upright).map(|part| part.high));
    let plane = Plane::<A>::new(normal, upright, corners[0]);
    Shape::new(Triangle { plane, corners }).flat().certified().into()
}

/// A vector that stands upright on the plane through three points; 0 where they are in one line.
fn upright([a, b, c]: [DVec3; 3]) -> [Twofold; 3] {
    let edge = |to: DVec3| {
        let edge = [0, 1, 2].map(|axis| Twofold::difference(to[axis], a[axis]));
        scaled_to_one(edge)
    };
    // Each component is rounded once, however thin the triangle is.
    scaled_to_one(twofold::cross(edge(b), edge(c)))
}

/// A vector times the power of two that makes its greatest component one between 1/2 and 1.
fn scaled_to_one(vector: [Twofold; 3]) -> [Twofold; 3] {
    let exponent = exponent_to_one(vector.iter().fold(0.0, |most, part| part.high.abs().max(most)));
    let scaled = |part: f64| times_power_of_two(part, exponent);
    vector.map(|Twofold { high, low }| Twofold { high: scaled(high), low: scaled(low) })
}

struct Triangle<A> {
    plane: Plane<A>,
    corners: [DVec3; 3],
}

impl Hittable for Triangle<Classic> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.plane.distance(ray, within);
        if self.contains(ray.at(distance)) { distance } else { MISS }
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.plane.normal
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds::around(&self.corners))
    }

    fn meets_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Some([self.plane.point, self.plane.normal])
    }

    fn method(&self) -> String {
        CLASSIC_METHOD.to_owned()
    }
}

impl<A: Bounded> Hittable for Triangle<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.plane.distance(ray, within);
        if self.is_passed_by(ray) { distance } else { MISS }
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.plane.normal
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds::around(&self.corners))
    }

    fn meets_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn is_clear_of(&self, region: &Bounds) -> bool {
        self.plane.is_clear_of(region) || !Bounds::around(&self.corners).overlaps(region)
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Some([self.plane.point, self.plane.normal])
    }

    fn method(&self) -> String {
        self.plane.method().to_owned()
    }
}

impl<A: Bounded> Bracketed for Triangle<A> {
    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        let rough = self.plane.rough(ray, within.origin_error);
        let Bracket { near, far } = self.plane.bracket(&rough, ray, within);
        let passed = self.passed(ray);
        Bracket {
            near: if passed == Some(false) { MISS } else { near },
            far: if passed == Some(true) { far } else { MISS },
        }
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, _leaves: Option<Side>) -> f64 {
        // A hit that is certain is inside.
        self.plane.refined(ray)
    }
}

impl<A: Bounded> Flat for Triangle<A> {
    type Accuracy = A;

    #[inline(always)]
    fn flat(&self) -> &Plane<A> {
        &self.plane
    }
}

impl<A: Bounded> Certified for Triangle<A> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        self.plane.touches(at, error)
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<Twofold> {
        Some(self.plane.exact_crossing(ray))
    }
}

impl<A> Equation for Triangle<A> {
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

impl<A> Triangle<A> {
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
