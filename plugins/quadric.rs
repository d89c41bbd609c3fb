//! A quadric: every point that solves an equation of the second degree (the notes' "General Quadric Surfaces").

use crate::accuracy::Accuracy;
use crate::bounds::{self, Bounds, SLACK};
use crate::certify::{self, Enclosure, Equation};
use crate::entity::{Entity, Refusal};
use crate::geometry::{Body, Hittable, MISS, Ray, Side, Span};
use crate::interval::Interval;
use crate::number::Number;
use crate::pparm::{Pparm, Table};
use crate::quadratic;
use crate::twofold::advance;
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
        let [a, b, c, d, e, f, g, h, i, j] = args.get(&COEFFICIENTS);
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
            is_classic: args.accuracy() == Accuracy::Classic,
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
    is_classic: bool,
}

impl Quadric {
    fn keeps(&self, at: DVec3) -> bool {
        let from_center = at - self.center;
        self.low.cmple(from_center).all() && from_center.cmple(self.high).all()
    }

    /// The coefficients of `a t^2 + 2 b t + c`, which is 0 where a line meets it.
    #[inline(always)]
    fn along(&self, origin: DVec3, dir: DVec3) -> [f64; 3] {
        let turned = self.square * dir;
        [
            dir.dot(turned),
            origin.dot(turned) + 0.5 * self.linear.dot(dir),
            origin.dot(self.square * origin) + self.linear.dot(origin) + self.constant,
        ]
    }

    /// The distances of both hits, the nearer first; what is none is no number.
    #[inline(always)]
    fn crossings(&self, ray: &Ray, leaves: Option<Side>) -> [f64; 2] {
        let origin = ray.origin - self.center;
        if self.is_classic {
            let [a, b, c] = self.along(origin, ray.dir);
            return quadratic::classic_roots(a, b, c);
        }
        // Counted from near the center, so that nothing far away is left in the arithmetic.
        let base = if leaves.is_some() { 0.0 } else { -origin.dot(ray.dir) };
        let moved = [0, 1, 2].map(|axis| advance(origin[axis], base, ray.dir[axis]));
        let [a, b, c] = self.along(DVec3::from(moved), ray.dir);
        // A direction along which it is straight, but for rounding: the far root would be made of that.
        let dir = ray.dir.abs();
        let size = dir.dot(DMat3::from_cols_array(&self.square.to_cols_array().map(f64::abs)) * dir);
        let a = if a.abs() <= 4.0 * f64::EPSILON * size { 0.0 } else { a };
        // A ray that leaves it starts on one root: the other one is what is left.
        let c = if leaves.is_some() { 0.0 } else { c };
        quadratic::roots(a, b, c).map(|root| base + root)
    }
}

impl Hittable for Quadric {
    /// The nearer hit that lies in the box, or the farther one.
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let crossings = self.crossings(ray, within.leaves).map(|distance| within.keep(distance));
        let kept = crossings.into_iter().find(|distance| self.keeps(ray.at(*distance)));
        kept.unwrap_or(MISS)
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
        by_value.max(bounds::clearance(from, self.bounds(), |region| self.is_clear_of(region)))
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let normal = 2.0 * (self.square * (at - self.center)) + self.linear;
        // A cone's apex has none; any will do.
        normal.try_normalize().unwrap_or(DVec3::Y)
    }

    fn bounds(&self) -> Option<Bounds> {
        let bounds = Bounds { low: self.center + self.low, high: self.center + self.high };
        (!self.is_classic).then_some(bounds)
    }

    fn is_convex(&self) -> bool {
        self.is_classic
    }

    fn is_two_sided(&self) -> bool {
        !self.is_classic
    }

    fn method(&self) -> String {
        let method =
            if self.is_classic { "the notes' formula" } else { "a closed form, from near its center" };
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
