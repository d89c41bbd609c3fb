//! The six mistakes of the prototype.

use super::profiles::{FLANGE, Line, NASTY, STAIR, VASE};
use super::{Random, distance};
use glam::{DVec3, dvec3};
use tabray::geometry::{MISS, Ray, Side, Span};
use tabray::interval::Interval;

/// Lesson 1: a rounding margin of 32 eps R^2 for q forgets that the rounding of y comes in by the slope of g.
#[test]
fn a_margin_for_rounding_knows_the_slope() {
    let flat_margin = 32.0 * f64::EPSILON * NASTY.widest * NASTY.widest;
    let ripples = NASTY.shape();
    let mut worst = 0.0_f64;
    // Each ray dips into a ripple for some 1e-4 and less; nearby its q is this.
    for (eye, dir, truth, near, q) in [
        (
            dvec3(17.265_563_980_938_73, 6.020_514_752_678_376, -9.194_359_506_659_884),
            dvec3(-0.905_502_367_267_440_3, -0.026_756_415_943_405_908, 0.423_496_816_348_028_3),
            19.705_907_982_976_448,
            19.706_092_604_378_306,
            -4.466_503_044_206_715_6e-8,
        ),
        (
            dvec3(7.034_786_946_526_704, 5.382_549_859_080_36, -6.958_818_302_729_703_5),
            dvec3(-0.650_352_761_743_648_8, -0.108_012_842_299_391_58, 0.751_913_898_788_162_8),
            10.586_654_050_059_54,
            10.586_693_500_059_54,
            -1.216_314_307_736_357_3e-9,
        ),
        (
            dvec3(2.583_376_982_136_057_7, 1.820_444_790_620_663_3, 15.976_402_972_364_316),
            dvec3(-0.165_135_896_139_890_57, 0.177_243_806_621_086_16, -0.970_213_774_804_745),
            15.315_470_619_323_554,
            15.315_417_039_323_554,
            5.311_038_000_027_031e-9,
        ),
    ] {
        worst = worst.max((NASTY.outside(eye + near * dir) - q).abs());
        let hit = distance(&*ripples, eye, dir);
        assert!((hit - truth).abs() < 1e-8, "{hit} is not {truth}");
    }
    assert!(worst > flat_margin, "{worst:e} is within {flat_margin:e}");
}

/// Lesson 2: far from where it begins, a steep parabola is a difference of large numbers.
#[test]
fn a_slab_is_right_for_a_ray_that_begins_far_from_it() {
    // Across the rim of the flange, g^2 is 5.3 - 3700 v^2. It is evaluated around s = 0, where v is -1.3.
    let (curvature, base) = (-3_700.0_f64, -1.3);
    let expanded = |s: f64| (curvature * s + 2.0 * curvature * base) * s + curvature * base * base;
    let worst = (0..100).map(|step| {
        let v = 1e-4 * f64::from(step);
        (expanded(v - base) - curvature * (v - base + base).powi(2)).abs()
    });
    assert!(worst.fold(0.0, f64::max) > 1e-13, "more than any margin for q itself");
    // Rays that are closest to the axis far above or below the disc, and enter its rim.
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

/// Lesson 3: a NaN among the products of an interval's ends vanishes in `min` and `max`, and with it the jump.
#[test]
fn an_undefined_product_is_no_proof() {
    let ends = [0.0 * f64::NEG_INFINITY, 0.0 * f64::INFINITY];
    let magnitude = ends[0].min(ends[1]).abs().max(ends[0].max(ends[1]).abs());
    assert_eq!(0.0_f64.max(magnitude), 0.0, "the error of a slab with a jump in it, as it was proven");
    let zero = Interval { low: 0.0, high: 0.0 };
    for product in [zero * Interval::WHOLE, Interval::WHOLE * zero] {
        assert!(!product.low.is_nan() && !product.high.is_nan(), "{product:?}");
        assert!(product.low <= 0.0 && product.high >= 0.0, "{product:?}");
    }
    // The camera's rays that lost a ledge of the stair by it.
    let stair = STAIR.shape();
    for (dir, truth) in [
        (
            dvec3(0.074_071_437_263_485_5, 0.204_785_738_316_695_2, -0.976_000_114_530_632_4),
            9.766_305_097_413_852,
        ),
        (
            dvec3(0.159_117_072_727_258_22, 0.257_820_711_424_380_9, -0.953_000_649_489_461),
            11.635_993_025_641_397,
        ),
        (
            dvec3(0.047_970_560_786_179_166, 0.208_453_891_416_305_88, -0.976_855_056_009_466_6),
            9.594_447_896_421_25,
        ),
    ] {
        let hit = distance(&*stair, dvec3(0.0, 3.0, 11.0), dir);
        assert!((hit - truth).abs() < 1e-12, "{hit} is not {truth} along {dir}");
    }
}

/// Lesson 4: where the error of a slab is infinite, so are both terms of its root, and their quotient is none.
#[test]
fn a_slab_without_a_bound_is_not_skipped() {
    // The part of a ray from `from` to `to` in which the lower parabola of a slab is below 0.
    let (a, b, c, from, to): (f64, f64, f64, f64, f64) = (1.0, 0.5, 0.2, 0.0, 1.0);
    let below = c - f64::INFINITY;
    let root = (b * b - a * below).sqrt();
    assert_eq!((below / (-b - root)).max(from).min(to), from, "nothing of the slab is searched");
    let stair = STAIR.shape();
    for (eye, dir, truth) in [
        (
            dvec3(0.0, 3.0, 11.0),
            dvec3(0.134_441_672_123_705_86, 0.291_713_062_155_210_76, -0.947_010_520_619_814_6),
            10.284_078_394_829_642,
        ),
        (
            dvec3(-15.660_416_586_140_448, -17.337_770_477_482_444, -15.343_150_544_138_11),
            dvec3(0.465_633_569_648_574_7, 0.739_154_626_068_835_4, 0.486_657_803_366_355_06),
            30.220_700_364_529_94,
        ),
        (
            dvec3(18.765_144_421_304_99, -20.030_976_181_811_756, 3.312_886_600_757_488),
            dvec3(-0.656_062_164_151_604_2, 0.747_959_168_446_799_9, -0.100_695_179_168_161_65),
            28.117_813_202_937_725,
        ),
    ] {
        let hit = distance(&*stair, eye, dir);
        assert!((hit - truth).abs() < 1e-12, "{hit} is not {truth} from {eye}");
    }
}

/// Lesson 5: a few ulps in which nothing can be proven hold a hit only if the sign changes in them, or q is 0 but for
/// rounding.
#[test]
fn a_jump_that_a_ray_passes_is_no_surface() {
    // Bounds of q over a jump are infinite, and so never exclude 0, however short the piece.
    let bounds = Interval { low: 1.0_f64.next_down(), high: 1.0 }.low.floor()..=1.0_f64.floor();
    assert!(bounds.contains(&0.5), "undecided for ever");
    let stair = STAIR.shape();
    for (x, side) in [(0.1, "inside"), (3.0, "outside"), (2.0_f64.next_up(), "outside")] {
        for (eye, dir) in [(dvec3(x, -5.0, 0.0), DVec3::Y), (dvec3(x, 9.0, 0.0), DVec3::NEG_Y)] {
            assert_eq!(distance(&*stair, eye, dir), MISS, "along the axis and {side}, at x = {x}");
        }
    }
    // Across two steps, and above them: out of reach of the lower one, into the side of the higher one.
    let (eye, dir) = (dvec3(10.0, 2.5, 0.0), dvec3(-8.0, 0.7, 0.0).normalize());
    let truth = 8.75 / -dir.x;
    let hit = distance(&*stair, eye, dir);
    assert!((hit - truth).abs() < 1e-14, "{hit} is not {truth}");
}

/// Lesson 6: a ray that leaves the surface enters it where q falls, and no earlier.
#[test]
fn a_ray_that_leaves_is_hit_by_the_first_entry_and_not_by_the_first_root() {
    // The start lies inside by rounding; `root` is where the ray gets out of that.
    type Case = (Line, DVec3, DVec3, f64, f64);
    let cases: [Case; 4] = [
        (
            VASE,
            dvec3(0.822_465_293_680_532_8, 3.257_539_637_415_116, 1.695_342_132_099_027_4),
            dvec3(0.092_696_723_180_290_28, 0.645_892_540_453_914_2, -0.757_779_746_164_824_4),
            1.34e-12,
            1.040_353_422_606_781_3,
        ),
        (
            VASE,
            dvec3(0.747_484_481_536_480_3, 4.725_674_049_966_937, 0.664_412_107_149_895_6),
            dvec3(-0.176_655_195_464_110_82, 0.959_722_058_604_593_7, 0.218_463_983_629_562_74),
            5.88e-13,
            8.366_930_370_656_748e-4,
        ),
        (
            NASTY,
            dvec3(0.535_689_285_307_957_5, 0.847_844_801_131_189_7, 0.474_175_446_580_489_93),
            dvec3(0.841_809_794_227_767_5, -0.150_416_993_724_367_74, -0.518_392_706_681_746),
            1.76e-13,
            1.892_590_093_098_851_6e-3,
        ),
        (
            NASTY,
            dvec3(-0.370_485_657_103_665_9, 0.478_890_284_587_250_14, 0.879_416_196_192_545_1),
            dvec3(-0.071_580_860_184_420_8, 0.151_708_585_374_717_2, -0.985_829_947_596_876_7),
            1.76e-14,
            8.780_963_933_856_201e-2,
        ),
    ];
    for (line, origin, dir, root, truth) in cases {
        let sign = |distance: f64| line.outside(origin + distance * dir) > 0.0;
        assert!(!sign(0.0) && sign(100.0 * root), "{}: the first root is next to the start", line.formula);
        let within = Span { leaves: Some(Side::Outside), ..Span::RAY };
        let hit = line.shape().distance(&Ray { origin, dir }, &within);
        // The start is rounded by an ulp, and so is where the ray comes back, by as much as it is steeper here.
        assert!((hit - truth).abs() < 1e-11, "{}: {hit} is not {truth}", line.formula);
    }
}

/// What all six lessons are for: a hit is at a change of sign, and there is none before it.
#[test]
fn a_hit_is_the_first_change_of_sign() {
    let mut random = Random(1);
    for line in [VASE, NASTY, FLANGE] {
        let shape = line.shape();
        for _ in 0..2_000 {
            // Between the ends and outside, so that no ray comes in by an end.
            let eye = dvec3(random.between(-4.0, 4.0), random.between(0.1, 6.0), 8.0);
            let dir = (dvec3(random.between(-2.0, 2.0), random.between(0.0, 6.28), 0.0) - eye).normalize();
            let hit = distance(&*shape, eye, dir);
            let outside = |distance: f64| line.outside(eye + distance * dir) > 0.0;
            let before = if hit < MISS { hit * 0.998 } else { 20.0 };
            let within = |distance: f64| (0.0..=line.height).contains(&(eye.y + distance * dir.y));
            let earlier =
                (0..500).map(|step| before * f64::from(step) / 500.0).find(|at| within(*at) && !outside(*at));
            assert_eq!(earlier, None, "{}: {hit} from {eye} along {dir}", line.formula);
            // As steep as it is here, a ray 1e-9 from its hit is above rounding.
            let steep = hit < MISS && line.normal(eye + hit * dir).dot(dir).abs() > 1e-3;
            if steep && within(hit + 1e-9) {
                assert!(
                    outside(hit - 1e-9) && !outside(hit + 1e-9),
                    "{}: {hit} from {eye} along {dir}",
                    line.formula
                );
            }
        }
    }
}
