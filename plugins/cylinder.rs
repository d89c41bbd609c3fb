//! A cylinder: solid, or a tube without its ends.

use tabray::prelude::*;
use tabray::shapes::uv;

static BASE: Pparm<DVec3> = Pparm::required("base", "the centre of its lower end").unit("world coordinates");
static DIRECTION: Pparm<DVec3> =
    Pparm::or("direction", "the direction of the axis, upward", DVec3::Y).nonzero();
static HEIGHT: Pparm<f64> =
    Pparm::required("height", "the length").known_as(&["length"]).unit("world units").positive();
static RADIUS: Pparm<f64> =
    Pparm::required("radius", "the distance of its wall from the axis").unit("world units").positive();
static OPEN: Pparm<bool> = Pparm::or("open", "whether it is a tube, without its two ends", false);

const TABLE: Table = &[&BASE, &DIRECTION, &HEIGHT, &RADIUS, &OPEN];

inventory::submit! {
    Entity::shape("cylinder", "a cylinder", &[TABLE], |args| {
        let cylinder =
            Cylinder { height: args.get(&HEIGHT), radius: args.get(&RADIUS), is_open: args.get(&OPEN) };
        Ok(Body::implicit(cylinder, Frame::around(args.get(&BASE), args.get(&DIRECTION))))
    })
    .known_as(&["pipe"])
}

/// A cylinder around the y axis, from the origin upward.
struct Cylinder {
    height: f64,
    radius: f64,
    is_open: bool,
}

impl Implicit for Cylinder {
    fn is_cut(&self) -> bool {
        true
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        Some(uv::on_height(at, self.height))
    }

    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        Some(uv::bounds_on_height(at, self.height))
    }

    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        let wall = x.powi(2) + z.powi(2) - N::constant(self.radius).powi(2);
        if self.is_open { wall } else { wall.max(y * (y - N::constant(self.height))) }
    }

    fn inside_trim<N: Scalar>(&self, [_, y, _]: [N; 3]) -> N {
        if self.is_open { y.min(N::constant(self.height) - y) } else { N::constant(1.0) }
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        self.is_open.then_some("its two ends are left out")
    }

    fn extruded(&self) -> Option<f64> {
        (!self.is_open).then_some(self.height)
    }

    fn bounds(&self) -> [DVec3; 2] {
        // The box must not touch the surface, or it would be in doubt on which side of it a hit is.
        let [out, up] = [1.125 * self.radius, 0.125 * self.height];
        [DVec3::new(-out, -up, -out), DVec3::new(out, self.height + up, out)]
    }
}
