//! Each function of the language over each operator, in all number types that proofs use: the values at points of a
//! line lie in the bounds over a piece of it, and the slopes of chords in the bounds of the derivatives.

use super::field::Field;
use super::function::functions;
use super::step::{Function, Step};
use super::tests::field;
use crate::affine::Affine;
use crate::double_double::DoubleDouble;
use crate::dual::Dual;
use crate::interval::{Float, Fraction, Interval, Wide};
use crate::jet::Jet;
use crate::scalar::{Scalar, per_axis};

/// What stands below a function: quotients, products with unbounded factors, cuts, poles, 0 times infinity, and
/// differences of infinities.
const OPERANDS: &[&str] = &[
    "x",
    "y/z",
    "1/x",
    "1/x^2",
    "x/(y*z)",
    "x/x",
    "y*(1/x)",
    "(x - y)*(1/(x - y))",
    "1/x - 1/y",
    "1/x + z",
    "x^-3*y",
    "tan(3*x)",
    "ln(x)",
    "sqrt(y)",
    "x^(1/3)",
    "cbrt(x)^-1",
    "exp(1/x)",
    "abs(1/x)",
    "floor(2*x)",
    "heaviside(x) - z",
    "if(x < y, 1/x, z)",
    "atan2(y, x)",
    "atan2(1, 1/x)",
    "min(1/x, y)",
    "mod(x, y)",
    "0*x/y",
];

/// Random numbers of a linear congruential generator, with the constants of Knuth's MMIX.
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    fn part(&mut self) -> f64 {
        self.below(1 << 30) as f64 / f64::from(1 << 30)
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

/// A piece of a line. Many go exactly through poles and ends of domains, or stay in them.
struct Piece {
    base: [f64; 3],
    dir: [f64; 3],
    low: f64,
    high: f64,
}

impl Piece {
    fn new(random: &mut Random) -> Self {
        let mut round = || {
            let other = 2.0 * random.part() - 1.0;
            random.of(&[0.0, 0.5, -1.0, other, other])
        };
        let (base, dir) = (per_axis(|_| round()), per_axis(|_| round()));
        let start = random.of(&[-1.0, -0.5, 0.0, 1.0]) * random.of(&[1.0, 0.7, 0.013]);
        Self { base, dir, low: start, high: start + random.of(&[1e-9, 1e-3, 0.1, 1.0, 2.0]) }
    }

    fn at<N: Scalar>(&self, t: N) -> [N; 3] {
        per_axis(|axis| N::constant(self.base[axis]) + N::constant(self.dir[axis]) * t)
    }
}

/// Returns the texts of all functions with an operand in each place, and of the operators.
fn texts(operand: &str) -> Vec<String> {
    let own = |place: usize, index: usize| if place == index { operand } else { ["y", "z/2", "0.7"][index] };
    let mut texts: Vec<String> =
        ["{} + x", "y - ({})", "({})*z", "x/({})", "({})/x", "({})^3", "({})^-2", "({})^0.3"]
            .iter()
            .map(|text| text.replace("{}", operand))
            .collect();
    for (name, arguments) in functions() {
        for place in 0..arguments.len() {
            let mut given: Vec<_> = (0..arguments.len()).map(|index| own(place, index).to_owned()).collect();
            if name == "if" {
                given[0] += " < 0.2";
            }
            texts.push(format!("{name}({})", given.join(", ")));
        }
    }
    texts
}

/// Evaluates the operations of a formula as it is written, or returns `None` where it is undefined or overflows.
fn defined(steps: &[Step], at: [DoubleDouble; 3]) -> Option<DoubleDouble> {
    use Function::{
        Abs, Atan2, Cos, Exp, Floor, Heaviside, If, Ln, Max, Min, Noise, Pow, Sin, Smax, Smin, Sqrt, Tan,
    };
    let zero = DoubleDouble::from(0.0);
    let mut waiting: Vec<Option<DoubleDouble>> = Vec::new();
    for step in steps {
        let mut operands = waiting.split_off(waiting.len() - step.operands());
        // The part not taken need not be defined.
        if *step == Step::Call(If) {
            let chosen = operands.remove(if operands[0].is_some_and(|of| of >= zero) { 1 } else { 2 });
            waiting.push(operands[0].and(chosen));
            continue;
        }
        let all: Option<Vec<_>> = operands.into_iter().collect();
        let value = all.and_then(|of| {
            let by = |width: DoubleDouble| {
                let apart = (width - (of[0] - of[1]).abs()).max(zero);
                apart * apart / (width * 4.0.into())
            };
            let value = match *step {
                Step::Variable(index) => at[usize::from(index)],
                Step::Number(number) => number.into(),
                Step::Neg => -of[0],
                Step::Add => of[0] + of[1],
                Step::Sub => of[0] - of[1],
                Step::Mul => of[0] * of[1],
                Step::Div if of[1] == zero => return None,
                Step::Div => of[0] / of[1],
                Step::Powi(exponent) if exponent < 0 && of[0] == zero => return None,
                Step::Powi(exponent) => of[0].powi(exponent),
                Step::Call(Sqrt) if of[0] < zero => return None,
                Step::Call(Ln) if of[0] <= zero => return None,
                Step::Call(Pow) if of[0] < zero || of[0] == zero && of[1] <= zero => return None,
                Step::Call(Atan2) if of[0] == zero && of[1] == zero => return None,
                Step::Call(Smin | Smax) if of[2] == zero => return None,
                Step::Call(Sin) => of[0].sin(),
                Step::Call(Cos) => of[0].cos(),
                Step::Call(Tan) => of[0].tan(),
                Step::Call(Exp) => of[0].exp(),
                Step::Call(Ln) => of[0].ln(),
                Step::Call(Sqrt) => of[0].sqrt(),
                Step::Call(Abs) => of[0].abs(),
                Step::Call(Floor) => of[0].floor(),
                Step::Call(Heaviside) => {
                    if of[0] < zero {
                        zero
                    } else {
                        1.0.into()
                    }
                }
                Step::Call(Min) => {
                    if of[0] < of[1] {
                        of[0]
                    } else {
                        of[1]
                    }
                }
                Step::Call(Max) => {
                    if of[0] > of[1] {
                        of[0]
                    } else {
                        of[1]
                    }
                }
                Step::Call(Pow) => of[0].pow(of[1]),
                Step::Call(Atan2) => of[0].atan2(of[1]),
                Step::Call(Smin) => of[0].min(of[1]) - by(of[2]),
                Step::Call(Smax) => of[0].max(of[1]) + by(of[2]),
                // A corner of more than 53 bits is rounded.
                Step::Call(Noise) if of.iter().any(|of| of.high.abs() > 1e9) => return None,
                Step::Call(Noise) => DoubleDouble::noise([of[0], of[1], of[2]], [0; 3]),
                Step::Call(If) | Step::Scale(_) | Step::Shift(_) | Step::Spline => {
                    unreachable!("not as written")
                }
            };
            value.high.is_finite().then_some(value)
        });
        waiting.push(value);
    }
    waiting.pop()?
}

/// Returns the value at a place with 106 bits, unless the formula is undefined there, or nearly so.
fn value(field: &Field, piece: &Piece, t: f64) -> Option<DoubleDouble> {
    let (steps, at) = (&field.formula().steps, piece.at(DoubleDouble::from(t)));
    let value = defined(steps, at)?;
    // Where an operand vanishes by rounding, as in a quotient of differences, the value is meaningless.
    let nudged = defined(steps, at.map(|axis| axis * DoubleDouble { high: 1.0, low: 1e-26 }))?;
    let is_sound =
        value.high.abs() < 1e100 && (value - nudged).high.abs() <= 1e-20 * (1.0 + value.high.abs());
    is_sound.then_some(value)
}

fn holds(bounds: Interval, of: DoubleDouble, slack: f64) -> bool {
    let slack = slack + 1e-18 * (1.0 + of.high.abs());
    bounds.low - slack <= of.high && of.high <= bounds.high + slack
}

fn bounds<N: Scalar>(of: N) -> Interval {
    let [low, high] = of.bounds();
    Interval { low, high }
}

/// Checks the bounds of one number type.
fn check<N: Scalar>(field: &Field, piece: &Piece, over: N, places: &[(f64, DoubleDouble)], what: &str) {
    let values = bounds(field.at(piece.at(over)));
    let Dual { value, slope } = field.at(piece.at(Dual::variable(over)));
    let jet = field.at(piece.at(Jet::variable(over)));
    let [of_dual, slopes, of_jet, firsts, seconds] =
        [value, slope, jet.value, jet.first, jet.second].map(bounds);
    let Piece { base, dir, low, high } = piece;
    let told = || format!("{} over {what} from {low:?} to {high:?}: {base:?} + t {dir:?}", field.formula());
    for (t, value) in places {
        for (bounds, name) in [(values, "value"), (of_dual, "dual"), (of_jet, "jet")] {
            assert!(holds(bounds, *value, 0.0), "{}: {name} {value:?} at {t} is not in {bounds:?}", told());
        }
    }
    let chord = |one: &(f64, DoubleDouble), other: &(f64, DoubleDouble)| {
        (other.1 - one.1) / DoubleDouble::difference(other.0, one.0)
    };
    for three in places.windows(3) {
        let [first, middle, last] = three else { continue };
        let (before, after) = (chord(first, middle), chord(middle, last));
        // Chords of large values, and differences of chords, have few digits on a short piece.
        let size = [first, middle, last].iter().fold(1.0, |size: f64, of| size.max(of.1.high.abs()));
        let short = (middle.0 - first.0).min(last.0 - middle.0);
        let slack = 1e-28 * size / short;
        for (bounds, values, name) in [(slopes, of_dual, "slope"), (firsts, of_jet, "first")] {
            // A jump has no chord, but its slope and its value are not both bounded.
            let is_told = bounds.is_bounded() && values.is_bounded();
            let is_held = holds(bounds, before, slack) && holds(bounds, after, slack);
            assert!(!is_told || is_held, "{}: {name} {before:?} {after:?} in {bounds:?}", told());
        }
        if of_jet.is_bounded() && firsts.is_bounded() && seconds.is_bounded() {
            let bend = (after - before) * DoubleDouble::from(2.0) / DoubleDouble::difference(last.0, first.0);
            let is_held = holds(seconds, bend, 4.0 * slack / short);
            assert!(is_held, "{}: second {bend:?} in {seconds:?}", told());
        }
    }
}

fn over<F: Float>(piece: &Piece) -> Interval<F> {
    Interval { low: F::of(piece.low), high: F::of(piece.high) }
}

#[test]
fn bounds_of_each_function_over_each_operator_hold_its_values() {
    let (mut random, mut count) = (Random(1), 0);
    for operand in OPERANDS {
        for text in texts(operand) {
            let field = field(&text);
            for round in 0..6 {
                let piece = Piece::new(&mut random);
                let mut places: Vec<_> =
                    (0..6).map(|_| piece.low + random.part() * (piece.high - piece.low)).collect();
                places.sort_by(f64::total_cmp);
                places.dedup();
                let places: Vec<_> =
                    places.into_iter().filter_map(|t| Some((t, value(&field, &piece, t)?))).collect();
                count += places.len();
                check(&field, &piece, over::<f64>(&piece), &places, "53 bits");
                if round % 4 == 0 {
                    let (low, high) = (piece.low, piece.high);
                    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
                    check(
                        &field,
                        &piece,
                        Affine::variable(1, middle, half.next_up()),
                        &places,
                        "affine numbers",
                    );
                    check(&field, &piece, over::<Fraction>(&piece), &places, "237 bits");
                    let fine: Wide = over::<Fraction>(&piece);
                    check(&field, &piece, fine, &places, "fractions");
                }
            }
        }
    }
    assert!(count > 10_000, "{count} values");
}

#[test]
fn a_formula_does_not_jump_past_a_value_that_it_takes() {
    let mut random = Random(2);
    for operand in OPERANDS {
        for text in texts(operand) {
            let field_of = field(&text);
            for _ in 0..6 {
                let piece = Piece::new(&mut random);
                let t = piece.low + random.part() * (piece.high - piece.low);
                let Some(value) = value(&field_of, &piece, t) else { continue };
                // At the end of its range, a value may differ from a constant by its rounding.
                let moved = field(&format!("({text}) - ({:e})", value.high));
                for at in [
                    piece.at(over::<f64>(&piece)),
                    piece.at(over::<Fraction>(&piece)).map(|of: Wide| of.coarse()),
                ] {
                    let jumps = moved.jumps_past_0(at);
                    let Piece { base, dir, low, high } = &piece;
                    assert!(
                        !jumps,
                        "{} from {low:?} to {high:?}: {base:?} + t {dir:?} at {t:?}",
                        moved.formula()
                    );
                }
            }
        }
    }
}

/// Checks the bounds of the formula as it was written, where it is defined, and where it is continuous.
fn check_written<F: Float>(field: &Field, piece: &Piece, places: &[f64]) {
    let mut written = field.written();
    let mut over =
        |low: f64, high: f64| written.at(&piece.at(Interval { low: F::of(low), high: F::of(high) }));
    let steps = &field.formula().steps;
    let Piece { base, dir, low, high } = piece;
    let whole = over(*low, *high);
    let known: Vec<_> = places.iter().filter_map(|t| Some((*t, value(field, piece, *t)?))).collect();
    for (t, value) in &known {
        for seen in [whole, over(*t, *t)] {
            let bounds = Interval { low: seen.low, high: seen.high }.coarse();
            let is_right = seen.is_defined() != Some(false) && holds(bounds, *value, 0.0);
            let told = || format!("{} from {low:?} to {high:?}: {base:?} + t {dir:?}", field.formula());
            assert!(is_right, "{} at {t}: {value:?} is not in {seen:?}", told());
        }
    }
    for pair in known.windows(2) {
        let [(low, first), (high, last)] = [pair[0], pair[1]];
        if !over(low, high).is_continuous() {
            continue;
        }
        // A continuous function takes the values between two others.
        let (half, mut ends) = (0.5 * (first + last).high, [low, high]);
        for _ in 0..80 {
            let middle = 0.5 * (ends[0] + ends[1]);
            let value = defined(steps, piece.at(middle.into()));
            let is_beyond = value.is_some_and(|value| (value.high > half) == (last.high > half));
            ends[usize::from(is_beyond)] = middle;
        }
        let [before, after] = ends.map(|t| defined(steps, piece.at(t.into())).map_or(f64::NAN, |of| of.high));
        let is_near = (after - before).abs() < 1e-3 * (1.0 + first.high.abs() + last.high.abs());
        assert!(is_near, "{} from {low:?} to {high:?}: {base:?} + t {dir:?}", field.formula());
    }
}

#[test]
fn a_formula_as_it_was_written_is_seen_in_each_function_over_each_operator() {
    let mut random = Random(3);
    for operand in OPERANDS {
        for text in texts(operand) {
            let field = field(&text);
            for round in 0..6 {
                let piece = Piece::new(&mut random);
                let mut places: Vec<_> =
                    (0..6).map(|_| piece.low + random.part() * (piece.high - piece.low)).collect();
                places.sort_by(f64::total_cmp);
                check_written::<f64>(&field, &piece, &places);
                if round % 6 == 0 {
                    check_written::<Fraction>(&field, &piece, &places);
                }
            }
        }
    }
}

#[test]
fn a_formula_is_defined_where_each_of_its_operations_is() {
    let at = |x: f64, y: f64, z: f64| [x, y, z].map(Interval::constant);
    for (text, place, expected) in [
        ("z/y", at(1.0, 0.0, 0.0), Some(false)),
        ("z/y", at(1.0, 0.5, 0.0), Some(true)),
        ("0/y", at(1.0, 0.0, 0.0), Some(false)),
        ("(1/x)^0 + (x/x)*0", at(0.0, 1.0, 1.0), Some(false)),
        ("x^-2", at(0.0, 1.0, 1.0), Some(false)),
        ("sqrt(x)^2", at(-1.0, 0.0, 0.0), Some(false)),
        ("sqrt(x)^2", at(0.0, 0.0, 0.0), Some(true)),
        ("ln(x)", at(0.0, 0.0, 0.0), Some(false)),
        ("acos(x)", at(-1.0, 0.0, 0.0), None),
        ("acos(x)", at(1.5, 0.0, 0.0), Some(false)),
        ("cbrt(x)", at(0.0, 0.0, 0.0), Some(true)),
        ("x^(1/3)", at(-1.0, 0.0, 0.0), Some(false)),
        ("cos(1/y)", at(1.0, 0.0, 0.0), Some(false)),
        ("if(x > 0, ln(x), 1/y)", at(1.0, 0.0, 0.0), Some(true)),
        ("if(x > 0, ln(x), 1/y)", at(-1.0, 0.0, 0.0), Some(false)),
        ("min(1/y, x)*0", at(1.0, 0.0, 0.0), Some(false)),
        ("smin(x, y, z)", at(1.0, 1.0, 0.0), Some(false)),
        ("mod(x, y)", at(1.0, 0.0, 0.0), Some(false)),
        ("atanh(cosh(x))", at(0.5, 0.0, 0.0), Some(false)),
    ] {
        assert_eq!(field(text).written::<f64>().at(&place).is_defined(), expected, "{text}");
    }
}
