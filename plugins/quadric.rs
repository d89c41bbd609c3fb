//! A quadric: every point that solves an equation of the second degree (the notes' "General Quadric Surfaces").

use crate::entity::{Entity, Refusal};
use crate::geometry::{Body, Hittable, MISS, Ray, Span};
use crate::pparm::{Pparm, Table};
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
        Ok(Body::plain(Quadric { square, linear: DVec3::new(g, h, i), constant: -j, center: args.get(&CENTER), low, high }))
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
}

impl Quadric {
    fn keeps(&self, at: DVec3) -> bool {
        let from_center = at - self.center;
        self.low.cmple(from_center).all() && from_center.cmple(self.high).all()
    }
}

impl Hittable for Quadric {
    /// The nearer root that lies in the box, or the farther one.
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let (origin, dir) = (ray.origin - self.center, ray.dir);
        let a = dir.dot(self.square * dir);
        let b = 2.0 * origin.dot(self.square * dir) + self.linear.dot(dir);
        let c = origin.dot(self.square * origin) + self.linear.dot(origin) + self.constant;
        let roots = if a == 0.0 {
            [-c / b, f64::NAN]
        } else {
            let root = (b * b - 4.0 * a * c).sqrt();
            let (one, other) = ((-b - root) / (2.0 * a), (-b + root) / (2.0 * a));
            [one.min(other), one.max(other)]
        };
        let kept = roots.map(|root| within.keep(root)).into_iter().find(|root| self.keeps(ray.at(*root)));
        kept.unwrap_or(MISS)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (2.0 * (self.square * (at - self.center)) + self.linear).normalize()
    }
}
