//! A quadric: every point that solves an equation of the second degree (the notes' "General Quadric Surfaces").

use crate::geometry::bounds::{self, Bounds, SLACK};
use crate::geometry::ray::{Bracket, MISS, Ray, Side, Span};
use crate::numeric::number::Number;
use crate::scene::entity::{Args, Entity, Refusal};
use crate::scene::pparm::{Pparm, Table};
use crate::shapes::quadratic::{self, CAMERA, OwnRay, Quadratic, Quick};
use crate::world::accuracy::{Accuracy, Bounded, Classic, Draft, Exact, Strict};
use crate::world::any_shape::AnyShape;
use crate::world::body::Body;
use crate::world::certify::Equation;
use crate::world::hittable::{Bracketed, Certified, Hittable};
use crate::world::shape::Shape;
use glam::{DMat3, DVec3};
use std::marker::PhantomData;

static COEFFICIENTS: Pparm<[f64; 10]> =
    Pparm::required("coefficients", "A to J of Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J")
        .must("not all zero but for J", |c: &[f64; 10]| c[..9].iter().any(|coefficient| *coefficient != 0.0));
static CENTER: Pparm<DVec3> = Pparm::or("center", "where the equation's x, y and z are 0", DVec3::ZERO)
    .alias(&["centre"])
    .unit("world coordinates");
static BOX: Pparm<[f64; 6]> = Pparm::or(
    "box",
    "what is kept of it: from x y z to x y z, counted from its center",
    [-1e9, -1e9, -1e9, 1e9, 1e9, 1e9],
)
.not_dumped();

const TABLE: Table = &[&COEFFICIENTS, &CENTER, &BOX];

inventory::submit! {
    Entity::shape("quadric", "a surface of the second degree, such as a cone, a cylinder or a saddle", &[TABLE], |args| {
        let [low, high] = corners(args);
        if !low.cmplt(high).all() {
            return Err(Refusal {
                attribute: Some("box"),
                message: "has an empty box".to_owned(),
                help: "the box goes from its low corner to its high one: x, y and z must all grow",
            });
        }
        Ok(Body::plain(match args.accuracy() {
            Accuracy::Classic => AnyShape::from(Shape::new(Quadric::<Classic>::new(args)).classic()),
            Accuracy::Draft => Shape::new(Quadric::<Draft>::new(args)).bracketed().certified().into(),
            Accuracy::Exact => Shape::new(Quadric::<Exact>::new(args)).bracketed().certified().into(),
            Accuracy::Strict => Shape::new(Quadric::<Strict>::new(args)).bracketed().certified().into(),
        }))
    })
}

/// `p·Sp + l·p + c = 0`, for points `p` from the center.
struct Quadric<A> {
    square: DMat3,
    linear: DVec3,
    constant: f64,
    center: DVec3,
    low: DVec3,
    high: DVec3,
    /// The same surface, as it is solved.
    own: Quadratic,
    accuracy: PhantomData<A>,
}

/// The corners of its box, from its center.
fn corners(args: &Args) -> [DVec3; 2] {
    let [x1, y1, z1, x2, y2, z2] = args.get(&BOX);
    [DVec3::new(x1, y1, z1), DVec3::new(x2, y2, z2)]
}

impl<A> Quadric<A> {
    fn new(args: &Args) -> Self {
        let (coefficients, [low, high]) = (args.get(&COEFFICIENTS), corners(args));
        let [a, b, c, d, e, f, g, h, i, j] = coefficients;
        let square = DMat3::from_cols(
            DVec3::new(a, d / 2.0, e / 2.0),
            DVec3::new(d / 2.0, b, f / 2.0),
            DVec3::new(e / 2.0, f / 2.0, c),
        );
        Self {
            square,
            linear: DVec3::new(g, h, i),
            constant: -j,
            center: args.get(&CENTER),
            low,
            high,
            own: Quadratic::new(coefficients, low, high),
            accuracy: PhantomData,
        }
    }

    fn around(&self) -> Bounds {
        Bounds { low: self.center + self.low, high: self.center + self.high }
    }

    /// At `r` from a point the equation's value differs from that at the point by at most `|gradient| r + |square| r^2`.
    fn away(&self, from: DVec3) -> f64 {
        let at = from - self.center;
        let abs = DMat3::from_cols_array(&self.square.to_cols_array().map(f64::abs));
        let terms = at.abs().dot(abs * at.abs()) + self.linear.abs().dot(at.abs()) + self.constant.abs();
        let value = at.dot(self.square * at) + self.linear.dot(at) + self.constant;
        let value = value.abs() - SLACK * terms;
        let rounding = SLACK * (abs * at.abs() + self.linear.abs()).length();
        let gradient = (2.0 * (self.square * at) + self.linear).length() + rounding;
        let square = (abs * DVec3::ONE).length();
        let radius = 2.0 * value / (gradient + (gradient * gradient + 4.0 * square * value).sqrt());
        if value > 0.0 && radius.is_finite() { radius * (1.0 - 1e-6) } else { 0.0 }
    }
}

impl Hittable for Quadric<Classic> {
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let origin = ray.origin - self.center;
        let turned = self.square * ray.dir;
        let [a, b, c] = [
            ray.dir.dot(turned),
            origin.dot(turned) + 0.5 * self.linear.dot(ray.dir),
            origin.dot(self.square * origin) + self.linear.dot(origin) + self.constant,
        ];
        let keeps = |at: DVec3| {
            let from_center = at - self.center;
            self.low.cmple(from_center).all() && from_center.cmple(self.high).all()
        };
        let crossings = quadratic::classic_roots(a, b, c).map(|distance| within.keep(distance));
        crossings.into_iter().find(|distance| keeps(ray.at(*distance))).unwrap_or(MISS)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let normal = 2.0 * (self.square * (at - self.center)) + self.linear;
        // A cone's apex has none; any will do.
        normal.try_normalize().unwrap_or(DVec3::Y)
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.around())
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        Some(self.away(from))
    }

    fn meets_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn method(&self) -> String {
        "the notes' formula".to_owned()
    }
}

impl<A: Bounded> Quadric<A> {
    /// The distance of a ray that leaves it. It starts on one hit: the other one is what is left.
    #[inline(never)]
    fn other_distance(&self, ray: &Ray, side: Side, within: &Span) -> f64 {
        within.keep(self.own.other_hit(&self.own_ray(ray), side))
    }

    #[inline(always)]
    fn own_ray(&self, ray: &Ray) -> OwnRay {
        self.own.own(ray.origin, ray.dir, self.center)
    }

    /// What plain arithmetic tells of the distance, or NaN.
    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        if let Some(side) = within.leaves {
            return self.other_distance(ray, side, within);
        }
        if A::ACCURACY == Accuracy::Strict {
            return f64::NAN;
        }
        let own = self.own_ray(ray);
        let quick = self.own.quick_hit(&own, within.near, 0.0);
        let corrected = self.own.corrected(&own, quick.distance);
        let is_unknown = quick.is_unknown | corrected.is_nan();
        let hit = if is_unknown { f64::NAN } else { within.keep(corrected) };
        if quick.is_missed { MISS } else { hit }
    }
}

impl<A: Bounded> Hittable for Quadric<A> {
    /// The nearer hit that lies in the box, or the farther one.
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let quick = self.quick_distance(ray, within);
        if quick.is_nan() { within.keep(self.own.exact_hit(&self.own_ray(ray), within.near)) } else { quick }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.own.normal(at, self.center)
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.around())
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn method(&self) -> String {
        "a closed form and a step of Newton's method, in twice the precision where rounding could decide"
            .to_owned()
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        Some(self.away(from).max(bounds::clearance(from, self.bounds(), |region| self.is_clear_of(region))))
    }

    fn reach(&self) -> f64 {
        // The box may be far larger than what is seen of it, and cuts only.
        self.center.abs().max_element()
    }
}

impl<A: Bounded> Bracketed for Quadric<A> {
    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        if let Some(side) = within.leaves {
            return Bracket::exactly(self.other_distance(ray, side, within));
        }
        if within.origin_error > 0.0 && self.touches(ray.origin, within.origin_error) {
            return Bracket::UNKNOWN;
        }
        let Quick { is_missed, is_unknown, distance, error } =
            self.own.quick_hit(&self.own_ray(ray), within.near, CAMERA);
        let (near, far) = if is_unknown { (within.near, MISS) } else { (distance - error, distance + error) };
        if is_missed { Bracket::MISS } else { Bracket { near, far } }
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, leaves: Option<Side>) -> f64 {
        self.quick_distance(ray, &Span { leaves, ..Span::RAY })
    }
}

impl<A: Bounded> Certified for Quadric<A> {}

impl<A> Equation for Quadric<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let from_center = [0, 1, 2].map(|axis| at[axis] - N::constant(self.center[axis]));
        let sum = |part: &dyn Fn(usize) -> N| part(0) + part(1) + part(2);
        let row = |row: usize| {
            let square = sum(&|column| from_center[column] * N::constant(self.square.col(column)[row]));
            from_center[row] * (square + N::constant(self.linear[row]))
        };
        sum(&row) + N::constant(self.constant)
    }

    fn kept<N: Number>(&self, at: [N; 3]) -> N {
        let inside = |axis: usize| {
            let from_center = at[axis] - N::constant(self.center[axis]);
            let (low, high) = (N::constant(self.low[axis]), N::constant(self.high[axis]));
            (from_center - low).min(high - from_center)
        };
        inside(0).min(inside(1)).min(inside(2))
    }
}
