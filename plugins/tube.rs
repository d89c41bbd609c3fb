//! A tube around a curve that is given by formulas.

use std::f64::consts::TAU;
use tabray::prelude::*;

static X: Pparm<CurveField> =
    Pparm::required("x", "the x of the curve's point of t").unit("world units").short();
static Y: Pparm<CurveField> = Pparm::required("y", "its y").unit("world units").short();
static Z: Pparm<CurveField> = Pparm::required("z", "its z").unit("world units").short();
static T: Pparm<[f64; 2]> =
    Pparm::required("t", "the least and the greatest t").must("rising", |[low, high]: &[f64; 2]| low < high);
static RADIUS: Pparm<f64> =
    Pparm::required("radius", "the distance of the tube from the curve").unit("world units").positive();
static CENTER: Pparm<DVec3> = Pparm::or("center", "the origin of these coordinates", DVec3::ZERO)
    .alias(&["centre"])
    .unit("world coordinates");

const TABLE: Table = &[&X, &Y, &Z, &T, &RADIUS, &CENTER];

/// The number of places at which the direction of the curve is examined, and the number of directions to try as the one
/// to avoid.
const PLACES: u32 = 512;
const DIRECTIONS: u32 = 256;

/// The least sine of the angle between the curve and the direction that it avoids.
const MIN_SINE: f64 = 0.02;

inventory::submit! {
    Entity::shape("tube", "a tube around a curve, without ends", &[TABLE], |args| {
        let mut tube = Tube {
            at: [args.get(&X), args.get(&Y), args.get(&Z)],
            ends: args.get(&T),
            radius: args.get(&RADIUS),
            center: args.get(&CENTER),
            avoided: DVec3::Y,
        };
        let [low, high] = tube.ends;
        let place = |index: u32| low + (high - low) * f64::from(index) / f64::from(PLACES);
        let along = |index: u32| tube.curve(place(index)).map(|[_, along]| along).into();
        let along: Vec<DVec3> = (0..=PLACES).map(along).collect();
        let refusal = |message: &str, help| Refusal { attribute: None, message: message.to_owned(), help };
        if along.iter().any(|along| !(along.length() > 0.0 && along.is_finite())) {
            return Err(refusal(
                "has a curve that stands still, or is not defined, at some t",
                "its derivative by t must nowhere be 0: cut the curve there, into two tubes",
            ));
        }
        let sine = |avoided: DVec3| {
            along.iter().map(|along| along.normalize().cross(avoided).length()).fold(1.0, f64::min)
        };
        let (least, avoided) = (0..DIRECTIONS)
            .map(|index| (sine(direction(index)), direction(index)))
            .fold((0.0, DVec3::Y), |best, one| if one.0 > best.0 { one } else { best });
        if least < MIN_SINE {
            return Err(refusal(
                "has a curve that runs in nearly every direction",
                "cut the curve into two tubes, the second of which begins at the `t` where the first one ends",
            ));
        }
        tube.avoided = avoided;
        Body::parametric(tube).ok_or(refusal(
            "has formulas that are unbounded in the range of t, or that turn there too often",
            "a quotient by 0, a logarithm of 0 and a tangent have no bounds; change the formulas, or the ends of `t`",
        ))
    })
}

/// Returns one of directions that are spread over half a sphere.
fn direction(index: u32) -> DVec3 {
    let (up, turn) = (f64::from(index) / f64::from(DIRECTIONS), 2.399_963_229_728_653 * f64::from(index));
    let out = (1.0 - up * up).sqrt();
    DVec3::new(out * libm::cos(turn), up, out * libm::sin(turn))
}

struct Tube {
    at: [CurveField; 3],
    ends: [f64; 2],
    radius: f64,
    center: DVec3,
    /// A direction in which the curve nowhere runs.
    avoided: DVec3,
}

impl Tube {
    /// Returns each coordinate of the curve, and its derivative.
    fn curve<N: Scalar>(&self, t: N) -> [[N; 2]; 3] {
        per_axis(|axis| {
            let Dual { value, slope } = self.at[axis].at([Dual::variable(t)]);
            [value + N::constant(self.center[axis]), slope]
        })
    }
}

impl Parametric for Tube {
    /// Returns the point of t, and of the angle around the curve.
    fn point<N: Scalar>(&self, [t, angle]: [N; 2]) -> [N; 3] {
        let curve = self.curve(t);
        let along = curve.map(|[_, slope]| slope);
        let unit = |of: [N; 3]| {
            let length = dot(of, of).sqrt();
            of.map(|axis| axis / length)
        };
        let right = unit(cross(along, constants(self.avoided)));
        let above = cross(unit(along), right);
        let (sin, cos) = angle.sin_cos();
        per_axis(|axis| curve[axis][0] + N::constant(self.radius) * (cos * right[axis] + sin * above[axis]))
    }

    fn ends(&self) -> [[f64; 2]; 2] {
        [self.ends, [0.0, TAU]]
    }
}
