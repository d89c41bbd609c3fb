//! The first hit of a ray, for certain, from the text of a scene.

use super::closed::{self, Hit};
use super::curved::{self, Roots};
use super::dyadic::Dyadic;
use super::fast::Fast;
use super::formula::{Formula, Sides};
use super::number::{Jet, Number};
use super::ray::Ray;
use super::solid;
use super::text::{Scene, Shape, Vector};
use super::wide::Wide;
use std::cmp::Ordering;

/// The first hit of a ray.
#[derive(Debug)]
pub struct Truth {
    /// The index of the first object in the scene among those that are hit at the least distance.
    pub first: Option<usize>,
    /// The index of the material that is seen, if all objects and all parts of a solid have one of their own.
    pub material: Option<usize>,
    /// The place of the hit, as a multiple of the ray's direction.
    pub place: Option<Wide>,
    /// Whether other objects are hit at the same distance, to within 2^-200 of it.
    pub is_shared: bool,
    /// Whether the ray touches something exactly, so that either result is right.
    pub is_touch: bool,
}

pub fn first(scene: &Scene, ray: &Ray) -> Truth {
    let mut truth = Truth { first: None, material: None, place: None, is_shared: false, is_touch: false };
    for (index, shape) in scene.objects.iter().enumerate() {
        let place = match hit(shape, ray) {
            Hit::Miss => continue,
            Hit::Touch => {
                truth.is_touch = true;
                continue;
            }
            Hit::At(place) => place,
        };
        let nearer = truth.place.as_ref().map_or(Some(Ordering::Less), |nearest| order(&place, nearest));
        match nearer {
            Some(Ordering::Less) => {
                (truth.first, truth.place, truth.is_shared) = (Some(index), Some(place), false);
            }
            Some(_) => {}
            None => truth.is_shared = true,
        }
    }
    truth.material = truth.first.and_then(|first| match (&*scene.objects[first], &truth.place) {
        (Shape::Combined { shapes, is_one: false, .. }, Some(place)) => {
            shapes.iter().position(|part| solid::crossed(part, ray, place).is_some())
        }
        _ => Some(first),
    });
    truth
}

/// Returns which of two places is nearer, unless they are equal to within 2^-200 of their size.
pub fn order(one: &Wide, other: &Wide) -> Option<Ordering> {
    let apart = one.sub(other);
    let (low, high) = apart.ends()?;
    let size = other.ends()?.1.size();
    match apart.sign() {
        Some(sign @ (Ordering::Less | Ordering::Greater)) => {
            let least = if sign == Ordering::Less { high } else { low };
            (least.size() > size - 200).then_some(sign)
        }
        _ => None,
    }
}

pub fn hit(shape: &Shape, ray: &Ray) -> Hit {
    match shape {
        Shape::Plane { normal, point, sides } => closed::plane(ray, normal, point, sides.as_ref()),
        Shape::Triangle { corners } => closed::triangle(ray, corners),
        Shape::Ball { center, radius, scale } => closed::ball(ray, center, radius, scale),
        Shape::Quadric { coefficients, center, low, high } => {
            closed::quadric(ray, coefficients, center, low, high)
        }
        Shape::Revolved { profile, widest, direction, base, height } => {
            curved::revolved(ray, (profile, *widest), direction, base, height)
        }
        Shape::Torus { center, direction, radius, tube } => {
            curved::torus(ray, center, direction, radius, tube)
        }
        Shape::Heart { center, size } => curved::heart(ray, center, size),
        Shape::Formula { own, axis, formula, kept, middle, reach } => {
            curved::by_formula(ray, (own, middle, *reach), axis.as_ref(), formula, kept)
        }
        Shape::Mesh { faces } => closed::mesh(ray, faces),
        Shape::Placed { shape, place } => hit(shape, &place.own(ray)),
        Shape::Combined { .. } => solid::first(shape, ray),
    }
}

/// Returns what is known of the places at which a ray meets a formula's surface or a copy of it, where at most so many
/// pieces are looked at.
pub fn roots(shape: &Shape, ray: &Ray, most: [usize; 2]) -> Roots<Wide> {
    match shape {
        Shape::Placed { shape, place } => roots(shape, &place.own(ray), most),
        Shape::Formula { own, axis, formula, kept, middle, reach } => {
            curved::formula_roots(ray, (own, middle, *reach), axis.as_ref(), (formula, kept), most)
        }
        _ => panic!("no formula"),
    }
}

/// Tells whether a formula, or a copy of its surface, is not defined at a place of a ray.
pub fn is_undefined(shape: &Shape, ray: &Ray, place: f64) -> bool {
    match shape {
        Shape::Placed { shape, place: of } => is_undefined(shape, &of.own(ray), place),
        Shape::Formula { own, formula, .. } => {
            let there = ray.from(&Dyadic::from(place)).origin;
            let at = [0, 1, 2].map(|axis| Jet::constant(Wide::point(&there[axis].sub(&own[axis]))));
            formula.on(at.each_ref(), &mut Sides::default()).is_none()
        }
        _ => false,
    }
}

/// Returns the approximate cosine of the angle between a ray and a shape's normal at a place: an error of the distance,
/// times this, is the distance from the surface.
pub fn cosine(shape: &Shape, ray: &Ray, place: &Wide) -> f64 {
    slope(shape, ray, place).abs()
}

/// Returns that cosine, which is negative where the ray enters. Where there is no normal, it is 1.
pub fn slope(shape: &Shape, ray: &Ray, place: &Wide) -> f64 {
    let f64s = |of: &Vector| [0, 1, 2].map(|axis| of[axis].to_f64(false));
    let cosine = dot(unit(normal(shape, ray, place)), unit(f64s(&ray.dir)));
    if cosine.is_nan() { 1.0 } else { cosine }
}

/// Returns the largest coordinate that a copy's hits are computed from: those of its translation, and of its object when
/// it is scaled. 0 for a shape of its own, whose hits are as exact as the ray is.
pub fn reach(shape: &Shape) -> f64 {
    if let Shape::Combined { shapes, .. } = shape {
        return shapes.iter().map(|shape| reach(shape)).fold(0.0, f64::max);
    }
    let Shape::Placed { shape, place } = shape else { return 0.0 };
    let most = |of: &Vector| of.iter().fold(0.0, |most: f64, part| most.max(part.to_f64(false).abs()));
    let own = match &**shape {
        Shape::Mesh { faces } => faces.iter().flatten().map(most).fold(0.0, f64::max),
        Shape::Ball { center, radius, scale } => most(center) + radius.to_f64(true) * most(scale),
        shape => reach(shape),
    };
    most(&place.translation) + most(&place.scale) * own
}

/// Returns a shape's normal at a place of a ray, roughly and up to its length.
fn normal(shape: &Shape, ray: &Ray, at: &Wide) -> [f64; 3] {
    let place = at.near();
    let near = |from: &Vector| ray.near(place, from);
    let f64s = |of: &Vector| [0, 1, 2].map(|axis| of[axis].to_f64(false));
    match shape {
        Shape::Plane { normal, .. } => f64s(normal),
        Shape::Triangle { corners: [a, b, c] } => {
            f64s(&super::ray::cross(&super::ray::minus(b, a), &super::ray::minus(c, a)))
        }
        Shape::Ball { center, scale, .. } => {
            let (at, scale) = (near(center), f64s(scale));
            [0, 1, 2].map(|axis| at[axis] / scale[axis] / scale[axis])
        }
        Shape::Quadric { coefficients, center, .. } => {
            let [x, y, z] = near(center);
            let k: Vec<_> = coefficients.iter().map(|of| of.to_f64(false)).collect();
            [
                2.0 * k[0] * x + k[3] * y + k[4] * z + k[6],
                2.0 * k[1] * y + k[3] * x + k[5] * z + k[7],
                2.0 * k[2] * z + k[4] * x + k[5] * y + k[8],
            ]
        }
        Shape::Revolved { profile, direction, base, height, .. } => {
            let (at, axis) = (near(base), unit(f64s(direction)));
            let y = dot(at, axis);
            let out = [0, 1, 2].map(|of| at[of] - y * axis[of]);
            let slope = slope_of(profile, y.clamp(0.0, height.to_f64(false)));
            let radius = dot(out, out).sqrt();
            [0, 1, 2].map(|of| out[of] - radius * slope * axis[of])
        }
        Shape::Torus { center, direction, radius, .. } => {
            let (at, axis) = (near(center), unit(f64s(direction)));
            let y = dot(at, axis);
            let out = [0, 1, 2].map(|of| at[of] - y * axis[of]);
            let to_circle = 1.0 - radius.to_f64(false) / dot(out, out).sqrt();
            [0, 1, 2].map(|of| out[of] * to_circle + y * axis[of])
        }
        Shape::Heart { center, size } => {
            let [x, y, z] = near(center).map(|of| of / size.to_f64(false));
            let ball = x * x + y * y + 2.25 * z * z - 1.0;
            [
                6.0 * ball * ball * x - 2.0 * x * y.powi(3),
                6.0 * ball * ball * y - 3.0 * (x * x + 0.1125 * z * z) * y * y,
                13.5 * ball * ball * z - 0.225 * z * y.powi(3),
            ]
        }
        Shape::Formula { own, axis, formula, .. } => {
            let at = near(own);
            let slopes = |at: [f64; 3]| {
                [0, 1, 2].map(|along| {
                    let number = |of: usize| Fast::exact(&Dyadic::from(at[of]));
                    let jet = |of: usize| {
                        if of == along { Jet::variable(number(of)) } else { Jet::constant(number(of)) }
                    };
                    let Fast { low, high } = formula.of([&jet(0), &jet(1), &jet(2)]).slope;
                    if (high - low).is_finite() { 0.5 * (low + high) } else { 1e6 }
                })
            };
            let Some(axis) = axis else { return slopes(at) };
            let axis = unit(f64s(axis));
            let y = dot(at, axis);
            let out = [0, 1, 2].map(|of| at[of] - y * axis[of]);
            let [by_square, by_height, _] = slopes([dot(out, out), y, 0.0]);
            [0, 1, 2].map(|of| 2.0 * by_square * out[of] + by_height * axis[of])
        }
        Shape::Mesh { faces } => {
            let [a, b, c] = &faces[closed::face(ray, faces).unwrap_or(0)];
            f64s(&super::ray::cross(&super::ray::minus(b, a), &super::ray::minus(c, a)))
        }
        Shape::Placed { shape, place } => place.world_normal(normal(shape, &place.own(ray), at)),
        Shape::Combined { .. } => match solid::crossed(shape, ray, at) {
            Some((shape, ray, at)) => normal(shape, &ray, &at),
            None => [f64::NAN; 3],
        },
    }
}

fn slope_of(profile: &Formula, y: f64) -> f64 {
    let at = Jet::variable(Fast::exact(&Dyadic::from(y)));
    let Fast { low, high } = profile.at(&at).slope;
    if (high - low).is_finite() { 0.5 * (low + high) } else { 1e6 }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(of: [f64; 3]) -> [f64; 3] {
    let most = of.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    let of = of.map(|part| part / most);
    let length = dot(of, of).sqrt();
    of.map(|part| part / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the first hit of the middle pixel, its distance, and whether it is a tie.
    fn seen(objects: &str) -> (Option<usize>, f64, bool) {
        let text = format!("camera c {{ pixeldim 1 1 worlddim 8 6 viewpoint 4 3 6 }}\n{objects}");
        let scene = Scene::read(&text, "");
        let ray = Ray::of_pixel(&scene, 0, 0);
        let truth = first(&scene, &ray);
        let distance = truth.place.as_ref().map_or(0.0, |place| ray.distance(place).near());
        (truth.first, distance, truth.is_shared || truth.is_touch)
    }

    #[test]
    fn the_oracle_knows_what_can_be_reckoned_by_hand() {
        for (objects, first, distance) in [
            ("sphere s { center 4 3 -4 radius 2 }", Some(0), 8.0),
            ("sphere s { center 4 5 -4 radius 1.9999999999999998 }", None, 0.0),
            ("sphere s { center 4 3 6 radius 2 }", Some(0), 2.0),
            ("ellipsoid e { center 4 3 -4 radius 2 scale 1 1 0.5 }", Some(0), 9.0),
            ("quadric q { coefficients 1 1 1 0 0 0 0 0 0 4 center 4 3 -4 box -2 -2 -2 2 2 3 }", Some(0), 8.0),
            (
                "quadric q { coefficients 1 1 1 0 0 0 0 0 0 4 center 4 3 -4 box -2 -2 -3 2 2 1 }",
                Some(0),
                12.0,
            ),
            ("quadric q { coefficients 0 0 0 0 0 0 0 0 1 0 center 4 3 -4 }", Some(0), 10.0),
            ("plane p { normal 0 0 3 point 9 9 -4 } plane q { normal 0 0 1 point 0 0 -3 }", Some(1), 9.0),
            ("plane p { normal 0 0 1 point 0 0 0.02 }", None, 0.0),
            ("fplane p { normal 0 0 2 point 3 2 -1 xdir 1 0 7 dimensions 2 2 }", Some(0), 7.0),
            ("fplane p { normal 0 0 2 point 4.1 2 -1 xdir 1 0 7 dimensions 2 2 }", None, 0.0),
            ("triangle t { vertex1 3 2 -1 vertex2 5 2 -1 vertex3 4 5 -1 }", Some(0), 7.0),
            ("triangle t { vertex1 3 2 -1 vertex2 5 2 -1 vertex3 4 2.9 -1 }", None, 0.0),
            ("revsurf r { profile \"2\" direction 0 5 0 base 4 0 -4 height 6 }", Some(0), 8.0),
            (
                "revsurf r { profile \"max(1, 2 - 1e14*(y-3)^2)\" direction 0 1 0 base 4 0 -4 height 6 }",
                Some(0),
                8.0,
            ),
            ("revsurf r { profile \"y^2 - 7 + exp(0)\" direction 0 1 0 base 4 0 -4 height 6 }", Some(0), 7.0),
            ("revsurf r { profile \"2 - y\" direction 0 1 0 base 4 0 -4 height 6 }", None, 0.0),
            ("implicit i { formula \"x^2 + y^2 + z^2 - 4\" center 4 3 -4 box -3 -3 -3 3 3 3 }", Some(0), 8.0),
            (
                "implicit i { formula \"x^2 + y^2 + z^2 - 4\" center 4 3 -4 box -3 -3 -3 3 3 1 }",
                Some(0),
                12.0,
            ),
            (
                "implicit i { formula \"max(abs(x), abs(z)) - y\" center 4 2 -4 box -3 -3 -3 3 3 3 }",
                Some(0),
                9.0,
            ),
            ("cylinder c { base 4 1 -4 height 4 radius 2 }", Some(0), 8.0),
            ("cylinder c { base 4 3 -5 direction 0 0 7 height 4 radius 2 }", Some(0), 7.0),
            ("cylinder c { base 4 3 -5 direction 0 0 7 height 4 radius 2 open yes }", None, 0.0),
            ("capsule c { base 4 3 -5 direction 0 0 7 height 4 radius 2 }", Some(0), 5.0),
            ("disc d { center 4 3 -4 normal 0 0 2 radius 0.1 }", Some(0), 10.0),
            ("disc d { center 4 3.2 -4 normal 0 0 2 radius 0.1 }", None, 0.0),
            ("lathe l { points 0 2  3 2  6 2  base 4 0 -4 }", Some(0), 8.0),
            ("lathe l { points 0 1  1 2  2 1  base 4 2 -4 }", Some(0), 8.0),
            ("box b { center 4 3.125 -4 size 2 2 2 }", Some(0), 9.0),
            ("prism p { points -1 0  1 0.5  1 2  -1 2  base 4 1 -4 height 3.5 }", Some(0), 8.0),
            ("torus t { center 4 3 -4 radius 2 tube 0.5 }", Some(0), 7.5),
            ("torus t { center 4 3 -4 direction 0 0 1 radius 2 tube 0.5 }", None, 0.0),
        ] {
            let (found, at, is_tie) = seen(objects);
            assert_eq!((found, is_tie), (first, false), "{objects}");
            assert!((at - distance).abs() < 1e-14, "{objects}: {at}");
        }
    }

    /// From z = 3 to z = -3, where x and y are 0, the first place at which a formula is defined and 0.
    #[test]
    fn the_oracle_knows_jumps_poles_and_the_ends_of_domains() {
        for (formula, z) in [
            ("floor(z) + 2.5", None),
            ("1/z", None),
            ("(z + 2)/y", None),
            ("sign(z - 1.5)*(z + 1)", Some(-1.0)),
            ("1/(1 + 1/(z - 1)) - 2", Some(-1.0)),
            ("sqrt(z - 1) + z", None),
            ("sqrt(z + 1) - 1", Some(0.0)),
            ("ln(z) - ln(2)", Some(2.0)),
            ("z^0.5 - 1.5", Some(2.25)),
            ("cbrt(z) + 1", Some(-1.0)),
            ("if(z >= 1, z - 2, z + 5)", Some(2.0)),
            ("if(z < 1, z, 1/(x*z))", Some(0.0)),
            ("mod(z, 2) - 0.5", Some(2.5)),
            ("mod(1/z, 4) - 3", Some(1.0 / 3.0)),
            ("atan2(z, -1) - 3", Some((std::f64::consts::PI - 3.0).tan())),
            ("atan2(y, z) - 1", None),
            ("tan(z) + 1", Some(0.75 * std::f64::consts::PI)),
            ("acos(z/2) - 1", Some(2.0 * 1.0_f64.cos())),
            ("trunc(z) + z^3/100", Some(0.0)),
            ("smin(z, z + 1, 3) + 1", Some(-1.0 + 1.0 / 3.0)),
        ] {
            let text = format!("implicit i {{ formula \"{formula}\" center 4 3 -4 box -3 -3 -3 3 3 3 }}");
            let (found, at, _) = seen(&text);
            let found = found.map(|_| 10.0 - at);
            let is_right = match (found, z) {
                (Some(found), Some(z)) => (found - z).abs() < 1e-14,
                (found, z) => found == z,
            };
            assert!(is_right, "{formula}: {found:?}");
        }
    }

    #[test]
    fn ties_are_named() {
        for objects in [
            "sphere s { center 4 5 -4 radius 2 }",
            "plane p { normal 0 0 1 point 0 0 -3 } plane q { normal 0 0 7 point 9 9 -3 }",
            "plane p { normal 0 0 1 point 0 0 -3 } sphere s { center 4 3 -4 radius 1 }",
            "triangle t { vertex1 3 2 -1 vertex2 5 2 -1 vertex3 4 3 -1 }",
            "torus t { center 4 3 -4 direction 0 0 1 radius 2 tube 2 }",
            // Where y is 0, the heart's polynomial has a triple root.
            "heart h { center 4 3 -4 size 3 }",
        ] {
            assert!(seen(objects).2, "{objects}");
        }
    }
}
