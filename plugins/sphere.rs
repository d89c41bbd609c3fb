//! A sphere: every point at one distance from a centre.

use crate::prelude::*;
use crate::shapes::ball::{self, Line};

static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the position of the centre").alias(&["centre"]).unit("world coordinates");
static RADIUS: Pparm<f64> = Pparm::required("radius", "the distance from the centre to the surface")
    .unit("world units")
    .must("positive", |radius| *radius > 0.0)
    .dumped("radius", "\n");

/// What every round shape takes.
pub const TABLE: Table = &[&CENTER, &RADIUS];

inventory::submit! {
    Entity::shape("sphere", "a sphere", &[TABLE], |args| Ok(Body::plain(Sphere::new(args))))
}

/// A sphere. Other round shapes hold one.
#[derive(Clone)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
    pub accuracy: Accuracy,
}

impl Sphere {
    /// The sphere of an entity whose table has [`TABLE`]'s rows.
    pub fn new(args: &Args) -> Self {
        Self { center: args.get(&CENTER), radius: args.get(&RADIUS), accuracy: args.accuracy() }
    }
}

impl Sphere {
    /// A ray, counted from the centre.
    #[inline(always)]
    fn line(&self, ray: &Ray) -> Line {
        Line::new(ray, self.center)
    }
}

impl Hittable for Sphere {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        within.keep(match (self.accuracy, within.leaves) {
            (Accuracy::Classic, _) => classic(ray.origin - self.center, ray.dir, self.radius),
            (_, None) => ball::first_hit(&self.line(ray), self.radius, self.accuracy),
            (_, Some(Side::Inside)) => ball::far_hit(&self.line(ray), self.radius, self.accuracy),
            (_, Some(Side::Outside)) => MISS,
        })
    }

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        let from = ray.origin - self.center;
        match self.accuracy {
            Accuracy::Classic => Bracket::exactly(within.keep(classic(from, ray.dir, self.radius))),
            _ => ball::bracket(from, ray.dir, 1.0, 1.0, self.radius, within.leaves, within.origin_error),
        }
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = match (self.accuracy, within.leaves) {
            (Accuracy::Classic, _) => classic(ray.origin - self.center, ray.dir, self.radius),
            (_, None) => ball::quick_hit(&self.line(ray), self.radius, self.accuracy),
            (_, Some(Side::Inside)) => ball::far_hit(&self.line(ray), self.radius, self.accuracy),
            (_, Some(Side::Outside)) => MISS,
        };
        if distance.is_nan() { distance } else { within.keep(distance) }
    }

    fn bounds(&self) -> Option<Bounds> {
        let bounds = Bounds { low: self.center - self.radius, high: self.center + self.radius };
        (self.accuracy != Accuracy::Classic).then_some(bounds)
    }

    fn clearance(&self, from: DVec3) -> f64 {
        let away = (from - self.center).length();
        let rounding = SLACK * (from.length() + self.center.length() + self.radius);
        ((away - self.radius).abs() - rounding).max(0.0)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (at - self.center).normalize()
    }

    fn meets_itself(&self, leaving: Side) -> bool {
        self.accuracy != Accuracy::Classic && leaving == Side::Inside
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        ball::touches(at - self.center, self.radius, error)
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<Twofold> {
        if self.accuracy == Accuracy::Classic { None } else { coincidence::distance(self, ray, distance) }
    }

    fn is_two_sided(&self) -> bool {
        self.accuracy != Accuracy::Classic
    }

    fn method(&self) -> String {
        ball::method(self.accuracy).to_owned()
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }
}

impl Equation for Sphere {
    const IS_QUADRATIC: bool = true;

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| (at[axis] - N::constant(self.center[axis])).powi(2);
        part(0) + part(1) + part(2) - N::constant(self.radius).powi(2)
    }
}

/// The notes' distance of a ball, for a ray that starts `from` its centre.
#[inline(always)]
pub fn classic(from: DVec3, dir: DVec3, radius: f64) -> f64 {
    let a = dir.dot(dir);
    let b = 2.0 * from.dot(dir);
    let c = from.dot(from) - radius * radius;
    let discriminant = b * b - 4.0 * a * c;
    // A ray that only touches the sphere misses it.
    if discriminant <= 0.0 { MISS } else { (-b - discriminant.sqrt()) / (2.0 * a) }
}
