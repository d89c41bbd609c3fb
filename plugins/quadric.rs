//! A quadric: the solutions of an equation of the second degree (the notes' "General Quadric Surfaces").

use tabray::prelude::*;
use tabray::shapes::Quadric;

static COEFFICIENTS: Pparm<[f64; 10]> = Pparm::required(
    "coefficients",
    "the coefficients A to J of Axx + Byy + Czz + Dxy + Exz + Fyz + Gx + Hy + Iz = J",
)
.each(&["A", "B", "C", "D", "E", "F", "G", "H", "I", "J"])
.must("nonzero in at least one of A to I", |c: &[f64; 10]| c[..9].iter().any(|one| *one != 0.0));
static CENTER: Pparm<DVec3> = Pparm::or("center", "the origin of the equation's coordinates", DVec3::ZERO)
    .alias(&["centre"])
    .unit("world coordinates");
static BOX: Pparm<[f64; 6]> = Pparm::or(
    "box",
    "the box that clips it, as its low and its high corner relative to `center`",
    [-1e9, -1e9, -1e9, 1e9, 1e9, 1e9],
)
.each(&["low x", "low y", "low z", "high x", "high y", "high z"])
.not_dumped();

const TABLE: Table = &[&COEFFICIENTS, &CENTER, &BOX];

inventory::submit! {
    Entity::shape("quadric", "a quadric surface, such as a cone, a cylinder or a saddle", &[TABLE], |args| {
        let [x1, y1, z1, x2, y2, z2] = args.get(&BOX);
        let (low, high) = (DVec3::new(x1, y1, z1), DVec3::new(x2, y2, z2));
        if !low.cmplt(high).all() {
            return Err(Refusal {
                attribute: Some("box"),
                message: "has an empty box".to_owned(),
                help: "the low corner must be below the high corner in x, y and z",
            });
        }
        Ok(Body::plain(shape(args, [low, high])))
    })
}

fn shape(args: &Args, corners: [DVec3; 2]) -> AnyShape {
    let (coefficients, center) = (args.get(&COEFFICIENTS), args.get(&CENTER));
    match args.accuracy() {
        Accuracy::Classic => {
            Shape::new(Quadric::<Classic>::new(coefficients, center, corners)).classic().into()
        }
        Accuracy::Draft | Accuracy::Exact => exact(Quadric::<Exact>::new(coefficients, center, corners)),
        Accuracy::Strict => exact(Quadric::<Strict>::new(coefficients, center, corners)),
    }
}

fn exact<A: NotClassic>(quadric: Quadric<A>) -> AnyShape {
    Shape::new(quadric).bracketed().certified().into()
}
