//! A quadric: every point that solves an equation of the second degree (the notes' "General Quadric Surfaces").

use crate::geometry::clearance;
use crate::prelude::*;
use crate::shapes::quadratic::{self, CAMERA, OwnRay, Quadratic, Quick};

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
        match within.leaves {
            // It starts on one hit: the other one is what is left.
            Some(side) if !self.is_classic() => within.keep(self.own.other_hit(&self.own_ray(ray), side)),
            _ => self.classic_distance(ray, within),
        }
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
        if within.origin_error > 0.0 && self.touches(ray.origin, within.origin_error) {
            return Bracket::UNKNOWN;
        }
        let Quick { is_missed, is_unknown, distance, error } =
            self.own.quick_hit(&self.own_ray(ray), within.near, CAMERA);
        let (near, far) = if is_unknown { (within.near, MISS) } else { (distance - error, distance + error) };
        if is_missed { Bracket::MISS } else { Bracket { near, far } }
    }

    /// At `r` from a point the equation's value differs from that at the point by at most `|gradient| r + |square| r^2`.
    fn clearance(&self, from: DVec3) -> f64 {
        let at = from - self.center;
        let abs = DMat3::from_cols_array(&self.square.to_cols_array().map(f64::abs));
        let terms = at.abs().dot(abs * at.abs()) + self.linear.abs().dot(at.abs()) + self.constant.abs();
        let value = at.dot(self.square * at) + self.linear.dot(at) + self.constant;
        let value = value.abs() - SLACK * terms;
        let rounding = SLACK * (abs * at.abs() + self.linear.abs()).length();
        let gradient = (2.0 * (self.square * at) + self.linear).length() + rounding;
        let square = (abs * DVec3::ONE).length();
        let radius = 2.0 * value / (gradient + (gradient * gradient + 4.0 * square * value).sqrt());
        let by_value = if value > 0.0 && radius.is_finite() { radius * (1.0 - 1e-6) } else { 0.0 };
        by_value.max(clearance(from, self.bounds(), |region| self.is_clear_of(region)))
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

    fn meets_itself(&self, _leaving: Side) -> bool {
        !self.is_classic()
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        coincidence::touches(self, at, error)
    }

    fn reach(&self) -> f64 {
        // The box may be far larger than what is seen of it, and cuts only.
        self.center.abs().max_element()
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<Twofold> {
        if self.is_classic() { None } else { coincidence::distance(self, ray, distance) }
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

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }
}

impl Equation for Quadric {
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
