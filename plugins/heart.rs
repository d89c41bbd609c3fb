//! A heart: the surface of the sixth degree by G. Taubin (1993).

use tabray::prelude::*;

static CENTER: Pparm<DVec3> =
    Pparm::required("center", "the position of the centre").alias(&["centre"]).unit("world coordinates");
static SIZE: Pparm<f64> =
    Pparm::required("size", "the distance from the centre down to the tip").unit("world units").positive();

const TABLE: Table = &[&CENTER, &SIZE];

inventory::submit! {
    Entity::shape("heart", "a heart", &[TABLE], |args| {
        Ok(Body::implicit(Heart { size: args.get(&SIZE) }, Frame::at(args.get(&CENTER))))
    })
}

/// A heart whose tip points to -y and whose front faces z.
struct Heart {
    size: f64,
}

impl Heart {
    /// Returns the terms of Taubin's formula, a^3 - b y^3: a, b and y.
    fn terms<N: Scalar>(&self, at: [N; 3]) -> (N, N, N) {
        let n = N::constant;
        let [x, y, z] = per_axis(|axis| at[axis] / n(self.size));
        let ellipsoid = x.powi(2) + y.powi(2) + n(2.25) * z.powi(2) - n(1.0);
        (ellipsoid, x.powi(2) + n(9.0) / n(80.0) * z.powi(2), y)
    }
}

impl Implicit for Heart {
    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        let (ellipsoid, bend, y) = self.terms(at);
        // The cube root of Taubin's formula: unlike the formula, it has a nonzero slope where `ellipsoid` and y are
        // both 0.
        ellipsoid - bend.pow(N::constant(1.0) / N::constant(3.0)) * y
    }

    fn polynomial<N: Scalar>(&self, at: [N; 3]) -> N {
        let (ellipsoid, bend, y) = self.terms(at);
        ellipsoid.powi(3) - bend * y.powi(3)
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        None
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::new(-1.14, -1.0, -0.68) * self.size, DVec3::new(1.14, 1.24, 0.68) * self.size]
    }
}
