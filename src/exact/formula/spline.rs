//! Splines as formulas.

use super::step::Step;
use super::{Formula, HEIGHT};
use crate::interval::{Float, Wide};
use crate::scalar::Scalar;
use crate::spline::{Coefficient, Spline};
use std::array;
use std::sync::Arc;

/// The factorials of 0 to 3.
const FACTORIALS: [f64; 4] = [1.0, 1.0, 2.0, 6.0];

impl Formula {
    /// Returns the natural cubic spline through at least two points (y, value), with increasing y. It has two
    /// continuous derivatives, and no curvature at its ends.
    pub fn through(points: &[[f64; 2]]) -> Self {
        let formula = Self::new("the spline".to_owned(), HEIGHT, vec![Step::Variable(0), Step::Spline]);
        // Eight values of y may lie on eight pieces.
        Self { spline: Some(Arc::new(Spline::new(points))), is_plain: false, ..formula }
    }
}

impl From<Wide> for Coefficient {
    fn from(bounds: Wide) -> Self {
        let near = bounds.middle().to_f64();
        let rest = bounds - Wide::constant(near);
        let error = rest.magnitude();
        Self {
            near,
            rest: rest.middle().to_f64(),
            error: if error == Float::of(0.0) { 0.0 } else { error.to_f64().next_up() },
            bounds: bounds.ends(),
        }
    }
}

impl Spline {
    /// Makes the natural spline through at least two points (y, value), with increasing y. It has no curvature at its
    /// ends.
    pub fn new(points: &[[f64; 2]]) -> Self {
        let knots = points.iter().map(|[y, _]| *y).collect();
        let points: Vec<_> = points.iter().map(|point| point.map(Wide::constant)).collect();
        let curvature = curvatures(&points);
        let constant = Wide::constant;
        let cubics = points.windows(2).zip(curvature.windows(2)).map(|(ends, curvatures)| {
            let (&[[y, value], [next, after]], &[bend, last]) = (ends, curvatures) else { unreachable!() };
            let width = next - y;
            let slope = (after - value) / width - width * (constant(2.0) * bend + last) / constant(6.0);
            // The value and the first three derivatives at the lower point.
            let derivatives = [value, slope, bend, (last - bend) / width];
            array::from_fn(|order| {
                array::from_fn(|power| {
                    let of = derivatives.get(order + power).copied().unwrap_or(constant(0.0));
                    (of / constant(FACTORIALS[power])).into()
                })
            })
        });
        let cubics = cubics.collect();
        Self { knots, cubics }
    }
}

/// Returns the second derivatives of the spline at its points, by Thomas's algorithm for a diagonally dominant system.
fn curvatures(points: &[[Wide; 2]]) -> Vec<Wide> {
    let (count, constant) = (points.len(), Wide::constant);
    let width = |piece: usize| points[piece + 1][0] - points[piece][0];
    let rise = |piece: usize| (points[piece + 1][1] - points[piece][1]) / width(piece);
    let (mut above, mut right) = (vec![constant(0.0); count], vec![constant(0.0); count]);
    for at in 1..count - 1 {
        let pivot = constant(2.0) * (width(at - 1) + width(at)) - width(at - 1) * above[at - 1];
        above[at] = width(at) / pivot;
        right[at] = (constant(6.0) * (rise(at) - rise(at - 1)) - width(at - 1) * right[at - 1]) / pivot;
    }
    for at in (1..count - 1).rev() {
        right[at] = right[at] - above[at] * right[at + 1];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::interval::Interval;
    use crate::jet::Jet;

    #[test]
    fn a_spline_passes_its_points_and_bends_evenly() {
        let points = [[0.0, 1.0], [0.5, 2.0], [1.0, 1.5], [2.5, 0.25], [3.0, 2.0], [4.0, 1.0]];
        let spline = Formula::through(&points);
        for [y, value] in points {
            assert!((spline.at(y) - value).abs() < 1e-13, "{} at {y}", spline.at(y));
            let bend = |y: f64| spline.at(Jet::variable(y)).second;
            assert!((bend(y - 1e-9) - bend(y + 1e-9)).abs() < 1e-6, "it bends evenly at {y}");
        }
        for end in [0.0, 4.0] {
            assert!(spline.at(Jet::variable(end)).second.abs() < 1e-12, "it does not bend at {end}");
        }
        let line = Formula::through(&[[0.0, 1.0], [2.0, 4.0]]);
        assert_eq!(line.at(1.0), 2.5);
    }

    #[test]
    fn a_spline_of_many_waves_has_tight_bounds_and_a_continuous_hull() {
        let points: Vec<_> = (0..64).map(|at| [0.1 * f64::from(at), f64::from(1 + at % 2)]).collect();
        let spline = Formula::through(&points);
        for at in 0..630 {
            let y = 0.01 * f64::from(at);
            let bounds: Interval = spline.at(Interval { low: y, high: y + 1e-9 });
            assert!(bounds.low <= spline.at(y) && spline.at(y + 1e-9) <= bounds.high, "{bounds:?} at {y}");
            assert!(bounds.high - bounds.low < 1e-6, "{bounds:?} at {y}");
            let wide = spline.at(Dual::variable(Interval { low: y, high: y + 0.25 }));
            assert!(wide.value.high < 40.0 && wide.slope.is_bounded(), "{wide:?} at {y}");
        }
    }
}
