//! A quadric: every point that solves an equation of the second degree (the notes' "General Quadric Surfaces").

use crate::accuracy::Accuracy;
use crate::bounds::Bounds;
use crate::certify::{self, Enclosure, Equation};
use crate::entity::{Entity, Refusal};
use crate::geometry::{Body, Bracket, Hittable, MISS, Ray, Span};
use crate::interval::Interval;
use crate::number::Number;
use crate::pparm::{Pparm, Table};
use crate::quadratic::{self, CAMERA, OwnRay, Quadratic, Quick};
use glam::{DMat3, DVec3};

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
        let coefficients = args.get(&COEFFICIENTS);
        let [a, b, c, d, e, f, g, h, i, j] = coefficients;
        let [x1, y1, z1, x2, y2, z2] = args.get(&BOX);
        let (low, high) = (DVec3::new(x1, y1, z1), DVec3::new(x2, y2, z2));
        if !low.cmplt(high).all() {
            return Err(Refusal {
                attribute: Some("box"),
                message: "has an empty box".to_owned(),
                help: "the box goes from its low corner to its high one: x, y and z must all grow",
            });
        }
        let square = DMat3::from_cols(
            DVec3::new(a, d / 2.0, e / 2.0),
            DVec3::new(d / 2.0, b, f / 2.0),
            DVec3::new(e / 2.0, f / 2.0, c),
        );
        Ok(Body::plain(Quadric {
            square,
            linear: DVec3::new(g, h, i),
            constant: -j,
            center: args.get(&CENTER),
            low,
            high,
            own: Quadratic::new(coefficients, low, high),
            accuracy: args.accuracy(),
        }))
    })
}

/// `p·Sp + l·p + c = 0`, for points `p` from the center.
struct Quadric {
    square: DMat3,
    linear: DVec3,
    constant: f64,
    center: DVec3,
    low: DVec3,
    high: DVec3,
    /// The same surface, as it is solved.
    own: Quadratic,
    accuracy: Accuracy,
}

impl Quadric {
    fn keeps(&self, at: DVec3) -> bool {
        let from_center = at - self.center;
        self.low.cmple(from_center).all() && from_center.cmple(self.high).all()
    }

    /// The notes' formula.
    fn classic_distance(&self, ray: &Ray, within: &Span) -> f64 {
        let origin = ray.origin - self.center;
        let turned = self.square * ray.dir;
        let [a, b, c] = [
            ray.dir.dot(turned),
            origin.dot(turned) + 0.5 * self.linear.dot(ray.dir),
            origin.dot(self.square * origin) + self.linear.dot(origin) + self.constant,
        ];
        let crossings = quadratic::classic_roots(a, b, c).map(|distance| within.keep(distance));
        crossings.into_iter().find(|distance| self.keeps(ray.at(*distance))).unwrap_or(MISS)
    }

    /// The distance where there is nothing to decide: by the notes' formula, or of a ray that leaves it.
    #[inline(never)]
    fn other_distance(&self, ray: &Ray, within: &Span) -> f64 {
        if self.is_classic() {
            return self.classic_distance(ray, within);
        }
        // It starts on one hit: the other one is what is left.
        within.keep(self.own.other_hit(&self.own_ray(ray)))
    }

    #[inline(always)]
    fn own_ray(&self, ray: &Ray) -> OwnRay {
        self.own.own(ray.origin, ray.dir, self.center)
    }

    fn is_classic(&self) -> bool {
        self.accuracy == Accuracy::Classic
    }
}

impl Hittable for Quadric {
    /// The nearer hit that lies in the box, or the farther one.
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let quick = self.quick_distance(ray, within);
        if quick.is_nan() { within.keep(self.own.exact_hit(&self.own_ray(ray), within.near)) } else { quick }
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        if self.is_classic() || within.leaves.is_some() {
            return self.other_distance(ray, within);
        }
        let own = self.own_ray(ray);
        if self.accuracy == Accuracy::Strict {
            return f64::NAN;
        }
        let quick = self.own.quick_hit(&own, within.near, 0.0);
        let corrected = self.own.corrected(&own, quick.distance);
        let is_unknown = quick.is_unknown | corrected.is_nan();
        let hit = if is_unknown { f64::NAN } else { within.keep(corrected) };
        if quick.is_missed { MISS } else { hit }
    }

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        if self.is_classic() || within.leaves.is_some() {
            return Bracket::exactly(self.other_distance(ray, within));
        }
        let Quick { is_missed, is_unknown, distance, error } =
            self.own.quick_hit(&self.own_ray(ray), within.near, CAMERA);
        let (near, far) = if is_unknown { (within.near, MISS) } else { (distance - error, distance + error) };
        if is_missed { Bracket::MISS } else { Bracket { near, far } }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        if self.is_classic() {
            let normal = 2.0 * (self.square * (at - self.center)) + self.linear;
            // A cone's apex has none; any will do.
            return normal.try_normalize().unwrap_or(DVec3::Y);
        }
        self.own.normal(at, self.center)
    }

    fn bounds(&self) -> Option<Bounds> {
        let bounds = Bounds { low: self.center + self.low, high: self.center + self.high };
        (!self.is_classic()).then_some(bounds)
    }

    fn is_convex(&self) -> bool {
        self.is_classic()
    }

    fn is_two_sided(&self) -> bool {
        !self.is_classic()
    }

    fn method(&self) -> String {
        let method = if self.is_classic() {
            "the notes' formula"
        } else {
            "a closed form and a step of Newton's method, in twice the precision where rounding could decide"
        };
        method.to_owned()
    }

    fn certify(&self, ray: &Ray) -> Enclosure {
        certify::first_hit(self, ray)
    }
}

impl Equation for Quadric {
    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let from_center = [0, 1, 2].map(|axis| at[axis] - N::constant(self.center[axis]));
        let sum = |part: &dyn Fn(usize) -> N| part(0) + part(1) + part(2);
        let row = |row: usize| {
            let square = sum(&|column| from_center[column] * N::constant(self.square.col(column)[row]));
            from_center[row] * (square + N::constant(self.linear[row]))
        };
        sum(&row) + N::constant(self.constant)
    }

    fn kept(&self, at: [Interval; 3]) -> Interval {
        let inside = |axis: usize| {
            let from_center = at[axis] - Interval::constant(self.center[axis]);
            let (low, high) = (Interval::constant(self.low[axis]), Interval::constant(self.high[axis]));
            (from_center - low).min(high - from_center)
        };
        inside(0).min(inside(1)).min(inside(2))
    }
}
