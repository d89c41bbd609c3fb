//! Splines as formulas.

use super::step::Step;
use super::{Formula, HEIGHT};
use crate::spline::Spline;
use std::sync::Arc;

impl Formula {
    /// Returns the natural cubic spline through points (y, value), at least two, of which each y is above the one
    /// before: it has two continuous derivatives, and no curvature at its ends.
    pub fn through(points: &[[f64; 2]]) -> Self {
        let formula = Self::new("the spline".to_owned(), HEIGHT, vec![Step::Variable(0), Step::Spline]);
        // Eight y at a time may lie on eight pieces.
        Self { spline: Some(Arc::new(Spline::new(points))), is_plain: false, ..formula }
    }

    /// Tells whether this is a spline, or its square: its coefficients were computed from the points, and rounded.
    pub fn is_spline(&self) -> bool {
        self.spline.is_some()
    }
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
