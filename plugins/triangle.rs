//! A triangle.

use tabray::prelude::*;
use tabray::shapes::LooseTriangle;

static VERTEX1: Pparm<DVec3> =
    Pparm::required("vertex1", "the first vertex").known_as(&["a"]).unit("world coordinates");
static VERTEX2: Pparm<DVec3> =
    Pparm::required("vertex2", "the second vertex, counterclockwise as seen from the lit side")
        .known_as(&["b"])
        .unit("world coordinates");
static VERTEX3: Pparm<DVec3> =
    Pparm::required("vertex3", "the third vertex").known_as(&["c"]).unit("world coordinates");
// The course's program reads these two attributes and does not use them.
static NORMAL: Pparm<DVec3> =
    Pparm::or("normal", "ignored, as the vertices determine which side is lit", DVec3::Z).not_dumped();
static POINT: Pparm<DVec3> =
    Pparm::or("point", "ignored, as the vertices determine the position", DVec3::ZERO).not_dumped();

const TABLE: Table = &[&VERTEX1, &VERTEX2, &VERTEX3, &NORMAL, &POINT];

inventory::submit! {
    Entity::shape("triangle", "a triangle", &[TABLE], |args| {
        let shape = shape(args).ok_or_else(|| Refusal {
            attribute: Some("vertex3"),
            message: "has collinear vertices".to_owned(),
            help: "the vertices of a triangle must not lie on one line",
        })?;
        Ok(Body::plain(shape))
    })
}

fn shape(args: &Args) -> Option<AnyShape> {
    let (corners, end) = ([args.get(&VERTEX1), args.get(&VERTEX2), args.get(&VERTEX3)], args.planes_end_at());
    Some(match args.accuracy() {
        Accuracy::Classic => Shape::new(LooseTriangle::classic(corners, end)?).classic().into(),
        Accuracy::Draft | Accuracy::Exact => {
            Shape::new(LooseTriangle::<Exact>::new(corners, end)?).bracketed().certified().into()
        }
        Accuracy::Strict => {
            Shape::new(LooseTriangle::<Strict>::new(corners, end)?).bracketed().certified().into()
        }
    })
}
