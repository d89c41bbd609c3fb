//! Roots of polynomials on pieces of a ray that `f64` does not decide: with twice the digits, and then exactly.

use super::{FormulaOnRay, Implicit};
use crate::geometry::sight::{Line, Sight};
use crate::world::certify::exact_line;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::polynomial::{Coefficient, FEW, MOST, Polynomial};
use tabray_exact::roots::isolation::{self, Part};
use tabray_exact::roots::range::Side;
use tabray_exact::roots::taylor::FunctionOnLine;
use tabray_exact::scalar::{Scalar, per_axis};

/// How far bounds of a root may be apart, in ulps of its distance: it is nearly always in their middle.
const HIDDEN: f64 = 64.0;

/// By how much more a piece is searched exactly, as a fraction of the places on it: a root at its end belongs to it.
const BEYOND: f64 = 4.0 * f64::EPSILON;

impl<T: Implicit> FormulaOnRay<'_, T> {
    /// Returns the first root on a piece of the ray as it is given, or of its wanted side where it leaves the surface.
    pub(super) fn finely(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        match self.shape.degree {
            Some(degree) if degree < FEW => self.finely_with::<FEW>(piece, origin_side),
            _ => self.finely_with::<MOST>(piece, origin_side),
        }
    }

    fn finely_with<const N: usize>(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        let counts = |rises: bool| origin_side.is_none_or(|side| rises == (side == Side::Inside));
        let Line { origin, dir } = self.shape.frame.exactly(self.ray, self.closest);
        let along = Polynomial::<DoubleDouble, N>::along(piece);
        let size = self.ray.origin.abs().max_element() + self.closest.abs() + self.base.abs().max_element();
        let error = 4.0 * DoubleDouble::ROUNDING;
        let place = |axis: usize| {
            let origin = Polynomial::number(origin[axis], error * size);
            origin + Polynomial::number(dir[axis], error) * along
        };
        let polynomial = self.shape.formula.along(per_axis(place));
        let at = |s: DoubleDouble| {
            let [low, high] = [piece.low, piece.high].map(|end| DoubleDouble::from(0.5 * end));
            ((low + high) + (high - low) * s).high
        };
        let root = isolation::visit(&polynomial, |part| match part {
            Part::Root { ends, rises } => {
                counts(rises).then(|| at(isolation::refined(&polynomial, ends, rises)))
            }
            Part::Hidden(ends) => {
                let [low, high] = ends.map(at);
                match self.exactly(low, high, origin_side) {
                    Some(decided) => decided,
                    // A tangent line meets the surface, but one that leaves the surface does not meet it there.
                    None => origin_side.is_none().then_some(0.5 * (low + high)),
                }
            }
        });
        root.map(|root| root.clamp(piece.low, piece.high))
    }

    /// Returns a simple root that may be off by the rounding of `f64`, with twice the digits where that would be more than the
    /// last ones of its distance.
    pub(super) fn with_all_digits(&self, root: f64) -> f64 {
        let hidden = self.at(Interval::constant(root)).width();
        let slope = self.at(Dual::variable(root)).slope.abs();
        if hidden <= HIDDEN * f64::EPSILON * (self.closest + root).abs() * slope {
            return root;
        }
        let exact = self.shape.frame.exactly(self.ray, self.closest);
        let mut fine = DoubleDouble::from(root);
        for _ in 0..2 {
            let Dual { value, slope } = self.shape.formula.value(exact.along(Dual::variable(fine)));
            fine = fine - value / slope;
        }
        // Written so that a NaN is none.
        if (fine.high - root).abs() * slope <= hidden { fine.high } else { root }
    }

    /// Returns the first root from one place to another, exactly; `None` where the formula or the line has numbers that are no
    /// fractions.
    fn exactly(&self, low: f64, high: f64, origin_side: Option<Side>) -> Option<Option<f64>> {
        let field = self.shape.formula.field()?;
        let [origin, dir] = exact_line(&self.shape.frame.line(Sight::along(self.ray).line()))?;
        let whole = field.exactly_along(&origin, &dir)?;
        let beyond = BEYOND * (low.abs() + high.abs() + self.closest.abs());
        let root =
            whole.first_root(self.closest + low - beyond, self.closest + high + beyond, |root| {
                match (origin_side, root.rises) {
                    (None, _) => true,
                    (Some(side), Some(rises)) => rises == (side == Side::Inside),
                    (Some(_), None) => false,
                }
            });
        Some(root.map(|root| root.nearest(self.closest)))
    }
}
