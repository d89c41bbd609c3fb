//! A disc: the part of a plane within a circle.

use tabray::prelude::*;

static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the position of the centre").alias(&["centre"]).unit("world coordinates");
static NORMAL: Pparm<DVec3> = Pparm::or("normal", "the direction in which it faces", DVec3::Y).nonzero();
static RADIUS: Pparm<f64> =
    Pparm::required("radius", "the distance from its centre to its edge").unit("world units").positive();

const TABLE: Table = &[&CENTER, &NORMAL, &RADIUS];

inventory::submit! {
    Entity::shape("disc", "a flat disc, lit on both sides", &[TABLE], |args| {
        let disc = Disc { radius: args.get(&RADIUS) };
        Ok(Body::implicit(disc, Frame::around(args.get(&CENTER), args.get(&NORMAL))))
    })
    .known_as(&["disk", "circle"])
}

/// A disc in the plane y = 0.
pub struct Disc {
    pub radius: f64,
}

impl Implicit for Disc {
    fn is_cut(&self) -> bool {
        true
    }

    fn value<N: Scalar>(&self, [_, y, _]: [N; 3]) -> N {
        y
    }

    fn inside_trim<N: Scalar>(&self, [x, _, z]: [N; 3]) -> N {
        N::constant(self.radius).powi(2) - x.powi(2) - z.powi(2)
    }

    fn luminous(&self) -> Option<Luminous> {
        let half = [self.radius * DVec3::X, self.radius * DVec3::Z];
        Some(Luminous::Panel(Panel { middle: DVec3::ZERO, half, is_round: true }))
    }

    fn bounds(&self) -> [DVec3; 2] {
        let corner = self.radius * DVec3::new(1.125, 0.125, 1.125);
        [-corner, corner]
    }
}
