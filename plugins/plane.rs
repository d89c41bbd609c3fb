//! A plane: every point in two directions, without end.

use crate::prelude::*;
pub use crate::shapes::Plane;

pub static NORMAL: Pparm<DVec3> =
    Pparm::required("normal", "a vector perpendicular to the plane, pointing to its lit side")
        .must("a nonzero vector", |normal: &DVec3| normal.try_normalize().is_some())
        .shown(DVec3::normalize);
pub static POINT: Pparm<DVec3> = Pparm::required("point", "a point on the plane").unit("world coordinates");

/// What every kind of plane takes.
pub const TABLE: Table = &[&NORMAL, &POINT];

inventory::submit! {
    Entity::shape("plane", "an infinite plane", &[TABLE], |args| Ok(Body::plain(Plane::new(args))))
}

impl Plane {
    /// The plane of an entity whose table has a plane's rows.
    pub fn new(args: &Args) -> Self {
        Self::with_normal(args.get(&NORMAL), args.get(&POINT), args.accuracy())
    }
}

impl Hittable for Plane {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.keep(self.crossing(ray), ray, within)
    }

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        match self.accuracy {
            Accuracy::Classic => Bracket::exactly(self.quick_distance(ray, within)),
            _ => Plane::bracket(self, &self.rough(ray, within.origin_error), ray, within),
        }
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.quick_crossing(ray);
        self.quick_keep(distance, ray, within)
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.normal
    }

    fn is_clear_of(&self, region: &Bounds) -> bool {
        Plane::is_clear_of(self, region)
    }

    fn meets_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        Plane::touches(self, at, error)
    }

    fn reach(&self) -> f64 {
        self.point.abs().max_element()
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<Twofold> {
        (self.accuracy != Accuracy::Classic).then(|| self.exact_crossing(ray))
    }

    fn clearance(&self, from: DVec3) -> f64 {
        let rounding = SLACK * (from.length() + self.point.length());
        (self.normal.dot(from - self.point).abs() - rounding).max(0.0)
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Some([self.point, self.normal])
    }

    fn method(&self) -> String {
        Plane::method(self).to_owned()
    }

    fn distances(&self, cpu: Cpu, rays: Rays, _: Option<&[Side]>, _: (&[f64], &[f64]), out: &mut [f64]) {
        Plane::distances(self, cpu, rays, out);
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }
}

impl Equation for Plane {
    const IS_QUADRATIC: bool = true;

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        dot(self.given_normal(), [0, 1, 2].map(|axis| at[axis] - N::constant(self.point[axis])))
    }

    fn kept<N: Number>(&self, [_, _, z]: [N; 3]) -> N {
        N::constant(0.01) - z
    }
}
