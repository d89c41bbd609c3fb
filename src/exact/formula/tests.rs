//! Tests of formulas.

use super::field::Field;
use super::variables::SPACE;
use super::*;
use std::f64::consts::PI;

/// Parses a formula in x, y and z.
pub(super) fn field(text: &str) -> Field {
    let formula = Formula::parse_in(text, SPACE).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
    Field::new(Arc::new(formula)).expect("its variables are x, y and z")
}

fn value(text: &str, y: f64) -> f64 {
    Formula::parse(text).unwrap_or_else(|fault| panic!("{text}: {fault:?}")).at(y)
}

#[test]
fn formulas_mean_what_they_say() {
    for (text, y, expected) in [
        ("2 + sin(y)", 0.0, 2.0),
        ("-4/6 * (y - 6)", 0.0, 4.0),
        ("2 - 3 - 4", 0.0, -5.0),
        ("2 / 4 / 2", 0.0, 0.25),
        ("-y^2", 3.0, -9.0),
        ("2^-1", 0.0, 0.5),
        ("2^3^2", 0.0, 512.0),
        ("y^0.5", 9.0, 3.0),
        ("min(y, 2) * max(y, 2)", 5.0, 10.0),
        ("abs(-y) + sqrt(16) + exp(0) + ln(1) + cos(0) + tan(0)", 2.0, 8.0),
        ("1e-3 + .5 + 2.", 0.0, 2.501),
        ("pi", 0.0, PI),
        ("--y", 2.0, 2.0),
        ("2y + 3(y + 1)(y - 1)", 2.0, 13.0),
        ("y**2 + 2y² - y³ + y^(2*2) + 2^y²", 2.0, 36.0),
        ("2y^2 - 2π/π", 3.0, 16.0),
        ("|y - 5| + 2|-y| + |(|y|)|", 2.0, 9.0),
        ("2exp(0) + 2 sin(0) + y(1 + y)", 3.0, 14.0),
        ("min(4, y, 3) + max(1, 2, y, 0)", 5.0, 8.0),
        ("+y - +2", 5.0, 3.0),
        ("ceil(y) + round(y) + fract(y)", 2.25, 5.25),
        ("mod(y, 3) + mod(-y, 3)", 4.0, 3.0),
        ("clamp(y, 1, 3) + mix(2, 4, 0.25) + smoothstep(0, 8, y)", 4.0, 6.0),
        ("hypot(3, y) - tanh(0) + cosh(0) + sinh(0)", 4.0, 6.0),
        ("sign(y) + sign(-y) + trunc(-y) + step(2, y)", 2.5, -1.0),
        ("log2(y) + log10(100) + log(1) + cbrt(-y)", 8.0, 3.0),
        ("4*atan(y)/pi + 4*atan2(y, -y)/pi + 2*asin(y)/pi + acos(y)", 1.0, 5.0),
        ("asinh(sinh(y)) + acosh(cosh(y)) - 2*atanh(tanh(y))", 0.0, 0.0),
        ("smin(y, 1, 2) + smax(y, 1, 2)", 1.0, 2.0),
        ("smin(9, y, 1, 2) + smax(y, -9, 1, 2)", 1.0, 2.0),
        ("if(y < 2, 1, 10) + if(y <= 2, 2, 20) + if(y > 2, 3, 30) + if(y >= 2, 4, 40)", 2.0, 46.0),
        ("if(y < 2, 1, 10) + if(y ≤ 2, 2, 20) + if(y > 2, 3, 30) + if(y ≥ 2, 4, 40)", 1.0, 73.0),
        ("if(y^2 < 2 + y, ln(y), if(3 < y, y + 1, -1))", 4.0, 5.0),
        ("if(y < 5, y, ln(-y))", 4.0, 4.0),
    ] {
        assert_eq!(value(text, y), expected, "{text}");
    }
}

#[test]
fn faults_are_marked_where_they_are() {
    for (text, place, message) in [
        ("2 + sni(y)", 4..7, "unknown name `sni` in a formula"),
        ("2 3", 2..3, "expected an operator"),
        ("2 + ", 4..4, "expected a value"),
        ("", 0..0, "expected a value"),
        ("(2 + y", 0..1, "unclosed `(`"),
        ("2 + y)", 5..6, "unmatched `)`"),
        ("sin y", 0..3, "`sin` needs its argument in parentheses"),
        ("min(y)", 0..3, "`min` takes 2 values, separated by commas"),
        ("2 * 1.2.3", 4..9, "`1.2.3` is not a number"),
        ("2 * 1e999", 4..9, "`1e999` is too large"),
        ("ü", 0..2, "unknown name `ü` in a formula"),
        ("2 + 1/2y + 1", 4..8, "`1/2y` can be read in two ways"),
        ("y = 2", 2..3, "expected a value, not an equation"),
        ("2 + |y", 4..5, "unclosed `|`"),
        ("mod(y)", 0..3, "`mod` takes 2 values, separated by commas"),
        ("clamp(y, 1, 2, 3)", 0..5, "`clamp` takes only 3 values"),
        ("if(y, 1, 2)", 4..5, "expected a comparison"),
        ("if(y < 1, 2)", 0..2, "`if` takes 3 values, separated by commas"),
        ("if(1 < y < 2, 1, 0)", 0..2, "`if` takes 3 values, separated by commas"),
        ("y > 2", 2..3, "expected a value, not a comparison"),
    ] {
        let fault = Formula::parse(text).expect_err(text);
        assert_eq!((fault.place, fault.message.as_str()), (place, message), "{text}");
    }
}

#[test]
fn an_equation_is_the_difference_of_its_sides() {
    let ball = Formula::parse_in("x² + y² + Z² = 2Y + 1", SPACE).expect("an equation");
    assert_eq!(ball.run(&ball.program, &mut [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]), 9.0);
    assert!(Formula::parse_in("x = y = z", SPACE).is_err());
}

#[test]
fn a_power_that_is_too_great_is_told() {
    assert_eq!(Formula::parse("y¹⁰⁰⁰").expect("a power").at(1.0), 1.0);
    let fault = Formula::parse("y¹⁰⁰¹").expect_err("too great");
    assert_eq!((fault.message.as_str(), fault.place), ("a power is at most 1000", 1.."y¹⁰⁰¹".len()));
}

#[test]
fn what_is_written_with_named_numbers_means_the_same_without_them() {
    let named = |name: &str| {
        let of = [("n", 5.0), ("mod", -2.0), ("k", 0.5)].into_iter().find(|of| of.0 == name);
        of.map(|of| Meant::Number(of.1))
    };
    for text in ["2n + y", "2 n y^(2*n)", "y²n", "n(y + 1)n", "|y|k - n k", "2mod + mod y", "(y)n"] {
        let formula = Formula::parse_with(text, HEIGHT, &named).expect(text);
        let written = Formula::parse(&formula.to_string()).expect(text);
        assert_eq!(written.at(1.5), formula.at(1.5), "{text}: {formula}");
    }
}

/// Returns `f(u, v)`, `g(x)`, which calls it, and a constant.
fn own(name: &str) -> Option<Meant> {
    let function = |arguments: &[&str], text: &str| {
        let parsed = OwnFunction::parse(arguments, text, &own).expect("a function");
        Some(Meant::Function(Arc::new(parsed)))
    };
    match name {
        "f" => function(&["u", "v"], "u² - 2v"),
        "g" => function(&["x"], "n f(x, X + 1) + |x|"),
        "n" => Some(Meant::Number(3.0)),
        _ => None,
    }
}

#[test]
fn functions_of_a_scene_mean_what_they_stand_for() {
    for (text, expected) in [
        ("f(y, 1)", 2.0),
        ("2f(y + 1, n) f(1, 0)", 6.0),
        ("-f(-y, y^2)^2 + y²f(0, 1)", -24.0),
        ("g(y)", 3.0 * (4.0 - 6.0) + 2.0),
        ("f(f(y, n), g(1))", 4.0 + 16.0),
        ("|y - 5|f(if(y < 1, 5, 1), 0)", 3.0),
    ] {
        let formula =
            Formula::parse_with(text, HEIGHT, &own).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
        assert_eq!(formula.at(2.0), expected, "{text}: {formula}");
        let written =
            Formula::parse(&formula.to_string()).unwrap_or_else(|fault| panic!("{formula}: {fault:?}"));
        assert_eq!(written.at(2.0), expected, "{text}: {formula}");
    }
}

#[test]
fn faults_in_calls_of_a_scenes_functions_are_marked_where_they_are() {
    for (text, place, message) in [
        ("1 + f(y)", 4..5, "`f` takes 2 values, separated by commas"),
        ("f(y, 1, 2)", 0..1, "`f` takes only 2 values"),
        ("f y", 0..1, "`f` needs its argument in parentheses"),
        ("f(y, 2 +)", 8..9, "expected a value"),
        ("f(y, h(1))", 5..6, "unknown name `h` in a formula"),
        ("f(1, y", 1..2, "unclosed `(`"),
    ] {
        let fault = Formula::parse_with(text, HEIGHT, &own).expect_err(text);
        assert_eq!((fault.place, fault.message.as_str()), (place, message), "{text}");
    }
    let fault = OwnFunction::parse(&["u"], "u + w", &|_| None).expect_err("unknown");
    assert_eq!((fault.place, fault.message.as_str()), (4..5, "unknown name `w` in a formula"));
}

#[test]
fn functions_of_functions_are_bounded() {
    let mut last = Arc::new(OwnFunction::parse(&["u"], "u u", &|_| None).expect("a function"));
    let mut count = 1;
    while let Ok(next) = {
        let named = |name: &str| (name == "f").then(|| Meant::Function(last.clone()));
        OwnFunction::parse(&["u"], "f(u) f(u + 1)", &named)
    } {
        (last, count) = (Arc::new(next), count + 1);
        assert!(count < 32);
    }
    assert!(count > 4);
}

#[test]
fn nested_functions_that_use_their_arguments_twice_are_bounded() {
    let nested = |depth: usize| format!("{}y{}", "fract(".repeat(depth), ")".repeat(depth));
    assert!(Formula::parse(&nested(8)).is_ok());
    for depth in [20, 28, 31] {
        let fault = Formula::parse(&nested(depth)).expect_err("too long");
        assert!(["too many operations", "formula nested too deeply"].contains(&&*fault.message), "{fault:?}");
    }
}

#[test]
fn deep_nesting_is_refused_and_long_formulas_are_not() {
    assert!(Formula::parse(&format!("{}y{}", "(".repeat(100_000), ")".repeat(100_000))).is_err());
    assert!(Formula::parse(&"-".repeat(100_000)).is_err());
    assert_eq!(value(&format!("y{}", " + y".repeat(9_999)), 1.0), 10_000.0);
    let right = format!("{}y{}", "y + (".repeat(20), ")".repeat(20));
    assert_eq!(value(&right, 1.0), 21.0);
}

#[test]
fn slopes_are_derivatives() {
    for text in [
        "2 + sin(y)",
        "y^3 - 2*y",
        "exp(-y^2)",
        "ln(y)/y",
        "sqrt(y)*tan(y/4)",
        "y^y",
        "abs(y-3)",
        "min(y, 2)+max(1, y)*cos(y)",
        "if(y < 2, y^2, 8 - y^2)",
        "y^0.5",
        "(1+y)^-2",
    ] {
        let formula = Formula::parse(text).expect(text);
        for y in [0.7, 1.3, 2.9] {
            let Dual { value, slope } = formula.at(Dual::variable(y));
            let step = 1e-6;
            let difference = (formula.at(y + step) - formula.at(y - step)) / (2.0 * step);
            assert_eq!(value, formula.at(y), "{text} at {y}");
            assert!(
                (slope - difference).abs() < 1e-8 * (1.0 + slope.abs()),
                "{text} at {y}: {slope}, {difference}"
            );
        }
    }
}
