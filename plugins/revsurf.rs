//! A surface of revolution: a profile curve rotated around an axis.

use std::sync::Arc;
use tabray::prelude::*;
use tabray::shapes::{ClassicRevolution, InFrame, Refinement, Revolution};

static SURFER: Pparm<Option<&'static Profile>> =
    Pparm::or("surfer", "the profile curve, by the notes' number or by its name", None);
static PROFILE: Pparm<Option<Arc<Formula>>> = Pparm::or(
    "profile",
    "the profile curve as a formula, in place of `surfer` (the distance from the axis at each height y)",
    None,
);
static DIRECTION: Pparm<DVec3> =
    Pparm::required("direction", "the direction of the axis, upward from `base`").nonzero();
static BASE: Pparm<DVec3> =
    Pparm::required("base", "the point on the axis at height 0").unit("world coordinates");
static HEIGHT: Pparm<f64> = Pparm::required("height", "the height of the surface along its axis")
    .unit("world units")
    .positive()
    .not_dumped();

static CURVE: OneOf = OneOf { meaning: "the profile curve", names: &["surfer", "profile"] };

const TABLE: Table = &[&SURFER, &PROFILE, &CURVE, &DIRECTION, &BASE, &HEIGHT];

inventory::submit! {
    Entity::shape("revsurf", "a surface of revolution, such as a cone, a vase or a column", &[TABLE], |args| {
        let frame = Frame::around(args.get(&BASE), args.get(&DIRECTION));
        let (line, height) = (line(args), args.get(&HEIGHT));
        let finish = match args.accuracy() {
            Accuracy::Classic => {
                return Ok(Body::plain(Shape::new(InFrame { surface: ClassicRevolution { line, height }, frame }).classic()));
            }
            Accuracy::Draft => Refinement::Bracket,
            Accuracy::Exact | Accuracy::Strict => Refinement::Root,
        };
        let surface = Revolution::new(&line.radius, height, finish).map_err(|fault| {
            let attribute = Some(if args.get(&SURFER).is_some() { "surfer" } else { "profile" });
            let (what, help) = fault.message();
            Refusal { attribute, message: format!("has a profile {what}"), help }
        })?;
        Ok(Body::plain(AnyShape::of_packets(InFrame { surface, frame })))
    })
}

/// Returns the profile curve that an entity names or gives as a formula.
fn line(args: &Args) -> ProfileLine {
    let formula = args.get(&PROFILE).map(|formula| ProfileLine { radius: (*formula).clone(), slope: None });
    let named = args.get(&SURFER).map(Profile::line);
    named.or(formula).expect("the table holds that one of them is given")
}
