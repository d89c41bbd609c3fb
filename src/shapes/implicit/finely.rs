//! Roots of polynomials on pieces of a ray that `f64` cannot decide: in double-double arithmetic, and then exactly.

use super::formula::Implicit;
use super::on_ray::ImplicitShape;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_exact::polynomial::{Coefficient, FEW, MAX_COEFFICIENTS, Polynomial};
use tabray_exact::roots::bernstein::NearRoot;
use tabray_exact::roots::isolation::{self, RootPart};
use tabray_exact::roots::range::Side;
use tabray_exact::scalar::per_axis;
use tabray_world::certify::{Equation, exact_line};
use tabray_world::geometry::ray::Ray;
use tabray_world::geometry::sight::{Line, Sight};

/// The maximum distance between the bounds of a root, in ulps of the root's distance. The root is nearly always in
/// their middle.
const HIDDEN: f64 = 64.0;

/// A Newton step, as a fraction of a root's distance, after which another step would not change the digits of the root:
/// the square of this, 2^-74, is far below an ulp.
const SMALL: f64 = 1.0 / 137_438_953_472.0;

/// The maximum number of secant steps.
const STEPS: usize = 5;

/// The margin by which a piece is enlarged for the exact search, as a fraction of the places on it. A root at the end
/// of a piece belongs to the piece.
const BEYOND: f64 = 4.0 * f64::EPSILON;

/// A formula along an exact ray.
pub(super) struct TrueRay<'s, T> {
    pub shape: &'s ImplicitShape<T>,
    /// The ray in world space, and the distance along it from which roots are counted, in world units.
    pub ray: &'s Ray,
    pub closest: f64,
}

impl<T: Implicit> TrueRay<'_, T> {
    /// Returns the first root on a piece of the exact ray. For a ray that leaves the surface, only roots of the other
    /// direction count.
    pub fn first_root(&self, degree: usize, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        if degree < FEW {
            self.first_root_with::<FEW>(piece, origin_side)
        } else {
            self.first_root_with::<MAX_COEFFICIENTS>(piece, origin_side)
        }
    }

    fn first_root_with<const N: usize>(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        let counts = |rises: bool| origin_side.is_none_or(|side| rises == (side == Side::Inside));
        let Line { origin, dir } = self.shape.frame.exactly(self.ray, self.closest);
        let along = Polynomial::<DoubleDouble, N>::along(piece);
        let start = self.shape.frame.from_origin(self.ray, self.closest).abs().max_element();
        let size = self.ray.origin.abs().max_element() + self.closest.abs() + 2.0 * start;
        let error = 4.0 * DoubleDouble::ROUNDING;
        let place = |axis: usize| {
            let origin = Polynomial::number(origin[axis], error * size);
            origin + Polynomial::number(dir[axis], error) * along
        };
        let polynomial = self.shape.polynomial()?.polynomial(per_axis(place));
        let at = |s: DoubleDouble| {
            let [low, high] = [piece.low, piece.high].map(|end| DoubleDouble::from(0.5 * end));
            ((low + high) + (high - low) * s).high
        };
        let root = isolation::visit(&polynomial, |part| match part {
            RootPart::Free(_) => None,
            RootPart::Root { ends, rises } => {
                counts(rises).then(|| at(isolation::refined(&polynomial, ends, rises)))
            }
            RootPart::Hidden(ends) => {
                let [low, high] = ends.map(at);
                match self.exactly(low, high, origin_side) {
                    Some(decided) => decided,
                    // A tangent ray touches the surface. A ray that starts at the touching point has no hit there.
                    None => origin_side.is_none().then_some(0.5 * (low + high)),
                }
            }
        });
        root.map(|root| root.clamp(piece.low, piece.high))
    }

    /// Returns the root near a place, by secant steps in double-double arithmetic. The first step takes an approximate
    /// slope. Returns `None` if the root is farther away than a polynomial known within `hidden` allows.
    pub fn finished(&self, near: &NearRoot, hidden: f64) -> Option<f64> {
        let &NearRoot { place: near, slope, is_known } = near;
        let exact = self.shape.frame.exactly(self.ray, self.closest);
        let start = DoubleDouble::from(near);
        let (mut fine, mut before, mut steep) = (start, None, slope);
        for _ in 0..STEPS {
            let value = self.shape.formula.polynomial(exact.at(fine));
            if let Some((place, other)) = before {
                steep = ((value - other) / (fine - place)).high;
            }
            let step = value / DoubleDouble::from(steep);
            before = Some((fine, value));
            fine = fine - step;
            // Each step multiplies the error by the relative error of the slope.
            let is_last = step.high.abs() <= SMALL * (self.closest + near).abs();
            if is_last && (is_known || steep != slope) && (steep - slope).abs() <= 0.5 * slope.abs() {
                let off = (fine - start).high.abs() * slope.abs();
                return (off <= 2.0 * hidden).then_some(fine.high);
            }
        }
        None
    }

    /// Returns a simple root, refined in double-double arithmetic if the rounding of `f64` exceeds the last digits of
    /// its distance. The formula is known within `hidden` at the root, and has this slope there.
    pub fn polished(&self, root: f64, hidden: f64, slope: f64) -> f64 {
        if hidden <= HIDDEN * f64::EPSILON * (self.closest + root).abs() * slope {
            return root;
        }
        let exact = self.shape.frame.exactly(self.ray, self.closest);
        let mut fine = DoubleDouble::from(root);
        for _ in 0..2 {
            let Dual { value, slope } = self.shape.formula.value(exact.along(Dual::variable(fine)));
            let step = value / slope;
            fine = fine - step;
            // Each step about squares the error.
            if step.high.abs() <= SMALL * (self.closest + root).abs() {
                break;
            }
        }
        // The comparison is false for NaN.
        if (fine.high - root).abs() * slope <= hidden { fine.high } else { root }
    }

    /// Returns the exact first root from one place to another, or `None` if the formula or the line has numbers that
    /// are not fractions.
    fn exactly(&self, low: f64, high: f64, origin_side: Option<Side>) -> Option<Option<f64>> {
        let [origin, dir] = exact_line(&self.shape.frame.line(Sight::along(self.ray).line()))?;
        let whole = self.shape.polynomial()?.exactly(&origin, &dir)?;
        let beyond = BEYOND * (low.abs() + high.abs() + self.closest.abs());
        let root = whole.first_root(
            self.closest + low - beyond,
            self.closest + high + beyond,
            &|root| match (origin_side, root.rises) {
                (None, _) => true,
                (Some(side), Some(rises)) => rises == (side == Side::Inside),
                (Some(_), None) => false,
            },
        );
        Some(root.map(|root| root.nearest(self.closest)))
    }
}
