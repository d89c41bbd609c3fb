//! The six mistakes of the prototype, each as a lesson.

use super::profiles::{FLANGE, Line, NASTY, STAIR, VASE};
use super::{Random, distance};
use glam::{DVec3, dvec3};
use tabray::exact::Interval;
use tabray::geometry::{MISS, Ray, RayRange, Side};

/// Lesson 1: a rounding margin of 32 eps R^2 for q ignores that the rounding error of y enters q multiplied by the
/// slope of g.
#[test]
fn a_margin_for_rounding_knows_the_slope() {
    let ripples = NASTY.shape();
    // Each ray dips into a ripple by some 1e-4 or less. Shortly before its hit, where q is 3e-10 to 5e-9, the rounding
    // error in f64 exceeds that margin.
    for (eye, dir, truth) in [
        (
            dvec3(17.26556398093873, 6.020514752678376, -9.194359506659884),
            dvec3(-0.9055023692674403, -0.026756415943405908, 0.4234968163480283),
            19.706119914378306,
        ),
        (
            dvec3(7.034786946526704, 5.38254985908036, -6.9588183027297035),
            dvec3(-0.6503527617436488, -0.10801284229939158, 0.7519138987881628),
            10.58665405005954,
        ),
        (
            dvec3(2.5833769821360577, 1.8204447906206633, 15.976402972364316),
            dvec3(-0.16513589613889057, 0.17724380662108616, -0.970213774804745),
            15.315470619323554,
        ),
    ] {
        let hit = distance(&*ripples, eye, dir);
        assert!((hit - truth).abs() < 1e-8, "{hit} is not {truth}");
    }
}

/// Lesson 2: far from the point about which it is expanded, a steep parabola is a difference of large numbers.
#[test]
fn a_slab_is_right_for_a_ray_that_begins_far_from_it() {
    // Across the rim of the flange, g^2 is 5.3 - 3700 v^2. Evaluated around s = 0, where v is -1.3, it has an error of
    // more than 1e-13, more than any margin for q itself. The rays here are closest to the axis far above or below the
    // disc, and enter its rim.
    let flange = FLANGE.shape();
    let mut random = Random(2);
    for _ in 0..5_000 {
        let y = 3.0 + random.between(-0.08, 0.08);
        let at = dvec3((FLANGE.radius)(y), y, 0.0);
        let angle = 10_f64.powf(-random.between(0.5, 5.0));
        let dir = random.around(-FLANGE.normal(at), angle.sin());
        let eye = at - 12.0 * dir;
        let hit = distance(&*flange, eye, dir);
        assert!(hit < 12.0 + 1e-11 / angle, "{hit} from {eye} along {dir}, at an angle of {angle:e}");
        assert!(FLANGE.off(eye + hit * dir) < 1e-13, "{hit} from {eye} along {dir}");
    }
}

/// Lesson 3: `min` and `max` drop a NaN among the products of an interval's ends, and the jump is lost with it.
#[test]
fn an_undefined_product_is_no_proof() {
    // 0 times infinity is NaN; the minimum and the maximum of two of these are NaN, and the maximum of 0 and their
    // magnitude is 0. That was the allegedly proven error of a slab with a jump in it.
    let zero = Interval { low: 0.0, high: 0.0 };
    for product in [zero * Interval::WHOLE, Interval::WHOLE * zero] {
        assert!(!product.low.is_nan() && !product.high.is_nan(), "{product:?}");
        assert!(product.low <= 0.0 && product.high >= 0.0, "{product:?}");
    }
    // These camera rays lost a ledge of the stair by that.
    let stair = STAIR.shape();
    for (dir, truth) in [
        (dvec3(0.0740714372634855, 0.2047857383166952, -0.9760001145306324), 9.766305097413852),
        (dvec3(0.15911707272725822, 0.2578207114243809, -0.953000649489461), 11.635993025641397),
        (dvec3(0.047970560786179166, 0.20845389141630588, -0.9768550560094666), 9.59444789642125),
    ] {
        let hit = distance(&*stair, dvec3(0.0, 3.0, 11.0), dir);
        assert!((hit - truth).abs() < 1e-12, "{hit} is not {truth} along {dir}");
    }
}

/// Lesson 4: where the error of a slab is infinite, so are both terms of its root, and their quotient is NaN.
#[test]
fn a_slab_without_a_bound_is_not_skipped() {
    // The part of a ray in which the lower parabola of a slab is below 0 ends at below / (-b - root), where `below` is
    // c - infinity. This is infinity over infinity, thus NaN, and `max` replaces it with the beginning of the part.
    // Nothing of the slab was searched.
    let stair = STAIR.shape();
    for (eye, dir, truth) in [
        (
            dvec3(0.0, 3.0, 11.0),
            dvec3(0.13444167212370586, 0.29171306215521076, -0.9470105206198146),
            10.284078394829642,
        ),
        (
            dvec3(-15.660416586140448, -17.337770477482444, -15.34315054413811),
            dvec3(0.4656335696485747, 0.7391546260688354, 0.48665780336635506),
            30.22070036452994,
        ),
        (
            dvec3(18.76514442130499, -20.030976181811756, 3.312886600757488),
            dvec3(-0.6560621641496052, 0.7479591684467999, -0.10069517916816165),
            28.117813202937725,
        ),
    ] {
        let hit = distance(&*stair, eye, dir);
        assert!((hit - truth).abs() < 1e-12, "{hit} is not {truth} from {eye}");
    }
}

/// Lesson 5: a range of a few ulps in which nothing can be proven contains a hit only if the sign changes in it, or if
/// q is 0 up to rounding.
#[test]
fn a_jump_that_a_ray_passes_is_no_surface() {
    // Bounds of q over a jump contain everything between its two sides, and so never exclude 0, however short the
    // range.
    let stair = STAIR.shape();
    for (x, side) in [(0.1, "inside"), (3.0, "outside"), (2.0 + 1e-12, "outside")] {
        for (eye, dir) in [(dvec3(x, -5.0, 0.0), DVec3::Y), (dvec3(x, 9.0, 0.0), DVec3::NEG_Y)] {
            assert_eq!(distance(&*stair, eye, dir), MISS, "along the axis and {side}, at x = {x}");
        }
    }
    // The ray passes two steps: above the lower one, out of its reach, and into the side of the higher one.
    let (eye, dir) = (dvec3(10.0, 2.5, 0.0), dvec3(-8.0, 0.7, 0.0).normalize());
    let truth = 8.75 / -dir.x;
    let hit = distance(&*stair, eye, dir);
    assert!((hit - truth).abs() < 1e-14, "{hit} is not {truth}");
}

/// Lesson 6: a ray that leaves the surface enters it where q falls through 0, and no earlier.
#[test]
fn a_ray_that_leaves_is_hit_by_the_first_entry_and_not_by_the_first_root() {
    // By rounding the start lies inside; `root` is where the ray comes out again.
    type Case = (Line, DVec3, DVec3, f64, f64);
    let cases: [Case; 4] = [
        (
            VASE,
            dvec3(0.8224652936805328, 3.257539637415116, 1.6953421320990274),
            dvec3(0.09269672318029028, 0.6458925404539142, -0.7577797461648244),
            1.34e-12,
            1.0403534226067814,
        ),
        (
            VASE,
            dvec3(0.7474844815364803, 4.725674049966937, 0.6644121071498956),
            dvec3(-0.17665519546411082, 0.9597220586045937, 0.21846398362956274),
            5.88e-13,
            8.366930370656748e-4,
        ),
        (
            NASTY,
            dvec3(0.5356892853079575, 0.8478448011311897, 0.47417544658048993),
            dvec3(0.8418097942277675, -0.15041699372536774, -0.518392706681746),
            1.76e-13,
            1.8925900930988516e-3,
        ),
        (
            NASTY,
            dvec3(-0.3704856571036659, 0.47889028458725014, 0.8794161961925451),
            dvec3(-0.0715808601844208, 0.1517085853747172, -0.9858299475968767),
            1.76e-14,
            0.08780963933856202,
        ),
    ];
    for (line, origin, dir, root, truth) in cases {
        let sign = |distance: f64| line.outside(origin + distance * dir) > 0.0;
        assert!(!sign(0.0) && sign(100.0 * root), "{}: the first root is next to the start", line.formula);
        let range = RayRange { origin_side: Some(Side::Outside), ..RayRange::ALL };
        let hit = line.shape().distance(&Ray { origin, dir }, &range);
        // The start is off by an ulp, and the point of return by that times the ratio of the two slopes.
        assert!((hit - truth).abs() < 1e-11, "{}: {hit} is not {truth}", line.formula);
    }
}

/// The purpose of all six lessons: a hit is at a change of sign, and there is none before it.
#[test]
fn a_hit_is_the_first_change_of_sign() {
    let mut random = Random(1);
    for line in [VASE, NASTY, FLANGE] {
        let shape = line.shape();
        for _ in 0..2_000 {
            // The eye is between the ends and outside, so that no ray comes in through an end.
            let eye = dvec3(random.between(-4.0, 4.0), random.between(0.1, 6.0), 8.0);
            let dir = (dvec3(random.between(-2.0, 2.0), random.between(0.0, 6.28), 0.0) - eye).normalize();
            let hit = distance(&*shape, eye, dir);
            let outside = |distance: f64| line.outside(eye + distance * dir) > 0.0;
            let before = if hit < MISS { hit * 0.998 } else { 20.0 };
            let range = |distance: f64| (0.0..=line.height).contains(&(eye.y + distance * dir.y));
            let earlier =
                (0..500).map(|step| before * f64::from(step) / 500.0).find(|at| range(*at) && !outside(*at));
            assert_eq!(earlier, None, "{}: {hit} from {eye} along {dir}", line.formula);
            // For a ray as steep as this, the sign is certain at 1e-9 from its hit.
            let steep = hit < MISS && line.normal(eye + hit * dir).dot(dir).abs() > 1e-3;
            if steep && range(hit + 1e-9) {
                assert!(
                    outside(hit - 1e-9) && !outside(hit + 1e-9),
                    "{}: {hit} from {eye} along {dir}",
                    line.formula
                );
            }
        }
    }
}
