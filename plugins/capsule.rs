//! A capsule: a cylinder whose ends are half spheres.

use tabray::prelude::*;

static BASE: Pparm<DVec3> =
    Pparm::required("base", "the centre of its lower half sphere").unit("world coordinates");
static DIRECTION: Pparm<DVec3> =
    Pparm::or("direction", "the direction of the axis, upward", DVec3::Y).nonzero();
static HEIGHT: Pparm<f64> =
    Pparm::required("height", "the distance from the centre of one half sphere to that of the other")
        .unit("world units")
        .positive();
static RADIUS: Pparm<f64> =
    Pparm::required("radius", "the distance of its wall from the axis").unit("world units").positive();

const TABLE: Table = &[&BASE, &DIRECTION, &HEIGHT, &RADIUS];

inventory::submit! {
    Entity::shape("capsule", "a cylinder with round ends", &[TABLE], |args| {
        let capsule = Capsule { height: args.get(&HEIGHT), radius: args.get(&RADIUS) };
        Ok(Body::implicit(capsule, Frame::around(args.get(&BASE), args.get(&DIRECTION))))
    })
}

/// A capsule around the y axis, from the origin upward.
struct Capsule {
    height: f64,
    radius: f64,
}

impl Implicit for Capsule {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        let beyond = (-y).ramp(2) + (y - N::constant(self.height)).ramp(2);
        x.powi(2) + z.powi(2) + beyond - N::constant(self.radius).powi(2)
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        None
    }

    fn bounds(&self) -> [DVec3; 2] {
        let around = DVec3::splat(1.125 * self.radius);
        [-around, around + self.height * DVec3::Y]
    }
}
