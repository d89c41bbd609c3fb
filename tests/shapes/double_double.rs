//! The number types of the truth, compared with correctly rounded numbers of 160 bits.

use crate::oracle::rays::Random;
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use dashu_int::{IBig, UBig};
use f256::f256;
use tabray::exact::{Interval, Scalar, Wide, affine::Affine, double_double::DoubleDouble, dual::Dual};
use tabray::world::number::Number;

type Big = FBig<HalfEven, 2>;

/// The number of random arguments of each function.
const ARGUMENTS: usize = 2_000;

const BITS: usize = 160;

fn big(number: DoubleDouble) -> Big {
    let [high, low] = [number.high, number.low]
        .map(|part| Big::try_from(part).expect("finite").with_precision(BITS).value());
    high + low
}

/// Returns the relative error of a number.
fn error(number: DoubleDouble, right: &Big) -> f64 {
    let apart = (big(number) - right).to_f64().value().abs();
    apart / right.to_f64().value().abs()
}

/// Draws a random double-double number.
fn long(random: &mut Random, low: f64, high: f64) -> DoubleDouble {
    let number = DoubleDouble::from(random.between(low, high));
    number + number * random.between(-1e-17, 1e-17).into()
}

#[track_caller]
fn agrees((low, high): (f64, f64), own: impl Fn(DoubleDouble) -> DoubleDouble, right: impl Fn(&Big) -> Big) {
    let mut random = Random::new(5);
    for _ in 0..ARGUMENTS {
        let argument = long(&mut random, low, high);
        let error = error(own(argument), &right(&big(argument)));
        assert!(error < 1e-28, "{argument:?}: {:?} is {error:e} off", own(argument));
    }
}

#[track_caller]
fn agrees_of_two(
    (low, high): (f64, f64),
    own: impl Fn(DoubleDouble, DoubleDouble) -> DoubleDouble,
    right: impl Fn(&Big, &Big) -> Big,
) {
    let mut random = Random::new(6);
    for _ in 0..ARGUMENTS {
        let (a, b) = (long(&mut random, low, high), long(&mut random, low, high));
        let error = error(own(a, b), &right(&big(a), &big(b)));
        assert!(error < 1e-28, "{a:?}, {b:?}: {:?} is {error:e} off", own(a, b));
    }
}

#[test]
fn sums_products_and_quotients_agree() {
    for range in [(-1.0, 1.0), (-1e9, 1e9), (1e-12, 2e-12)] {
        agrees_of_two(range, |a, b| a + b, |a, b| a + b);
        agrees_of_two(range, |a, b| a - b, |a, b| a - b);
        agrees_of_two(range, |a, b| a * b, |a, b| a * b);
        agrees_of_two(range, |a, b| a / b, |a, b| a / b);
    }
}

#[test]
fn roots_agree_and_those_below_zero_are_zero() {
    agrees((0.0, 1.0), Scalar::sqrt, Big::sqrt);
    agrees((0.0, 1e18), Scalar::sqrt, Big::sqrt);
    assert!(Scalar::sqrt(DoubleDouble::from(-1.0)).is_zero());
}

#[test]
fn waves_agree() {
    for range in [(-1.0, 1.0), (-1e-9, 1e-9), (-200.0, 200.0), (1e6, 1e7)] {
        agrees(range, Scalar::sin, Big::sin);
        agrees(range, Scalar::cos, Big::cos);
        agrees(range, Scalar::tan, Big::tan);
    }
    // Near the zeros of the sine, most digits of the argument are lost.
    for quarters in 1..200 {
        let near = DoubleDouble::from(f64::from(quarters) * std::f64::consts::FRAC_PI_2);
        assert!(error(near.sin(), &big(near).sin()) < 1e-28, "{near:?}");
        assert!(error(near.cos(), &big(near).cos()) < 1e-28, "{near:?}");
    }
}

#[test]
fn exponentials_and_logarithms_agree() {
    agrees((-1.0, 1.0), Scalar::exp, Big::exp);
    agrees((-600.0, 600.0), Scalar::exp, Big::exp);
    agrees((1e-9, 4.0), Scalar::ln, Big::ln);
    agrees((0.999_999, 1.000_001), Scalar::ln, Big::ln);
    agrees((1.0, 1e200), Scalar::ln, Big::ln);
    assert!(DoubleDouble::from(-3600.0).exp().is_zero());
}

#[test]
fn angles_agree() {
    for range in [(-1.0, 1.0), (-1e-9, 1e-9), (1.0, 1e200), (-1e200, -1.0)] {
        agrees_of_two(range, Scalar::atan2, |y, x| y.atan2(x));
    }
}

#[test]
fn powers_agree() {
    agrees_of_two((1e-3, 20.0), Scalar::pow, |base, exponent| base.powf(exponent));
    for exponent in [-3, -1, 0, 1, 2, 5, 30] {
        agrees((-9.0, 9.0), |base| base.powi(exponent), |base| base.powi(exponent.into()));
    }
}

#[test]
fn the_least_greatest_and_whole_numbers_are_exact() {
    let mut random = Random::new(7);
    for _ in 0..ARGUMENTS {
        let (a, b) = (long(&mut random, -3.0, 3.0), long(&mut random, -3.0, 3.0));
        assert_eq!(big(a.floor()), big(a).floor());
        assert_eq!(a.min(b) + a.max(b), a + b);
        assert!(a.min(b) <= a.max(b));
        assert!(!a.abs().is_negative() && (a.abs() - a).is_zero() != a.is_negative());
        assert_eq!(a.step().is_zero(), a.is_negative());
    }
    let below = DoubleDouble::difference(2.0, 1e-30);
    assert_eq!(below.floor(), 1.0.into());
    assert_eq!(DoubleDouble::difference(2.0, -1e-30).floor(), 2.0.into());
}

type Bounds = fn(Interval) -> Interval;
type Exact = fn(DoubleDouble) -> DoubleDouble;

/// The bounds used by proofs contain the true results.
#[test]
fn intervals_hold_the_true_results() {
    let functions: [(&str, (f64, f64), Bounds, Exact); 9] = [
        ("sin", (-30.0, 30.0), Scalar::sin, Scalar::sin),
        ("cos", (-30.0, 30.0), Scalar::cos, Scalar::cos),
        ("tan", (-1.5, 1.5), Scalar::tan, Scalar::tan),
        ("exp", (-50.0, 50.0), Scalar::exp, Scalar::exp),
        ("ln", (1e-3, 50.0), Scalar::ln, Scalar::ln),
        ("sqrt", (0.0, 50.0), Scalar::sqrt, Scalar::sqrt),
        ("abs", (-3.0, 3.0), Scalar::abs, Scalar::abs),
        ("cube", (-9.0, 9.0), |x| x.powi(3), |x| x.powi(3)),
        ("inverse", (0.1, 9.0), |x| Interval::constant(1.0) / x, |x| DoubleDouble::from(1.0) / x),
    ];
    let mut random = Random::new(8);
    for (name, (low, high), bounds, exact) in functions {
        for _ in 0..20 * ARGUMENTS {
            let inside = random.between(low, high);
            let width = 0.1_f64.powi(random.below(18) as i32);
            let piece = Interval {
                low: (inside - width * random.between(0.0, 1.0)).max(low),
                high: (inside + width * random.between(0.0, 1.0)).min(high),
            };
            let (bounds, exact) = (bounds(piece), exact(inside.into()));
            let held = exact >= bounds.low.into() && exact <= bounds.high.into();
            assert!(held, "{name} of {inside:?} in {piece:?}: {exact:?} not in {bounds:?}");
        }
    }
}

/// The angles of a box are bounded by those whose sines and cosines, with 237 bits, lie on the two sides of each point.
#[test]
fn intervals_hold_the_true_angles() {
    let mut random = Random::new(9);
    for _ in 0..20 * ARGUMENTS {
        let width = 0.1_f64.powi(random.below(18) as i32);
        let mut around = |least: f64, most: f64| {
            let inside = random.between(least, most);
            let (less, more) = (width * random.between(0.0, 1.0), width * random.between(0.0, 1.0));
            (inside, Interval { low: inside - less, high: inside + more })
        };
        let [(x, columns), (y, rows), (sine, sines)] =
            [around(-3.0, 3.0), around(-3.0, 3.0), around(-1.0, 1.0)];
        let angles = rows.atan2(columns);
        // Positive where the point lies to the left of a direction.
        let left = |angle: f64| {
            let (sine, cosine) = f256::from(angle).sin_cos();
            f256::from(y) * cosine - f256::from(x) * sine
        };
        let zero = f256::from(0.0);
        let is_turn = angles.width() > std::f64::consts::TAU;
        let held = left(angles.low) >= zero && left(angles.high) <= zero;
        assert!(is_turn || held, "({x:?}, {y:?}) is not within {angles:?}");

        let angles = sines.asin();
        let [least, most] = [angles.low, angles.high].map(|angle| f256::from(angle).sin_cos().0);
        let is_turn = angles.width() > std::f64::consts::TAU;
        let held = is_turn || least <= f256::from(sine) && f256::from(sine) <= most;
        assert!(held, "the angle of {sine:?} is not within {angles:?}");
    }
    let [above, across] = [Interval { low: 1e-300, high: 1.0 }, Interval { low: -1.0, high: 1e-300 }];
    let left = Interval { low: -2.0, high: -1.0 };
    assert!(above.atan2(left).low > 2.0 && across.atan2(left).width() > std::f64::consts::TAU);
}

/// What is chosen by a number that may have either sign is bounded in both ways, and so are its slopes.
#[test]
fn bounds_hold_what_is_chosen() {
    let mut random = Random::new(10);
    for _ in 0..20 * ARGUMENTS {
        let inside = random.between(-1.0, 1.0);
        let width = 0.1_f64.powi(random.below(18) as i32);
        let [less, more] = [0, 1].map(|_| width * random.between(0.0, 1.0));
        let piece = Interval { low: inside - less, high: inside + more };
        let exact = if inside < 0.0 { -3.0 * inside } else { 2.0 + inside * inside };
        let chosen = piece.choose(piece.powi(2).shifted(2.0), piece.scaled(-3.0));
        assert!(chosen.low <= exact && exact <= chosen.high, "{inside:?} in {piece:?}: {chosen:?}");
        let affine = Affine::from(piece);
        let range = affine.choose(affine.powi(2).shifted(2.0), affine.scaled(-3.0)).range();
        assert!(range.low <= exact && exact <= range.high, "{inside:?} in {piece:?}: {range:?}");
        let dual = Dual::variable(piece);
        let slope = dual.choose(dual.powi(2).shifted(2.0), dual.scaled(-3.0)).slope;
        let exact = if inside < 0.0 { -3.0 } else { 2.0 * inside };
        assert!(slope.low <= exact && exact <= slope.high, "{inside:?} in {piece:?}: {slope:?}");
        assert!(!piece.has_zero() || !slope.is_bounded(), "the jump has no slope: {piece:?} {slope:?}");
    }
    // What is not chosen need not be defined.
    let positive = Interval { low: 0.5, high: 1.0 };
    assert_eq!(positive.choose(positive, (-positive).ln()), positive);
}

/// Converts a number of 237 bits, exactly.
fn widest(of: f256) -> Bits {
    let (sign, exponent, (high, low)) = of.as_sign_exp_signif();
    let whole = (UBig::from(high) << 128) + UBig::from(low);
    let whole = if sign == 0 { IBig::from(whole) } else { -IBig::from(whole) };
    Bits::from_parts(whole, exponent as isize)
}

type Bits = FBig<HalfEven, 2>;

/// Asserts that an interval of 237 bits contains a number of 400 bits, and is no wider than this many ulps.
#[track_caller]
fn holds(interval: Wide, right: &Bits, units: f64, what: &str) {
    let [low, high] = interval.ends().map(widest);
    assert!(low <= *right && *right <= high, "{what}: {interval:?} does not hold {right}");
    let width = ((high - low) / right).to_f64().value().abs();
    assert!(width <= units * 2_f64.powi(-236), "{what}: {width:e} wide");
}

#[test]
fn wide_intervals_hold_the_right_results() {
    const BITS: usize = 400;
    let mut random = Random::new(9);
    let exactly = |of: f256| widest(of).with_precision(BITS).value();
    for _ in 0..300 {
        // All digits of an argument are random.
        let mut number = |low: f64, high: f64| {
            let part = f256::from(random.between(1.0, 2.0)) / f256::from(random.between(1.0, 2.0));
            f256::from(random.between(low, high)) * part
        };
        let (a, b) = (number(-9.0, 9.0), number(-9.0, 9.0));
        let (x, y) = (Wide::point(a.into()), Wide::point(b.into()));
        let (big_a, big_b) = (exactly(a), exactly(b));
        // A sum with cancellation is exact, and any other sum is within one ulp.
        let [low, high] = (x + y).ends().map(widest);
        assert!(low <= &big_a + &big_b && &big_a + &big_b <= high, "{a} + {b}");
        holds(x * y, &(&big_a * &big_b), 4.0, "product");
        holds(x / y, &(&big_a / &big_b), 4.0, "quotient");
        holds(x.powi(2), &(&big_a * &big_a), 4.0, "square");
        let (p, q) = (number(1e-3, 90.0), number(0.1, 3.0));
        let (wide, big) = (Wide::point(p.into()), exactly(p));
        holds(wide.sqrt(), &big.sqrt(), 4.0, "square root");
        // Where a logarithm or a sine is near 0, its ulps are small.
        holds(wide.exp(), &big.exp(), 40.0, "exp");
        holds(wide.ln(), &big.ln(), 40.0, "ln");
        holds(wide.sin(), &big.sin(), 40.0, "sin");
        holds(wide.cos(), &big.cos(), 40.0, "cos");
        holds(wide.tan(), &big.tan(), 40.0, "tan");
        holds(y.atan2(x), &big_b.atan2(&big_a), 80.0, "angle");
        // The second end of a narrow interval follows from the first.
        for power in [-33, -40, -80, -160, -234] {
            let end = p + p * q * f256::from(2_f64.powi(power - 8));
            let (narrow, big_end) = (Wide { low: p.into(), high: end.into() }, exactly(end));
            for (bounds, ends) in
                [(narrow.exp(), [big.exp(), big_end.exp()]), (narrow.ln(), [big.ln(), big_end.ln()])]
            {
                let [low, high] = bounds.ends();
                let size = Wide { low: p.into(), ..bounds }.magnitude();
                let [_, size] = Wide::point(size).ends();
                let is_tight = high - low < f256::from(1e3) * (end - p + p * f256::EPSILON) * size;
                let [low, high] = [low, high].map(widest);
                let holds = ends.iter().all(|end| low <= *end && *end <= high);
                assert!(holds && is_tight, "{narrow:?}: {bounds:?}");
            }
        }
        let chosen = if big_a >= big_b { &big_a * &big_b } else { &big_a / &big_b };
        holds((x - y).choose(x * y, x / y), &chosen, 4.0, "choice");
        let power = (exactly(q) * big.ln()).exp();
        // The error of the logarithm is multiplied by the exponent.
        holds(wide.pow(Wide::point(q.into())), &power, 1000.0, "power");
    }
}

/// An interval that ends at a pole has a bound on one side, and a bounded function of it has bounds on both sides.
#[test]
fn poles_have_one_sided_bounds() {
    let n = |value: f64| <Interval>::constant(value);
    let from_zero = Interval { low: 0.0, high: 2.0 };
    let inverse = n(1.0) / from_zero;
    assert!(inverse.low > 0.49 && inverse.high == f64::INFINITY, "{inverse:?}");
    let capped = n(2.0).min(inverse);
    assert!(capped.low > 0.49 && capped.high == 2.0, "{capped:?}");
    let inverse = n(-1.0) / from_zero;
    assert!(inverse.low == f64::NEG_INFINITY && inverse.high < -0.49, "{inverse:?}");
    assert_eq!(n(1.0) / Interval { low: -1.0, high: 1.0 }, Interval::WHOLE);
    let ln = n(0.2).max(from_zero.ln());
    assert!(ln.low == 0.2 && ln.high > 0.69 && ln.high < 0.7, "{ln:?}");
    let power = from_zero.pow(from_zero);
    assert!(power.low == 0.0 && power.high >= 4.0 && power.high < 4.1, "{power:?}");
}
