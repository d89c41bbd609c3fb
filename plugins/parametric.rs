//! A surface by formulas of its coordinates in u and v.

use tabray::prelude::*;

static X: Pparm<PatchField> =
    Pparm::required("x", "the x of the point of u and v").unit("world units").short();
static Y: Pparm<PatchField> = Pparm::required("y", "its y").unit("world units").short();
static Z: Pparm<PatchField> = Pparm::required("z", "its z").unit("world units").short();
static U: Pparm<[f64; 2]> =
    Pparm::required("u", "the least and the greatest u").must("rising by at most a million", rises);
static V: Pparm<[f64; 2]> =
    Pparm::required("v", "the least and the greatest v").must("rising by at most a million", rises);
static CENTER: Pparm<DVec3> = Pparm::or("center", "the origin of these coordinates", DVec3::ZERO)
    .alias(&["centre"])
    .unit("world coordinates");

const TABLE: Table = &[&X, &Y, &Z, &U, &V, &CENTER];

/// A wider rectangle has to be halved so often near a ray that a pixel takes seconds.
const WIDEST: f64 = 1e6;

fn rises([low, high]: &[f64; 2]) -> bool {
    low < high && high - low <= WIDEST
}

inventory::submit! {
    Entity::shape("parametric", "a surface by formulas of its coordinates in u and v", &[TABLE], |args| {
        let surface = Surface {
            at: PointField::new([args.get(&X), args.get(&Y), args.get(&Z)]),
            ends: [args.get(&U), args.get(&V)],
            center: args.get(&CENTER),
        };
        Body::parametric(surface).ok_or(Refusal {
            attribute: None,
            message: "has formulas that are unbounded in the range of u and v, or that turn there too often".to_owned(),
            help: "a quotient by 0, a logarithm of 0 and a tangent have no bounds; change the formulas, or the ends of `u` and `v`",
        })
    })
}

struct Surface {
    at: PointField,
    ends: [[f64; 2]; 2],
    center: DVec3,
}

impl Parametric for Surface {
    fn point<N: Scalar>(&self, uv: [N; 2]) -> [N; 3] {
        let at = self.at.at(uv);
        per_axis(|axis| at[axis] + N::constant(self.center[axis]))
    }

    fn as_written<F: Float>(&self, uv: [Interval<F>; 2]) -> Option<[Interval<F>; 3]> {
        let seen = [0, 1, 2].map(|axis| self.at.each()[axis].written::<F>().at(&uv));
        let is_defined = seen.iter().all(|seen| seen.is_defined() != Some(false));
        let place = |axis: usize| {
            Interval { low: seen[axis].low, high: seen[axis].high } + Interval::constant(self.center[axis])
        };
        is_defined.then(|| per_axis(place))
    }

    fn ends(&self) -> [[f64; 2]; 2] {
        self.ends
    }
}
