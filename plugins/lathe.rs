//! A turned piece: a surface of revolution whose profile is a spline through points.

use tabray::prelude::*;
use tabray::shapes::{ClassicRevolution, InFrame, Refinement, Revolution};

/// The points of a profile: the height and the radius of each.
type Points = List<DVec2, 2, 64>;

static POINTS: Pparm<Points> = Pparm::required(
    "points",
    "points of the profile, from the bottom up: the height of each above `base` and its distance from the axis",
)
.each(&["height", "radius"])
.unit("world units")
.must("points whose heights begin at 0 and rise", |points: &Points| {
    points.0[0].x == 0.0 && points.0.is_sorted_by(|low, high| low.x < high.x)
});
static DIRECTION: Pparm<DVec3> =
    Pparm::or("direction", "the direction of the axis, upward from `base`", DVec3::Y).nonzero();
static BASE: Pparm<DVec3> =
    Pparm::required("base", "the point on the axis at height 0").unit("world coordinates");

const TABLE: Table = &[&POINTS, &DIRECTION, &BASE];

inventory::submit! {
    Entity::shape("lathe", "a surface of revolution with a smooth profile through points", &[TABLE], |args| {
        let frame = Frame::around(args.get(&BASE), args.get(&DIRECTION));
        let points: Vec<_> = args.get(&POINTS).0.iter().map(DVec2::to_array).collect();
        let (radius, height) = (Formula::through(&points), points[points.len() - 1][0]);
        let finish = match args.accuracy() {
            Accuracy::Classic => {
                let surface = ClassicRevolution { line: ProfileLine { radius, slope: None }, height };
                return Ok(Body::plain(Shape::new(InFrame { surface, frame }).classic()));
            }
            Accuracy::Draft => Refinement::Bracket,
            Accuracy::Exact | Accuracy::Strict => Refinement::Root,
        };
        let surface = Revolution::new(&radius, height, finish).map_err(|fault| {
            let (what, help) = fault.message();
            Refusal { attribute: Some("points"), message: format!("has a profile {what}"), help }
        })?;
        Ok(Body::plain(AnyShape::of_packets(InFrame { surface, frame })))
    })
}
