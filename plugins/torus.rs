//! A torus: a circle rotated around an axis in its plane.

use tabray::prelude::*;

static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the position of the centre").alias(&["centre"]).unit("world coordinates");
static DIRECTION: Pparm<DVec3> = Pparm::or("direction", "the direction of the axis", DVec3::Y).nonzero();
static RADIUS: Pparm<f64> =
    Pparm::required("radius", "the distance from the centre to the middle of the tube")
        .unit("world units")
        .positive();
static TUBE: Pparm<f64> = Pparm::required("tube", "the radius of the tube").unit("world units").positive();

const TABLE: Table = &[&CENTER, &DIRECTION, &RADIUS, &TUBE];

inventory::submit! {
    Entity::shape("torus", "a torus; with a tube thicker than its radius, only its outer sheet", &[TABLE], |args| {
        let torus = Torus { radius: args.get(&RADIUS), tube: args.get(&TUBE) };
        Ok(Body::implicit(torus, Frame::around(args.get(&CENTER), args.get(&DIRECTION))))
    })
    .known_as(&["donut", "doughnut"])
}

/// A torus around the y axis.
struct Torus {
    radius: f64,
    tube: f64,
}

impl Implicit for Torus {
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        let from_circle = (x.powi(2) + z.powi(2)).sqrt() - N::constant(self.radius);
        from_circle.powi(2) + y.powi(2) - N::constant(self.tube).powi(2)
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        None
    }

    fn bounds(&self) -> [DVec3; 2] {
        let across = self.radius + self.tube;
        let high = DVec3::new(across, self.tube, across);
        [-high, high]
    }
}
