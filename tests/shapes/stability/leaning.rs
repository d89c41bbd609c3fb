//! Surfaces of revolution about any axis, from near and from afar, compared with exact results: the ray as it is, the
//! axis along the scene's direction, and quadratic equations in 300 bits.

use super::{Random, shape, words};
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use glam::{DVec3, dvec3};
use tabray::geometry::{MISS, Ray, RayRange};

type Real = FBig<HalfEven>;

fn real(value: f64) -> Real {
    Real::try_from(value).expect("a finite number").with_precision(300).value()
}

fn dot(a: &[Real; 3], b: &[Real; 3]) -> Real {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn reals(vector: DVec3) -> [Real; 3] {
    vector.to_array().map(real)
}

/// A surface of revolution about any axis, whose profile squared is `c + b y + a y^2`.
struct Turned {
    square: [f64; 3],
    height: f64,
    base: DVec3,
    axis: DVec3,
}

impl Turned {
    /// Returns the coefficients of a ray's equation `a t^2 + 2 b t + c`, and of its height `start + rise t`.
    fn equation(&self, ray: &Ray) -> ([Real; 3], [Real; 2]) {
        let axis = reals(self.axis);
        let length = dot(&axis, &axis).sqrt();
        let (origin, base, dir) = (reals(ray.origin), reals(self.base), reals(ray.dir));
        let from = [0, 1, 2].map(|axis| &origin[axis] - &base[axis]);
        let (start, rise) = (dot(&from, &axis) / &length, dot(&dir, &axis) / &length);
        let [c0, c1, c2] = self.square.map(real);
        let half = real(0.5);
        let a = dot(&dir, &dir) - &rise * &rise - &c2 * &rise * &rise;
        let b = dot(&from, &dir) - &start * &rise - &half * &c1 * &rise - &c2 * &start * &rise;
        let c = dot(&from, &from) - &start * &start - &c0 - &c1 * &start - &c2 * &start * &start;
        ([a, b, c], [start, rise])
    }

    /// Returns the roots that are ahead and on the surface, in order, and whether any root is so close to a rim that
    /// rounding decides whether its height is on the surface.
    fn hits(&self, ray: &Ray) -> (Vec<Real>, bool) {
        let ([a, b, c], [start, rise]) = self.equation(ray);
        let discriminant = &b * &b - &a * &c;
        if discriminant < real(0.0) {
            return (Vec::new(), false);
        }
        let root = discriminant.sqrt();
        let mut roots = vec![(-&b - &root) / &a, (&root - &b) / &a];
        if roots[0] > roots[1] {
            roots.swap(0, 1);
        }
        let height = |t: &Real| (&start + &rise * t).to_f64().value();
        let is_rim = |t: &Real| height(t).abs().min((height(t) - self.height).abs()) < 1e-12;
        let rim = roots.iter().any(is_rim);
        roots.retain(|t| *t > real(0.0) && (0.0..=self.height).contains(&height(t)));
        (roots, rim)
    }

    /// Returns the distance from the surface of the point at a distance along the ray, to first order.
    fn off_surface(&self, ray: &Ray, distance: f64) -> f64 {
        let ([a, b, c], [start, rise]) = self.equation(ray);
        let t = real(distance);
        let value = (&a * &t * &t + real(2.0) * &b * &t + c).to_f64().value();
        let y = (start + rise * t).to_f64().value();
        let [c0, c1, c2] = self.square;
        let radius = (c0 + y * (c1 + y * c2)).abs().sqrt();
        (value / (2.0 * radius).hypot(c1 + 2.0 * c2 * y)).abs()
    }

    /// Returns a point of the surface and the normal there, rounded.
    fn place(&self, random: &mut Random) -> (DVec3, DVec3) {
        let up = self.axis.normalize();
        let (across, away) = up.any_orthonormal_pair();
        let y = random.between(0.1, 0.9) * self.height;
        let turn = random.between(0.0, std::f64::consts::TAU);
        let out = turn.cos() * across + turn.sin() * away;
        let [c0, c1, c2] = self.square;
        let radius = (c0 + y * (c1 + y * c2)).sqrt();
        let normal = radius * out - 0.5 * (c1 + 2.0 * c2 * y) * up;
        (self.base + y * up + radius * out, normal.normalize())
    }
}

const LINES: [(&str, [f64; 3]); 4] = [
    ("1.5", [2.25, 0.0, 0.0]),
    ("2 - y/4", [4.0, -1.0, 0.0625]),
    ("sqrt(4 - (y-2)^2)", [0.0, 4.0, -1.0]),
    ("sqrt(1 + (y-2)^2)", [5.0, -4.0, 1.0]),
];

/// Rays pass a surface at 1e-2 to 1e-15 from tangency, or anywhere near it, from 1 to 1e9 away.
#[test]
fn leaning_surfaces_are_met_where_the_real_numbers_have_it() {
    let mut random = Random(14);
    let (mut hits, mut misses, mut off) = (0, 0, 0.0_f64);
    for turn in 0..80 {
        let (profile, square) = LINES[turn % LINES.len()];
        let axis = match turn % 5 {
            0 => dvec3(0.0, 1.0, 0.0),
            1 => dvec3(0.0, 0.2, 1.0),
            _ => dvec3(random.between(-9.0, 9.0), random.between(-9.0, 9.0), random.between(-9.0, 9.0)),
        };
        let base = dvec3(random.between(-9.0, 9.0), random.between(-9.0, 9.0), random.between(-9.0, 9.0));
        let turned = Turned { square, height: 4.0, base, axis };
        let found = shape(&format!(
            "revsurf r {{ material m profile \"{profile}\" direction {} base {} height 4 }}",
            words(axis),
            words(base)
        ));
        for index in 0..500 {
            let (at, normal) = turned.place(&mut random);
            let away = 10.0_f64.powf(random.between(0.0, 9.0));
            let apart = 10.0_f64.powf(-random.between(2.0, 15.0));
            let apart = if index % 2 == 0 { apart } else { -apart };
            let lean = if index % 3 == 0 { random.between(0.0, 1.0) } else { 0.0 };
            let dir = random.around(normal, -lean);
            let ray = Ray { origin: at + apart * normal - away * dir, dir };
            let (truth, is_rim) = turned.hits(&ray);
            if is_rim {
                continue;
            }
            let distance = found.distance(&ray, &RayRange::ALL);
            assert_eq!(
                truth.is_empty(),
                distance == MISS,
                "{profile} along {axis}: {ray:?} ({apart:e}, {away:e}): {distance}, not {:?}",
                truth.first().map(|t| t.to_f64().value())
            );
            let Some(first) = truth.first() else {
                misses += 1;
                continue;
            };
            // The distance belongs to the first of the true hits.
            let apart = |t: &Real| (t.to_f64().value() - distance).abs();
            assert!(
                truth.iter().all(|other| apart(first) <= apart(other) + 1e-7),
                "{profile} along {axis}: {ray:?}: {distance}, not {first}"
            );
            let ulp = distance.next_up() - distance;
            off = off.max(turned.off_surface(&ray, distance) - ulp);
            hits += 1;
        }
    }
    println!("{hits} hits, {misses} misses, off the surface by at most an ulp of the distance and {off:e}");
    assert!(hits > 16_000 && misses > 4_000 && off < 1e-14, "{hits} {misses} {off:e}");
}
