//! The steps that a search takes, counted by the evaluations of the surface.

use super::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::{AtomicUsize, Ordering};
use tabray_exact::dual::Dual;
use tabray_exact::interval::Fraction;
use tabray_exact::scalar::Scalar;

/// A torus that counts how often it is evaluated, in doubles and in 237 bits.
struct Torus {
    ends: [[f64; 2]; 2],
    counts: &'static [AtomicUsize; 2],
}

impl Parametric for Torus {
    fn point<N: Scalar>(&self, [u, v]: [N; 2]) -> [N; 3] {
        let is_long = size_of::<N>() > size_of::<Dual<Interval>>();
        self.counts[usize::from(is_long)].fetch_add(1, Ordering::Relaxed);
        let out = N::constant(2.0) + v.cos();
        [out * u.cos(), v.sin(), out * u.sin()]
    }

    fn ends(&self) -> [[f64; 2]; 2] {
        self.ends
    }
}

/// Where rays along -x start that touch the torus, or nearly so: at its least and greatest z, in the plane of its top, and
/// at last along the circle where that plane touches it.
const TOUCHING: [[f64; 3]; 7] = [
    [10.0, 0.0, -2.999999999999999],
    [10.0, 0.0, -3.0],
    [10.0, 0.0, 3.0 - 1e-9],
    [10.0, 1.0, 0.3],
    [10.0, 1.0 - 1e-15, 0.3],
    [10.0, 1.0, 0.0],
    [10.0, 1.0, 2.0],
];

/// Once round, a part of the torus, and three times round, where each point has nine pairs of u and v.
const ENDS: [[[f64; 2]; 2]; 3] =
    [[[0.0, 6.3], [0.0, 6.3]], [[2.0, 6.8], [-0.4, 5.1]], [[-10.0, 10.0], [-10.0, 10.0]]];

/// Searches along each of these rays, and returns the evaluations in doubles by the tracer and in 237 bits by a proof.
fn evaluations() -> Vec<(String, [usize; 2])> {
    let mut all = Vec::new();
    for ends in ENDS {
        let counts: &'static [AtomicUsize; 2] = Box::leak(Box::default());
        let patches: Box<dyn Patches> = Box::new(Torus { ends, counts });
        let tree = Tree::new(&*patches, ends);
        let bounds = tree.bounds().expect("a box");
        let shape = ParametricShape { patches, tree, bounds };
        for origin in TOUCHING {
            let ray = Ray { origin: origin.into(), dir: DVec3::NEG_X };
            let line = Line { origin: constants(ray.origin), dir: constants(ray.dir) };
            counts.iter().for_each(|count| count.store(0, Ordering::Relaxed));
            shape.first_hit(&ray, &RayRange::ALL);
            let by_tracer = counts[0].load(Ordering::Relaxed);
            shape.proven_hit::<Fraction>(&line, false);
            all.push((format!("{ends:?} from {origin:?}"), [by_tracer, counts[1].load(Ordering::Relaxed)]));
        }
    }
    all
}

/// A step evaluates the surface twice: its points with their derivatives, and the point in the middle. Parts that are cut,
/// and hits, take more.
#[test]
fn rays_that_touch_a_surface_take_a_limited_number_of_steps() {
    for (ray, [by_tracer, by_proof]) in evaluations() {
        assert!(by_tracer < 7000, "{ray}: {by_tracer} evaluations");
        assert!(by_proof < 6000, "{ray}: {by_proof} evaluations in 237 bits");
    }
}

/// What is behind the first narrow place that may be hit needs no answer.
#[test]
fn a_ray_that_touches_a_surface_at_a_point_is_soon_answered() {
    for (index, (ray, [by_tracer, _])) in evaluations().into_iter().enumerate() {
        let (round, touching) = (index / TOUCHING.len(), index % TOUCHING.len());
        let is_at_point = round < 2 && touching < TOUCHING.len() - 1;
        assert!(!is_at_point || by_tracer < 1000, "{ray}: {by_tracer} evaluations");
    }
}

/// All parts are as near as any other to a point whose error is larger than the surface.
#[test]
fn a_point_that_may_be_anywhere_is_located_in_one_part() {
    let counts: &'static [AtomicUsize; 2] = Box::leak(Box::default());
    let patches: Box<dyn Patches> = Box::new(Torus { ends: ENDS[0], counts });
    let tree = Tree::new(&*patches, ENDS[0]);
    let shape = ParametricShape { bounds: tree.bounds().expect("a box"), patches, tree };
    counts[0].store(0, Ordering::Relaxed);
    assert!(shape.is_near(DVec3::new(1e60, -9.0, 0.0), 1e60));
    assert!(!shape.is_near(DVec3::new(1e60, -9.0, 0.0), 1e50));
    let count = counts[0].load(Ordering::Relaxed);
    assert!(count < 100, "{count} evaluations");
}

/// Boy's surface, as Bryant and Kusner parametrize it, and the number of its evaluations.
struct Boy(&'static AtomicUsize);

impl Parametric for Boy {
    fn point<N: Scalar>(&self, [u, v]: [N; 2]) -> [N; 3] {
        self.0.fetch_add(1, Ordering::Relaxed);
        let (root, double) = (N::constant(2.0).sqrt(), |angle: N| angle.scaled(2.0));
        let over = N::constant(2.0) - root * u.scaled(3.0).sin() * double(v).sin();
        let squared = v.cos() * v.cos();
        let x = root * squared * double(u).cos() + u.cos() * double(v).sin();
        let z = root * squared * double(u).sin() - u.sin() * double(v).sin();
        [x / over, squared.scaled(3.0) / over, z / over]
    }

    fn ends(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [0.0, PI]]
    }
}

/// Most of the parts that a ray comes near are told apart by what is already known of them.
#[test]
fn rays_at_a_surface_that_crosses_itself_evaluate_it_seldom() {
    let count: &'static AtomicUsize = Box::leak(Box::default());
    let patches: Box<dyn Patches> = Box::new(Boy(count));
    let tree = Tree::new(&*patches, Boy(count).ends());
    let bounds = tree.bounds().expect("a box");
    let shape = ParametricShape { patches, tree, bounds };
    let origin = DVec3::new(4.0, 3.5, 6.0);
    let cast = || {
        count.store(0, Ordering::Relaxed);
        let hits = (0..10_000).filter(|index| {
            let [x, y] = [index % 100, index / 100].map(|place| f64::from(place) / 25.0 - 2.0);
            let dir = (DVec3::new(x, y + 1.2, -0.7 * x) - origin).normalize();
            let FirstHit { distance, is_certain } = shape.first_hit(&Ray { origin, dir }, &RayRange::ALL);
            assert!(is_certain, "{x} {y}");
            distance != MISS
        });
        (hits.count(), count.load(Ordering::Relaxed))
    };
    let [first, second] = [cast(), cast()];
    assert_eq!(first.0, second.0);
    assert!(first.0 > 4000, "{first:?}");
    // It is 32 a ray where each part is evaluated anew.
    assert!(first.1 < 20 * 10_000 && second.1 < 15 * 10_000, "{first:?} {second:?}");
}
