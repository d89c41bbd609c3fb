//! Splines as formulas.

use super::step::Step;
use super::{Formula, HEIGHT};

impl Formula {
    /// Returns the natural cubic spline through points (y, value), at least two, of which each y is above the one
    /// before: it has two continuous derivatives, and no curvature at its ends.
    ///
    /// It is the cubic of its middle piece, and a cube for each jump of the third derivative, which is 0 on the side of
    /// the middle: so no term is much larger than the distance from the middle asks for.
    pub fn spline(points: &[[f64; 2]]) -> Self {
        let curvature = curvatures(points);
        let count = points.len();
        let piece = (count - 1) / 2;
        let [[y, value], [next, after]] = [points[piece], points[piece + 1]];
        let width = next - y;
        let slope = (after - value) / width - width * (2.0 * curvature[piece] + curvature[piece + 1]) / 6.0;
        // The third derivative of each piece.
        let third = |piece: usize| {
            (curvature[piece + 1] - curvature[piece]) / (points[piece + 1][0] - points[piece][0])
        };
        // Horner's scheme in y - y0.
        let from_y = [Step::Variable(0), Step::Number(y), Step::Sub];
        let mut steps = vec![Step::Number(third(piece) / 6.0)];
        for coefficient in [0.5 * curvature[piece], slope, value] {
            steps.extend(from_y);
            steps.extend([Step::Mul, Step::Number(coefficient), Step::Add]);
        }
        for knot in 1..count - 1 {
            let jump = (third(knot) - third(knot - 1)) / 6.0;
            let (place, at) = (Step::Number(points[knot][0]), Step::Variable(0));
            let (beyond, factor) = if knot > piece { ([at, place], jump) } else { ([place, at], jump) };
            steps.extend(beyond);
            steps.extend([Step::Sub, Step::Ramp(3), Step::Number(factor), Step::Mul, Step::Add]);
        }
        Self::new("the spline".to_owned(), HEIGHT, steps)
    }
}

/// Returns the second derivatives of the spline at its points: Thomas's algorithm for a diagonally dominant system.
fn curvatures(points: &[[f64; 2]]) -> Vec<f64> {
    let count = points.len();
    let width = |piece: usize| points[piece + 1][0] - points[piece][0];
    let rise = |piece: usize| (points[piece + 1][1] - points[piece][1]) / width(piece);
    let (mut above, mut right) = (vec![0.0; count], vec![0.0; count]);
    for at in 1..count - 1 {
        let pivot = 2.0 * (width(at - 1) + width(at)) - width(at - 1) * above[at - 1];
        above[at] = width(at) / pivot;
        right[at] = (6.0 * (rise(at) - rise(at - 1)) - width(at - 1) * right[at - 1]) / pivot;
    }
    for at in (1..count - 1).rev() {
        right[at] -= above[at] * right[at + 1];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::dual::Dual;

    #[test]
    fn a_spline_passes_its_points_and_bends_evenly() {
        let points = [[0.0, 1.0], [0.5, 2.0], [1.0, 1.5], [2.5, 0.25], [3.0, 2.0], [4.0, 1.0]];
        let spline = Formula::spline(&points);
        for [y, value] in points {
            assert!((spline.at(y) - value).abs() < 1e-13, "{} at {y}", spline.at(y));
            let bend = |y: f64| spline.at(Dual::variable_twice(y)).second();
            assert!((bend(y - 1e-9) - bend(y + 1e-9)).abs() < 1e-6, "it bends evenly at {y}");
        }
        for end in [0.0, 4.0] {
            assert!(spline.at(Dual::variable_twice(end)).second().abs() < 1e-12, "it does not bend at {end}");
        }
        let line = Formula::spline(&[[0.0, 1.0], [2.0, 4.0]]);
        assert_eq!(line.at(1.0), 2.5);
    }
}
