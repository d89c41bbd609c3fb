//! A triangle.

use crate::prelude::*;
use crate::shapes::Triangle;

static VERTEX1: Pparm<DVec3> = Pparm::required("vertex1", "the first vertex").unit("world coordinates");
static VERTEX2: Pparm<DVec3> =
    Pparm::required("vertex2", "the second vertex, counterclockwise as seen from the lit side")
        .unit("world coordinates");
static VERTEX3: Pparm<DVec3> = Pparm::required("vertex3", "the third vertex").unit("world coordinates");
// The course's program had them read and never used them.
static NORMAL: Pparm<DVec3> =
    Pparm::or("normal", "ignored, as the vertices determine which side is lit", DVec3::Z).not_dumped();
static POINT: Pparm<DVec3> =
    Pparm::or("point", "ignored, as the vertices determine the position", DVec3::ZERO).not_dumped();

const TABLE: Table = &[&VERTEX1, &VERTEX2, &VERTEX3, &NORMAL, &POINT];

inventory::submit! {
    Entity::shape("triangle", "a triangle", &[TABLE], |args| {
        let corners = [args.get(&VERTEX1), args.get(&VERTEX2), args.get(&VERTEX3)];
        let triangle = Triangle::new(corners, args.accuracy()).ok_or_else(|| Refusal {
            attribute: Some("vertex3"),
            message: "has collinear vertices".to_owned(),
            help: "the vertices of a triangle must not lie on one line",
        })?;
        Ok(Body::plain(triangle))
    })
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
        self.plane.kept(at).min(self.inside(at))
    }
}
