//! Tests of the search for roots.

use super::*;
use crate::polynomial::Polynomial;
use std::cell::Cell;

/// A double root at 1, and a single one at 3.
struct Cubic;

impl FunctionOnLine for Cubic {
    fn at<N: Scalar>(&self, t: N) -> N {
        (t - N::constant(1.0)).powi(2) * (N::constant(3.0) - t)
    }
}

/// A kink at the root 2, a jump past 0 at 3 and a pole at 4.
struct Broken;

impl FunctionOnLine for Broken {
    fn at<N: Scalar>(&self, t: N) -> N {
        let n = N::constant;
        (t - n(2.0)).abs().min(n(2.5) - t.floor()) / (n(4.0) - t)
    }
}

fn first(line: &impl FunctionOnLine, span: Range<f64>, origin_side: Option<Side>) -> Option<f64> {
    let range = RayRange { origin_side, ..RayRange::ALL };
    first_root(line, &span.into(), 0.0, &range, f64::EPSILON * 36.0).root
}

#[test]
fn a_touch_is_a_root_and_no_way_in() {
    let touch = first(&Cubic, 0.0..9.0, None).expect("a touch");
    assert!((touch - 1.0).abs() < 1e-7, "{touch:e}");
    assert_eq!(first(&Cubic, 0.0..9.0, Some(Side::Outside)), Some(3.0));
    assert_eq!(first(&Cubic, 0.0..9.0, Some(Side::Inside)), None);
    assert_eq!(first(&Cubic, 1.5..2.9, None), None);
}

/// Has a rounding error as large as its waves, and counts the undecided pieces.
#[derive(Default)]
struct Hidden(Cell<usize>);

impl FunctionOnLine for Hidden {
    fn at<N: Scalar>(&self, t: N) -> N {
        (N::constant(1e4) * t).sin() + N::about(0.0, 1.0)
    }

    fn undecided(&self, _piece: Interval, _origin_side: Option<Side>) -> Option<f64> {
        self.0.set(self.0.get() + 1);
        None
    }
}

#[test]
fn pieces_that_rounding_hides_are_not_all_judged() {
    let line = Hidden::default();
    assert_eq!(first(&line, 0.0..9.0, None), None);
    assert_eq!(line.0.get(), MAX_UNDECIDED);
}

/// Rises to a pole at half of π, and from there to a root at π.
struct Tangent;

impl FunctionOnLine for Tangent {
    fn at<N: Scalar>(&self, t: N) -> N {
        t.tan()
    }
}

#[test]
fn a_pole_hides_no_root_beside_it() {
    for start in [0.5, 1.0, 1.5, 1.6] {
        let root = first(&Tangent, start..3.5, None).expect("a root");
        assert!((root - std::f64::consts::PI).abs() < 1e-14, "{root}");
    }
}

#[test]
fn kinks_and_jumps_are_met_and_poles_are_not() {
    let kink = first(&Broken, 0.3..9.0, None).expect("a kink");
    assert!((kink - 2.0).abs() < 1e-14, "{kink}");
    let jump = first(&Broken, 2.3..9.0, None).expect("a jump");
    assert!((jump - 3.0).abs() < 1e-14, "{jump}");
    assert_eq!(first(&Broken, 3.3..9.0, None), None);
}

/// The difference of two values that both exceed the range of numbers from 2.2 on.
struct Overflowing;

impl FunctionOnLine for Overflowing {
    fn at<N: Scalar>(&self, t: N) -> N {
        let power = |of: N| of.powi(100).scaled(1e300);
        power(t) - power(t - N::constant(1.0))
    }
}

#[test]
fn values_beyond_all_numbers_end_a_search_soon() {
    let mut left = MAX_PIECES;
    let range = RayRange::ALL;
    let found = first_root_within(&Overflowing, &(2.3..9.7).into(), 0.0, &range, 1e-14, &mut left);
    assert!(!found.is_certain && MAX_PIECES - left < 128, "{found:?} after {} pieces", MAX_PIECES - left);
}

/// The polynomial with these roots, falling at the first one. Its roots are isolated by coefficients or by bounds.
struct Product {
    roots: Vec<f64>,
    by_coefficients: bool,
}

impl FunctionOnLine for Product {
    fn at<N: Scalar>(&self, t: N) -> N {
        let factor = |root: &f64| N::constant(*root) - t;
        self.roots.iter().map(factor).fold(N::constant(1.0), |product, factor| product * factor)
    }

    fn degree(&self) -> Option<usize> {
        self.by_coefficients.then_some(self.roots.len())
    }

    fn polynomial<const N: usize>(&self, piece: Interval) -> Polynomial<f64, N> {
        self.at(Polynomial::along(piece))
    }
}

#[test]
fn coefficients_find_the_roots_that_bounds_find() {
    let mut random = 1_u32;
    let mut draw = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(random >> 8) / f64::from(1 << 24)
    };
    for case in 0..2000 {
        let mut roots: Vec<f64> = (0..2 + case % 9).map(|_| 10.0 * draw() - 1.0).collect();
        match case % 4 {
            0 => {}
            1 => roots[1] = roots[0],
            2 => roots[1] = roots[0] + 1e-9 * draw(),
            _ => roots[1] = roots[0] + 1e-5 * draw(),
        }
        // The line starts on the surface in some cases.
        let start = if case % 3 == 0 { roots[0].max(0.0) } else { 0.0 };
        let sides = [None, Some(Side::Outside), Some(Side::Inside)];
        // A line that leaves the surface has no defined side where it touches the surface again.
        for origin_side in sides.into_iter().take(if case % 4 == 1 { 1 } else { 3 }) {
            let by = |by_coefficients| {
                first(&Product { roots: roots.clone(), by_coefficients }, start..9.0, origin_side)
            };
            let (expected, found) = (by(false), by(true));
            let off = expected.unwrap_or(0.0) - found.unwrap_or(0.0);
            assert!(
                expected.is_some() == found.is_some() && off.abs() < 1e-6,
                "{roots:?} from {start}, {origin_side:?}: {found:?} is not {expected:?}"
            );
        }
    }
}
