//! A plane: flat and infinite.

use tabray::exact::double_double::scaled;
use tabray::prelude::*;
use tabray::shapes::plane::Plane;

pub static NORMAL: Pparm<DVec3> =
    Pparm::required("normal", "a vector perpendicular to the plane, pointing to its lit side")
        .nonzero()
        .shown(|normal| scaled(normal).normalize());
pub static POINT: Pparm<DVec3> = Pparm::required("point", "a point on the plane")
    .known_as(&["origin", "position", "through"])
    .unit("world coordinates");

/// The rows of every kind of plane.
pub const TABLE: Table = &[&NORMAL, &POINT];

inventory::submit! {
    Entity::shape("plane", "an infinite plane", &[TABLE], |args| Ok(body(args, shape(args))))
    .known_as(&["floor", "ground"])
}

/// Makes an object of a plane, or of a part of one, of an entity whose table has the rows of [`TABLE`].
pub fn body(args: &Args, shape: AnyShape) -> Body {
    Body::plain(shape).anchored(args.get(&POINT), 1.0)
}

/// Makes the plane of an entity whose table has the rows of [`TABLE`].
pub fn shape(args: &Args) -> AnyShape {
    match args.accuracy() {
        Accuracy::Classic => Shape::new(plane::<Classic>(args)).classic().into(),
        Accuracy::Draft | Accuracy::Exact => exact(plane::<Exact>(args)),
        Accuracy::Strict => exact(plane::<Strict>(args)),
    }
}

fn exact<A: NotClassic>(plane: Plane<A>) -> AnyShape {
    Shape::new(plane.from_nearest_point()).bracketed().certified().into()
}

/// Makes the plane of an entity whose table has the rows of [`TABLE`], with hits of accuracy `A`.
pub fn plane<A>(args: &Args) -> Plane<A> {
    Plane::with_normal(args.get(&NORMAL), args.get(&POINT)).up_to(args.planes_end_at())
}
