//! A finite plane: a rectangle.

use super::plane;
use tabray::exact::double_double::scaled;
use tabray::prelude::*;
use tabray::shapes::rectangle::{self, FinitePlane, Rectangle};

pub static DIMENSIONS: Pparm<DVec2> =
    Pparm::required("dimensions", "the size along `xdir` and perpendicular to it")
        .each(&["along", "across"])
        .unit("world units")
        .must("positive in each dimension", |size: &DVec2| size.min_element() > 0.0)
        .dumped("dimensions", "\n");
pub static XDIR: Pparm<DVec3> =
    Pparm::required("xdir", "the direction of the first side, projected onto the plane")
        .nonzero()
        .dumped("xdir", "\n");
static PROJECTED: Derived = Derived(|args| frame(args).x_axis.to_datum().line("projected", "\n"));
static ROTATION_ROWS: Derived = Derived(|args| {
    let row = |[x, y, z]: [f64; 3]| format!("{:<12} {x:7.3} {y:7.3} {z:7.3}\n", "");
    format!("rotation matrix\n{}", frame(args).to_cols_array_2d().map(row).concat())
});

/// The rows of a plane with sides, after those of [`plane::TABLE`].
pub const TABLE: Table = &[&DIMENSIONS, &XDIR, &PROJECTED];
/// The row that dumps the notes' rotation matrix.
pub const ROTATION: Table = &[&ROTATION_ROWS as &dyn Row];

inventory::submit! {
    Entity::shape("fplane", "a rectangle with its lower left corner at `point`", &[plane::TABLE, TABLE, ROTATION], |args| {
        Ok(plane::body(args, shape(args)?))
    })
}

/// Makes the rectangle of an entity whose table has the rows of [`plane::TABLE`] and [`TABLE`].
///
/// # Errors
/// If `xdir` is refused by [`sides`].
pub fn shape(args: &Args) -> Result<AnyShape, Refusal> {
    Ok(match args.accuracy() {
        Accuracy::Classic => Shape::new(finite_plane::<Classic>(args)?).classic().into(),
        Accuracy::Draft | Accuracy::Exact => {
            Shape::new(finite_plane::<Exact>(args)?).bracketed().certified().into()
        }
        Accuracy::Strict => Shape::new(finite_plane::<Strict>(args)?).bracketed().certified().into(),
    })
}

/// Returns the position of the rectangle of an entity whose table has the rows of [`plane::TABLE`] and [`TABLE`].
///
/// # Errors
/// If `xdir` is refused by [`sides`].
pub fn rectangle(args: &Args) -> Result<Rectangle, Refusal> {
    Ok(finite_plane::<Classic>(args)?.rectangle)
}

fn frame(args: &Attributes) -> DMat3 {
    rectangle::frame(args.get(&plane::NORMAL), args.get(&XDIR))
}

/// Returns the unit vectors along a rectangle's two sides.
///
/// # Errors
/// Returns an error if `xdir` is within 1e-6 radians of the normal or its opposite, and so has no direction in the
/// plane.
pub fn sides(args: &Args) -> Result<[DVec3; 2], Refusal> {
    let (normal, xdir) = (scaled(args.get(&plane::NORMAL)).normalize(), scaled(args.get(&XDIR)).normalize());
    if normal.cross(xdir).length() < 1e-6 {
        return Err(Refusal {
            attribute: Some("xdir"),
            message: "has an `xdir` parallel to its `normal`".to_owned(),
            help: "`xdir` gives the direction of the first side; any vector that is not parallel to `normal` will do",
        });
    }
    Ok([0, 1].map(|side| frame(args).col(side)))
}

/// Makes the rectangle of an entity, with hits of accuracy `A`.
///
/// # Errors
/// If `xdir` is refused by [`sides`].
pub fn finite_plane<A>(args: &Args) -> Result<FinitePlane<A>, Refusal> {
    let (plane, xdir, classic) = (plane::plane(args), args.get(&XDIR), sides(args)?);
    let sides = match args.accuracy() {
        Accuracy::Classic => classic,
        _ => rectangle::rounded_sides(plane.upright, xdir),
    };
    Ok(FinitePlane::cut_from(plane, args.get(&DIMENSIONS), xdir, sides))
}
