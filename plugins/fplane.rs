//! A finite plane: a rectangle.

use super::plane::{self, Plane};
use crate::prelude::*;
use crate::shapes::rectangle;
pub use crate::shapes::rectangle::FinitePlane;

pub static DIMENSIONS: Pparm<DVec2> =
    Pparm::required("dimensions", "the size along `xdir` and perpendicular to it")
        .unit("world units")
        .must("positive in each dimension", |size: &DVec2| size.min_element() > 0.0)
        .dumped("dimensions", "\n");
static XDIR: Pparm<DVec3> =
    Pparm::required("xdir", "the direction of the first side, projected onto the plane")
        .must("a nonzero vector", |xdir: &DVec3| xdir.try_normalize().is_some())
        .dumped("xdir", "\n");
static PROJECTED: Derived = Derived(|args| frame(args).x_axis.to_datum().line("projected", "\n"));
static ROTATION_ROWS: Derived = Derived(|args| {
    let row = |[x, y, z]: [f64; 3]| format!("{:<12} {x:7.3} {y:7.3} {z:7.3}\n", "");
    format!("rotation matrix\n{}", frame(args).to_cols_array_2d().map(row).concat())
});

/// What planes with sides of their own take, after what a plane takes.
pub const TABLE: Table = &[&DIMENSIONS, &XDIR, &PROJECTED];
/// The notes' rotation matrix, for the dump.
pub const ROTATION: Table = &[&ROTATION_ROWS as &dyn Row];

fn frame(args: &Attributes) -> DMat3 {
    rectangle::frame(args.get(&plane::NORMAL), args.get(&XDIR))
}

inventory::submit! {
    Entity::shape("fplane", "a rectangle with its lower left corner at `point`", &[plane::TABLE, TABLE, ROTATION], |args| {
        Ok(Body::plain(FinitePlane::new(args)?))
    })
}

/// The directions of a rectangle's two sides.
///
/// # Errors
/// Where `xdir` is parallel to the normal but for rounding, and so points nowhere on the plane.
pub fn sides(args: &Args) -> Result<[DVec3; 2], Refusal> {
    let (normal, xdir) = (args.get(&plane::NORMAL).normalize(), args.get(&XDIR).normalize());
    if normal.cross(xdir).length() < 1e-6 {
        return Err(Refusal {
            attribute: Some("xdir"),
            message: "has an `xdir` parallel to its `normal`".to_owned(),
            help: "`xdir` gives the direction of the first side; any vector that is not parallel to `normal` will do",
        });
    }
    Ok([0, 1].map(|side| frame(args).col(side)))
}

impl FinitePlane {
    /// The rectangle of an entity whose table has the rows of a plane's and of this file's; refused as its sides are.
    pub fn new(args: &Args) -> Result<Self, Refusal> {
        Ok(Self::cut_from(Plane::new(args), args.get(&DIMENSIONS), args.get(&XDIR), sides(args)?))
    }
}

impl Hittable for FinitePlane {
    #[inline(always)]
    fn distance(&self, ray: &Ray, within: &Span) -> f64 {
        let distance = self.plane.distance(ray, within);
        if self.has_crossing(ray, distance) { distance } else { MISS }
    }

    #[inline(always)]
    fn bracket(&self, ray: &Ray, within: &Span) -> Bracket {
        match self.plane.accuracy {
            Accuracy::Classic => Bracket::exactly(self.quick_distance(ray, within)),
            _ => FinitePlane::bracket(self, ray, within),
        }
    }

    #[inline(always)]
    fn quick_distance(&self, ray: &Ray, within: &Span) -> f64 {
        self.quickly_kept(ray, self.plane.quick_distance(ray, within))
    }

    fn distances(&self, cpu: Cpu, rays: Rays, _: Option<&[Side]>, _: (&[f64], &[f64]), out: &mut [f64]) {
        // It is asked of hits that are certain, and those are inside.
        self.plane.distances(cpu, rays, out);
    }

    fn bounds(&self) -> Option<Bounds> {
        (self.plane.accuracy != Accuracy::Classic).then(|| self.around())
    }

    fn is_clear_of(&self, region: &Bounds) -> bool {
        self.plane.is_clear_of(region) || self.bounds().is_some_and(|bounds| !bounds.overlaps(region))
    }

    fn meets_itself(&self, leaving: Side) -> bool {
        self.plane.meets_itself(leaving)
    }

    fn touches(&self, at: DVec3, error: f64) -> bool {
        // What starts on the plane beside the rectangle does not meet it either.
        self.plane.touches(at, error)
    }

    fn reach(&self) -> f64 {
        self.reach
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<Twofold> {
        self.plane.fine_distance(ray, distance)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.plane.normal(at)
    }

    fn plane(&self) -> Option<[DVec3; 2]> {
        Hittable::plane(&self.plane)
    }

    fn method(&self) -> String {
        self.plane.method().to_owned()
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        certify::first_hit(self, sight, precision)
    }
}

impl Equation for FinitePlane {
    const IS_QUADRATIC: bool = true;

    fn value<N: Number>(&self, at: [N; 3]) -> N {
        self.plane.value(at)
    }

    fn kept<N: Number>(&self, at: [N; 3]) -> N {
        self.plane.kept(at).min(self.inside_of(at))
    }
}
