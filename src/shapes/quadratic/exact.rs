//! Exact hits of a quadric, except for the rounding of the roots.

use super::surface::{DD_ERROR, OwnRay, Quadratic};
use tabray_exact::double_double::{DoubleDouble, exact::Exact};

/// A hit as a double-double, and a bound of its error, both in the quadric's own unit of length.
#[derive(Clone, Copy)]
pub(super) struct PreciseHit {
    pub at: DoubleDouble,
    pub error: f64,
}

impl PreciseHit {
    pub const NONE: Self = Self { at: DoubleDouble { high: f64::NAN, low: 0.0 }, error: 0.0 };
}

impl Quadratic {
    /// Computes both hits from the exact polynomial, rounding only the roots, or NaN for missing hits.
    #[cold]
    pub(super) fn exact_hits(&self, ray: &OwnRay) -> [PreciseHit; 2] {
        let [a, b, c] = self.exact_polynomial(ray);
        let discriminant = Exact::sum(b.times(&b).chain(a.times(&c).map(|term| -term))).rounded();
        let [a, b, c] = [a, b, c].map(|part| part.rounded());
        let fine = |at: DoubleDouble| PreciseHit { at, error: DD_ERROR * at.high.abs() };
        if discriminant.high < 0.0 {
            return [PreciseHit::NONE; 2];
        }
        if a.high == 0.0 {
            // A line that lies in the quadric, or does not meet it, has no hits.
            return [if b.high == 0.0 { PreciseHit::NONE } else { fine(-c / (b + b)) }, PreciseHit::NONE];
        }
        let root = discriminant.sqrt();
        let larger = if b.high > 0.0 { -b - root } else { root - b };
        // Both roots are 0 if b and c are.
        let other = if larger.high == 0.0 { larger } else { c / larger };
        [fine(larger / a), fine(other)]
    }

    /// Computes the polynomial `a t^2 + 2 b t + c` along a ray from its origin.
    fn exact_polynomial(&self, ray: &OwnRay) -> [Exact; 3] {
        let parts = |of: DoubleDouble| Exact::sum([of.high, of.low]);
        let (from, dir) = (ray.from.map(parts), ray.dir.to_array().map(|part| Exact::sum([part])));
        let second = |one: &[Exact; 3], other: &[Exact; 3]| {
            Exact::sum((0..9).flat_map(|index| {
                let (row, column) = (index / 3, index % 3);
                let product = Exact::sum(one[row].times(&other[column]));
                let coefficient = Exact::sum([self.square.col(column)[row]]);
                product.times(&coefficient).collect::<Vec<_>>()
            }))
        };
        let first = |of: &[Exact; 3], factor: f64| {
            let part =
                |axis: usize| Exact::sum([factor * self.linear[axis]]).times(&of[axis]).collect::<Vec<_>>();
            Exact::sum((0..3).flat_map(part))
        };
        let sum = |parts: &[&Exact]| Exact::sum(parts.iter().flat_map(|part| part.parts().iter().copied()));
        let b = sum(&[&second(&from, &dir), &first(&dir, 0.5)]);
        let c = sum(&[&second(&from, &from), &first(&from, 1.0), &Exact::sum([self.constant])]);
        [second(&dir, &dir), b, c]
    }
}
