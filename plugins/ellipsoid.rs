//! An ellipsoid: a sphere stretched along the axes.

use super::sphere::{TABLE as SPHERE, center_and_radius};
use tabray::prelude::*;
use tabray::shapes::Ellipsoid;

static SCALE: Pparm<DVec3> = Pparm::required("scale", "the scale factors along x, y and z")
    .must("positive in each dimension", |scale: &DVec3| scale.min_element() > 0.0);

const TABLE: Table = &[&SCALE as &dyn Row];

inventory::submit! {
    Entity::shape("ellipsoid", "a sphere scaled along the coordinate axes", &[SPHERE, TABLE], |args| {
        Ok(body(args, args.get(&SCALE)))
    })
}

/// Makes the object of an entity whose table has the rows of a sphere.
pub fn body(args: &Args, scale: DVec3) -> Body {
    let (center, radius) = center_and_radius(args);
    Body::plain(match args.accuracy() {
        Accuracy::Classic => Shape::new(Ellipsoid::<Classic>::new(center, radius, scale)).classic().into(),
        Accuracy::Draft => exact(Ellipsoid::<Draft>::exact(center, radius, scale)),
        Accuracy::Exact => exact(Ellipsoid::<Exact>::exact(center, radius, scale)),
        Accuracy::Strict => exact(Ellipsoid::<Strict>::exact(center, radius, scale)),
    })
}

fn exact<A: NotClassic>(ellipsoid: Ellipsoid<A>) -> AnyShape {
    Shape::new(ellipsoid).bracketed().certified().into()
}
