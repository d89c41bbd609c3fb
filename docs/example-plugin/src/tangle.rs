//! A tangle: a closed quartic surface, a cube with a hole in each side.

use tabray::prelude::*;

static CENTER: Pparm<DVec3> = Pparm::required("center", "the position of the centre").unit("world coordinates");
static SIZE: Pparm<f64> = Pparm::required("size", "the distance from the centre to the sides")
    .unit("world units")
    .positive();

const TABLE: Table = &[&CENTER, &SIZE];

inventory::submit! {
    Entity::shape("tangle", "a cube with holes through its centre", &[TABLE], |args| {
        Ok(Body::implicit(Tangle { size: args.get(&SIZE) }, Frame::at(args.get(&CENTER))))
    })
}

/// The extent of the surface along each axis, before its formula is scaled.
const REACH: f64 = 2.2665;

struct Tangle {
    size: f64,
}

impl Implicit for Tangle {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let side = |at: N| {
            let square = (at * N::constant(REACH / self.size)).powi(2);
            square * (square - N::constant(5.0))
        };
        let [x, y, z] = at;
        side(x) + side(y) + side(z) + N::constant(11.8)
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::splat(-self.size), DVec3::splat(self.size)]
    }
}
