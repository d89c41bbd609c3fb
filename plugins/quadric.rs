//! A quadric: the solutions of an equation of the second degree (the notes' "General Quadric Surfaces").

use crate::prelude::*;
use crate::shapes::Quadric;

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

fn exact<A: Bounded>(quadric: Quadric<A>) -> AnyShape {
    Shape::new(quadric).bracketed().certified().into()
}

impl<A: Marker> Hittable for Quadric<A> {
    /// Returns the nearer of the two roots that lies in the box.
    #[inline(always)]
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if A::IS_CLASSIC {
            return self.classic_distance(ray, range);
        }
        let quick = self.fast_distance(ray, range);
        if quick.is_nan() { range.keep(self.exact_hit(ray, range.near)) } else { quick }
    }

    #[inline]
    fn normal(&self, at: DVec3) -> DVec3 {
        self.unit_normal(at)
    }

    fn bounds(&self) -> Option<Aabb> {
        Some(self.around())
    }

    #[inline]
    fn can_hit_itself(&self, _leaving: Side) -> bool {
        !A::IS_CLASSIC
    }

    fn openness(&self) -> Option<&'static str> {
        (!self.is_closed())
            .then_some("it is not an ellipsoid within its box whose equation is below J inside")
    }

    fn is_two_sided(&self) -> bool {
        !A::IS_CLASSIC
    }

    fn method(&self) -> String {
        Self::METHOD.to_owned()
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        Some(self.clearance_by_value(from).max(self.clearance_by_box(from)))
    }

    fn reach(&self) -> f64 {
        // The box only clips, and may be far larger than what is seen of the surface, so its corners do not count.
        self.center.abs().max_element()
    }
}

impl<A: Bounded> Bracketed for Quadric<A> {
    #[inline(always)]
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        let may_leave = range.origin_error > 0.0 && range.origin_side.is_none();
        if may_leave && self.touches(ray.origin, range.origin_error) {
            return Bracket::UNKNOWN;
        }
        Quadric::t_bounds(self, ray, range)
    }

    #[inline(always)]
    fn t_bounds_within(&self, ray: &Ray, range: &RayRange, drift: Drift) -> Bracket {
        Quadric::t_bounds_within(self, ray, range, drift)
    }

    #[inline(always)]
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.fast_distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}

impl<A: Bounded> Certified for Quadric<A> {}

impl<A> Equation for Quadric<A> {
    const IS_QUADRATIC: bool = true;

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        Quadric::value(self, at)
    }

    fn kept<N: Scalar>(&self, at: [N; 3]) -> N {
        self.inside_box(at)
    }
}
