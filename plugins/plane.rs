//! A plane: every point in two directions, without end.

use crate::accuracy::Accuracy;
use crate::certify::{self, Enclosure, Equation};
use crate::entity::{Args, Entity};
use crate::geometry::{Body, Hittable, MISS, Ray, Span};
use crate::interval::Interval;
use crate::number::Number;
use crate::pparm::{Pparm, Table};
use crate::twofold::{Twofold, dot, two_sum};
use glam::DVec3;

pub static NORMAL: Pparm<DVec3> =
    Pparm::required("normal", "a vector that stands upright on it, on its lit side")
        .must("a vector with a direction", |normal: &DVec3| normal.try_normalize().is_some())
        .shown(DVec3::normalize);
pub static POINT: Pparm<DVec3> = Pparm::required("point", "a point of it").unit("world coordinates");

/// What every kind of plane takes.
pub const TABLE: Table = &[&NORMAL, &POINT];

inventory::submit! {
    Entity::shape("plane", "a plane without end", &[TABLE], |args| Ok(Body::plain(Plane::new(args))))
}

/// Where a ray crosses a plane, about.
#[derive(Clone, Copy)]
pub struct Rough {
    /// The distance, or [`MISS`].
    pub distance: f64,
    /// How far off that is at most.
    error: f64,
    /// Whether so much cancels in it that it should be computed better.
    cancels: bool,
}

impl Rough {
    /// Whether the crossing may lie within a span.
    #[inline(always)]
    pub fn may_be(&self, within: &Span) -> bool {
        self.distance + self.error > within.near && self.distance - self.error < within.far
    }
}

/// An infinite plane. Other planes hold one.
pub struct Plane {
    pub normal: DVec3,
    pub point: DVec3,
    pub accuracy: Accuracy,
}

impl Plane {
    /// The plane of an entity whose table has [`TABLE`]'s rows.
    pub fn new(args: &Args) -> Self {
        let normal = args.get(&NORMAL).normalize();
        Self { normal, point: args.get(&POINT), accuracy: args.accuracy() }
    }

    /// The distance at which a ray crosses it, forward or backward; [`MISS`] for one that runs along it.
    ///
    /// The notes' form subtracts two numbers that grow with the distance from the world's origin, and takes a ray
    /// for parallel where the product is 0, which rounding hardly ever leaves it.
    #[inline(always)]
    pub fn crossing(&self, ray: &Ray) -> f64 {
        let toward = self.normal.dot(ray.dir);
        if self.accuracy == Accuracy::Classic {
            let away = self.normal.dot(self.point) - self.normal.dot(ray.origin);
            return if toward == 0.0 { MISS } else { away / toward };
        }
        if self.accuracy == Accuracy::Strict {
            return self.crossing_in_twice_the_precision(ray);
        }
        let rough = self.rough_crossing(ray);
        if rough.cancels && self.accuracy == Accuracy::Exact {
            self.fine_crossing(ray)
        } else {
            rough.distance
        }
    }

    /// The crossing, as far as plain arithmetic tells.
    #[inline(always)]
    pub fn rough_crossing(&self, ray: &Ray) -> Rough {
        let between = self.point - ray.origin;
        let (toward, away) = (self.normal.dot(ray.dir), self.normal.dot(between));
        // Parallel, but for what rounding makes of unit vectors.
        if toward.abs() <= 4.0 * f64::EPSILON {
            return Rough { distance: MISS, error: 0.0, cancels: false };
        }
        let distance = away / toward;
        let (toward_size, away_size) = (self.size(ray.dir), self.size(between));
        Rough {
            distance,
            error: 8.0 * f64::EPSILON * (away_size + distance.abs() * toward_size) / toward.abs(),
            cancels: toward_size > 1.3 * toward.abs() || away_size > 1.3 * away.abs(),
        }
    }

    /// The crossing to a few units in the last place, whatever cancels.
    #[inline(always)]
    fn fine_crossing(&self, ray: &Ray) -> f64 {
        let between = |axis: usize| two_sum(self.point[axis], -ray.origin[axis]);
        let [(x, x_low), (y, y_low), (z, z_low)] = [between(0), between(1), between(2)];
        let normal = self.normal.to_array();
        let away = dot(normal, [x, y, z], [x_low, y_low, z_low]);
        away / dot(normal, ray.dir.to_array(), [0.0; 3])
    }

    /// How large the products are that the product with the normal is a sum of.
    #[inline(always)]
    fn size(&self, of: DVec3) -> f64 {
        (self.normal * of).abs().element_sum()
    }

    fn crossing_in_twice_the_precision(&self, ray: &Ray) -> f64 {
        let product = |of: [Twofold; 3]| {
            let part = |axis: usize| Twofold::from(self.normal[axis]) * of[axis];
            part(0) + part(1) + part(2)
        };
        let between = [0, 1, 2].map(|axis| Twofold::difference(self.point[axis], ray.origin[axis]));
        (product(between) / product(ray.dir.to_array().map(Twofold::from))).high
    }
}

impl Hittable for Plane {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        if self.accuracy == Accuracy::Exact && !self.rough_crossing(ray).may_be(within) {
            return MISS;
        }
        let distance = self.crossing(ray);
        // On the viewer's side of the screen there are no planes (the notes' "wrong side").
        if ray.at(distance).z > 0.01 { MISS } else { within.keep(distance) }
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.normal
    }

    fn certify(&self, ray: &Ray) -> Enclosure {
        certify::first_hit(self, ray)
    }
}

impl Equation for Plane {
    fn value<N: Number>(&self, at: [N; 3]) -> N {
        let part = |axis: usize| (at[axis] - N::constant(self.point[axis])) * N::constant(self.normal[axis]);
        part(0) + part(1) + part(2)
    }

    fn kept(&self, [_, _, z]: [Interval; 3]) -> Interval {
        Interval::constant(0.01) - z
    }
}
