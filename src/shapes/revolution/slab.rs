//! A slab: a range of heights in which a profile's square is a parabola to within a proven error.

use super::budget::Budget;
use tabray_exact::formula::Formula;
use tabray_exact::interval::Interval;
use tabray_exact::jet::Jet;
use tabray_exact::scalar::Scalar;

/// A range of heights, in world units.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    pub from: f64,
    pub to: f64,
    pub middle: f64,
    /// In the slab, the square of the profile is `c0 + c1 v + c2 v^2` to within `error`, with `v` measured from the
    /// middle. Its slope is the parabola's to within `slope_error`.
    pub c0: f64,
    pub c1: f64,
    pub c2: f64,
    pub error: f64,
    pub slope_error: f64,
    /// An upper bound of the square, in square world units.
    pub max_square: f64,
    /// Whether the profile is negative, and there is no surface.
    pub is_void: bool,
}

impl Slab {
    /// Returns the value of the parabola at `v` from the middle.
    #[inline(always)]
    pub fn parabola(&self, v: f64) -> f64 {
        self.c0 + v * (self.c1 + v * self.c2)
    }

    /// Returns a range of heights without a surface.
    pub fn void(from: f64, to: f64) -> Self {
        let middle = 0.5 * (from + to);
        Self {
            from,
            to,
            middle,
            c0: 0.0,
            c1: 0.0,
            c2: 0.0,
            error: 0.0,
            slope_error: 0.0,
            max_square: 0.0,
            is_void: true,
        }
    }

    /// Fits the parabola through three Chebyshev nodes, and proves its error. Returns `None` if the budget does not
    /// suffice.
    pub fn fit(square: &Formula, from: f64, to: f64, budget: &mut Budget) -> Option<Self> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let node = 0.75_f64.sqrt();
        let [below, at, above] = [-node, 0.0, node].map(|x| square.at(middle + x * half));
        let c1 = (above - below) / (2.0 * node * half);
        let c2 = (above - 2.0 * at + below) / (2.0 * node * node * half * half);
        let mut slab = Self { c0: at, c1, c2, is_void: false, ..Self::void(from, to) };
        slab.certify(square, budget)?;
        // Without a bounded slope, a constant is as good as any parabola.
        if !slab.error.is_finite() {
            slab = Self { c0: 0.5 * slab.max_square, c1: 0.0, c2: 0.0, ..slab };
            slab.certify(square, budget)?;
        }
        Some(slab)
    }

    /// Proves bounds of the difference between the square and the parabola, on eight parts of the slab. Returns `None`
    /// if the budget does not suffice.
    fn certify(&mut self, square: &Formula, budget: &mut Budget) -> Option<()> {
        const PARTS: usize = 8;
        // Each part takes two evaluations with bounds of two derivatives, each charged as nine plain values.
        if !budget.charge(square, 2 * PARTS as u64 * 9) {
            return None;
        }
        let parabola = |y: Jet<Interval>| {
            let v = y - Jet::constant(self.middle);
            Jet::constant(self.c0) + v * Jet::constant(self.c1) + v.powi(2) * Jet::constant(self.c2)
        };
        let (mut error, mut slope_error, mut max_square) = (0.0_f64, 0.0_f64, 0.0_f64);
        let end = |part: usize| self.from + (self.to - self.from) * part as f64 / PARTS as f64;
        for part in 0..PARTS {
            let (low, high) = (end(part), if part + 1 == PARTS { self.to } else { end(part + 1) });
            let middle = 0.5 * (low + high);
            let reach = (high - middle).max(middle - low);
            let at = |y: Interval| {
                let y = Jet::variable(y);
                let value = square.at(y);
                (value, value - parabola(y))
            };
            let (_, thin) = at(Interval::constant(middle));
            let (value, wide) = at(Interval { low, high });
            let thin_value = thin.value.magnitude();
            // The tightest bound counts: by Taylor's theorem of second or first order, or by the values.
            let second =
                thin_value + thin.first.magnitude() * reach + 0.5 * wide.second.magnitude() * reach * reach;
            let first = thin_value + wide.first.magnitude() * reach;
            let plain = wide.value.magnitude();
            error = larger_or_infinite(error, second.min(first).min(plain));
            let slope = thin.first.magnitude() + wide.second.magnitude() * reach;
            slope_error = larger_or_infinite(slope_error, slope.min(wide.first.magnitude()));
            max_square = larger_or_infinite(max_square, value.value.high);
        }
        (self.error, self.slope_error, self.max_square) = (error, slope_error, max_square);
        Some(())
    }
}

/// Returns the larger of two numbers, or infinity if the second is NaN.
fn larger_or_infinite(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}
