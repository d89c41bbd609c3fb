//! A triangle.

use crate::prelude::*;
use crate::shapes::Triangle;
use crate::shapes::plane::{Flat, Plane};
use crate::shapes::uv;

static VERTEX1: Pparm<DVec3> = Pparm::required("vertex1", "the first vertex").unit("world coordinates");
static VERTEX2: Pparm<DVec3> =
    Pparm::required("vertex2", "the second vertex, counterclockwise as seen from the lit side")
        .unit("world coordinates");
static VERTEX3: Pparm<DVec3> = Pparm::required("vertex3", "the third vertex").unit("world coordinates");
// The course's program reads these two attributes and does not use them.
static NORMAL: Pparm<DVec3> =
    Pparm::or("normal", "ignored, as the vertices determine which side is lit", DVec3::Z).not_dumped();
static POINT: Pparm<DVec3> =
    Pparm::or("point", "ignored, as the vertices determine the position", DVec3::ZERO).not_dumped();

const TABLE: Table = &[&VERTEX1, &VERTEX2, &VERTEX3, &NORMAL, &POINT];

inventory::submit! {
    Entity::shape("triangle", "a triangle", &[TABLE], |args| {
        let shape = shape(args).ok_or_else(|| Refusal {
            attribute: Some("vertex3"),
            message: "has collinear vertices".to_owned(),
            help: "the vertices of a triangle must not lie on one line",
        })?;
        Ok(Body::plain(shape))
    })
}

fn shape(args: &Args) -> Option<AnyShape> {
    let corners = [args.get(&VERTEX1), args.get(&VERTEX2), args.get(&VERTEX3)];
    Some(match args.accuracy() {
        Accuracy::Classic => {
            Shape::new(Triangle::classic(corners)?.up_to(args.planes_end_at())).classic().into()
        }
        Accuracy::Draft | Accuracy::Exact => {
            Shape::new(Triangle::<Exact>::new(corners)?.up_to(args.planes_end_at())).flat().certified().into()
        }
        Accuracy::Strict => Shape::new(Triangle::<Strict>::new(corners)?.up_to(args.planes_end_at()))
            .flat()
            .certified()
            .into(),
    })
}

impl<A: Marker> Hittable for Triangle<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let distance = self.plane.distance(ray, range);
        let is_hit = if A::IS_CLASSIC { self.contains(ray.at(distance)) } else { self.is_passed_by(ray) };
        if is_hit { distance } else { MISS }
    }

    #[inline]
    fn normal(&self, _at: DVec3) -> DVec3 {
        self.plane.normal
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_triangle(self.corners, at))
    }

    fn bounds(&self) -> Option<Aabb> {
        Some(Aabb::around(&self.corners))
    }

    #[inline]
    fn can_hit_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.plane.is_clear_of(region) || !Aabb::around(&self.corners).overlaps(region)
    }

    fn ends_as_planes(&self) -> bool {
        true
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
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        Triangle::t_bounds(self, ray, range)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, _origin_side: Option<Side>) -> f64 {
        // A certain hit lies inside the triangle.
        self.plane.quick_crossing(ray)
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

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        Some(self.plane.exact_crossing(ray))
    }
}

impl<A> Equation for Triangle<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let corner = self.corners[0].to_array();
        dot(self.area_normal(), per_axis(|axis| at[axis] - N::constant(corner[axis])))
    }

    fn kept<N: Scalar>(&self, at: [N; 3]) -> N {
        self.plane.kept(at).min(self.inside(at))
    }
    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        Some(uv::bounds_on_triangle(self.corners, at))
    }
}
