//! A finite plane: a rectangle.

use super::plane;
use crate::geometry::bounds::Bounds;
use crate::geometry::ray::{Bracket, MISS, Ray, Side, Span};
use crate::numeric::number::{Number, cross, dot};
use crate::numeric::twofold::Twofold;
use crate::scene::entity::{Args, Entity, Refusal};
use crate::scene::pparm::{Attributes, Derived, Pparm, Row, Table};
use crate::scene::value::Value;
use crate::shapes::flat::{CLASSIC_METHOD, Flat, Plane};
use crate::shapes::rectangle::{self, FinitePlane, Rectangle};
use crate::world::accuracy::{Accuracy, Bounded, Classic, Draft, Exact, Strict};
use crate::world::any_shape::AnyShape;
use crate::world::body::Body;
use crate::world::certify::Equation;
use crate::world::hittable::{Bracketed, Certified, Hittable};
use crate::world::shape::Shape;
use glam::{DMat3, DVec2, DVec3};

pub static DIMENSIONS: Pparm<DVec2> = Pparm::required("dimensions", "its size along xdir and across it")
    .unit("world units")
    .must("positive each way", |size: &DVec2| size.min_element() > 0.0)
    .dumped("dimensions", "\n");
static XDIR: Pparm<DVec3> =
    Pparm::required("xdir", "the direction of its first side, or of anything right above that")
        .must("a vector with a direction", |xdir: &DVec3| xdir.try_normalize().is_some())
        .dumped("xdir", "\n");
static PROJECTED: Derived = Derived(|args| frame(args).x_axis.to_datum().line("projected", "\n"));
static ROTATION_ROWS: Derived = Derived(|args| {
    let rows = frame(args).to_cols_array_2d();
    let rows = rows.map(|[x, y, z]| format!("{:<12} {x:7.3} {y:7.3} {z:7.3}\n", ""));
    format!("rotation matrix\n{}", rows.concat())
});

/// What planes with sides of their own take, after what a plane takes.
pub const TABLE: Table = &[&DIMENSIONS, &XDIR, &PROJECTED];
/// The notes' rotation matrix, for the dump.
pub const ROTATION: Table = &[&ROTATION_ROWS as &dyn Row];

inventory::submit! {
    Entity::shape("fplane", "a rectangle, whose lower left corner is its point", &[plane::TABLE, TABLE, ROTATION], |args| {
        Ok(Body::plain(shape(args)?))
    })
}

/// The rectangle of an entity whose table has the rows of a plane's and of this file's.
///
/// # Errors
/// As [`sides`].
pub fn shape(args: &Args) -> Result<AnyShape, Refusal> {
    Ok(match args.accuracy() {
        Accuracy::Classic => Shape::new(finite_plane::<Classic>(args)?).classic().into(),
        Accuracy::Draft => Shape::new(finite_plane::<Draft>(args)?).flat().certified().into(),
        Accuracy::Exact => Shape::new(finite_plane::<Exact>(args)?).flat().certified().into(),
        Accuracy::Strict => Shape::new(finite_plane::<Strict>(args)?).flat().certified().into(),
    })
}

/// Where the same rectangle is; refused likewise.
pub fn rectangle(args: &Args) -> Result<Rectangle, Refusal> {
    Ok(finite_plane::<Classic>(args)?.rectangle)
}

/// The directions of a rectangle's two sides and its normal, as columns, all unit vectors: the rows of the
/// notes' rotation matrix.
fn frame(args: &Attributes) -> DMat3 {
    let normal = args.get(&plane::NORMAL).normalize();
    let xdir = args.get(&XDIR);
    let x = (xdir - normal.dot(xdir) * normal).normalize();
    DMat3::from_cols(x, normal.cross(x), normal)
}

/// The directions of a rectangle's two sides.
///
/// # Errors
/// Where `xdir` is parallel to the normal but for rounding, and so points nowhere on the plane.
pub fn sides(args: &Args) -> Result<[DVec3; 2], Refusal> {
    let normal = args.get(&plane::NORMAL).normalize();
    let xdir = args.get(&XDIR).normalize();
    if normal.cross(xdir).length() < 1e-6 {
        return Err(Refusal {
            attribute: Some("xdir"),
            message: "has an xdir parallel to its normal".to_owned(),
            help: "`xdir` gives the direction of the first side; any vector that is not upright on the plane will do",
        });
    }
    let DMat3 { x_axis, y_axis, .. } = frame(args);
    Ok([x_axis, y_axis])
}

/// The same, crossed as exactly as its type has it; refused as its sides are.
pub fn finite_plane<A>(args: &Args) -> Result<FinitePlane<A>, Refusal> {
    let (plane, dimensions) = (plane::plane(args), args.get(&DIMENSIONS));
    let reach = plane.point.abs().max_element() + dimensions.element_sum();
    let (given_xdir, given_sides) = (args.get(&XDIR), sides(args)?);
    let exact_sides = rectangle::exact_sides(plane.upright, given_xdir);
    let sides = match args.accuracy() {
        Accuracy::Classic => given_sides,
        _ => exact_sides.map(|side| DVec3::from(side.map(|part| part.high))),
    };
    let rectangle = Rectangle { corner: plane.point, dimensions, sides };
    Ok(FinitePlane { plane, rectangle, exact_sides, given_xdir, reach })
}

impl Hittable for FinitePlane<Classic> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.plane.distance(ray, within);
        if self.has_crossing(ray, distance) { distance } else { MISS }
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.plane.normal
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.rectangle.around())
    }

    fn meets_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Some([self.plane.point, self.plane.normal])
    }

    fn method(&self) -> String {
        CLASSIC_METHOD.to_owned()
    }
}

impl<A: Bounded> Hittable for FinitePlane<A> {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.plane.distance(ray, within);
        if self.has_crossing(ray, distance) { distance } else { MISS }
    }

    fn normal(&self, _at: DVec3) -> DVec3 {
        self.plane.normal
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.rectangle.around())
    }

    fn meets_itself(&self, _leaving: Side) -> bool {
        false
    }

    fn is_clear_of(&self, region: &Bounds) -> bool {
        self.plane.is_clear_of(region) || !self.rectangle.around().overlaps(region)
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Some([self.plane.point, self.plane.normal])
    }

    fn reach(&self) -> f64 {
        self.reach
    }

    fn method(&self) -> String {
        self.plane.method().to_owned()
    }
}

impl<A: Bounded> Bracketed for FinitePlane<A> {
    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        let rough = self.plane.rough(ray, within.origin_error);
        let inside = self.inside(ray, rough.distance);
        // A camera's direction is off by 3 units of 2^-53 in each component, which is less than half of the slack.
        let slack = rough.error + 2.0 * self.slack(ray, rough.distance);
        let Bracket { near, far } = self.plane.bracket(&rough, ray, within);
        Bracket {
            near: if inside < -slack { MISS } else { near },
            far: if inside > slack { far } else { MISS },
        }
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, _leaves: Option<Side>) -> f64 {
        // A hit that is certain is inside.
        self.plane.refined(ray)
    }
}

impl<A: Bounded> Flat for FinitePlane<A> {
    type Accuracy = A;

    #[inline(always)]
    fn flat(&self) -> &Plane<A> {
        &self.plane
    }
}

impl<A: Bounded> Certified for FinitePlane<A> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        // What starts on the plane beside the rectangle does not meet it either.
        self.plane.touches(at, error)
    }

    fn fine_distance(&self, ray: &Ray, _distance: f64) -> Option<Twofold> {
        Some(self.plane.exact_crossing(ray))
    }
}

impl<A> Equation for FinitePlane<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        self.plane.value(at)
    }

    /// How far inside of the four sides, each in a measure of its own: unit vectors would need more roots.
    fn kept<N: Number>(&self, at: [N; 3]) -> N {
        let n = |of: DVec3| of.to_array().map(N::constant);
        let (normal, xdir) = (self.plane.given_normal(), n(self.given_xdir));
        let (square, along) = (dot(normal, normal), dot(normal, xdir));
        let x = [0, 1, 2].map(|axis| square * xdir[axis] - along * normal[axis]);
        let y = cross(normal, x);
        let corner = n(self.plane.point);
        let from_corner = [0, 1, 2].map(|axis| at[axis] - corner[axis]);
        let inside = |side: [N; 3], length: f64| {
            let along = dot(side, from_corner);
            along.min(N::constant(length) * dot(side, side).sqrt() - along)
        };
        let [width, height] = self.rectangle.dimensions.to_array();
        self.plane.kept(at).min(inside(x, width)).min(inside(y, height))
    }
}
