//! The search for the first root of a polynomial, by the signs of its Bernstein coefficients on shorter and shorter
//! pieces.

use super::{FunctionOnLine, Judgement, Search};
use crate::interval::Interval;
use crate::roots::bernstein::{Bernstein, NearRoot, Roots};
use std::ops::Range;

/// The part of a piece, on either side of a place near a root, that contains the root unless rounding hides much of the
/// polynomial.
const BESIDE: f64 = 1e-6;

/// A polynomial is expanded again on a piece if that reduces its error to less than this fraction.
const SMALLER: f64 = 0.25;

impl<L: FunctionOnLine> Search<'_, L> {
    /// Returns the first root on a piece where the function is a polynomial.
    pub(super) fn expand<const N: usize>(&mut self, low: f64, high: f64) -> Option<f64> {
        match self.line.form::<N>(Interval { low, high }) {
            Some(form) => self.on_a_polynomial(low, high, &form).or_else(|| self.reveal()),
            None => self.on_a_piece(low, high),
        }
    }

    /// Returns the first root on a piece where the function is a polynomial, or extends the [hidden](Self::reveal)
    /// piece.
    fn on_a_polynomial<const N: usize>(
        &mut self,
        low: f64,
        high: f64,
        form: &Bernstein<f64, N>,
    ) -> Option<f64> {
        let is_given_up = self.line.wants_proof() && !self.is_certain;
        // A hidden piece is decided together with all adjacent hidden pieces, regardless of the ends of the range. The
        // root is thus the same for each range.
        let is_beyond = self.base + low >= self.range.far && self.hidden.is_none();
        if is_given_up || is_beyond {
            return None;
        }
        let middle = low + 0.5 * (high - low);
        // Rounded sums keep their order.
        let is_before = self.base + high <= self.range.near;
        let judgement = match form.roots() {
            Roots::None => return self.reveal(),
            Roots::Unknown if *self.pieces > 0 && high - low > self.shortest => {
                *self.pieces -= 1;
                let [left, right] = form.halves();
                let root = self.on_a_polynomial(low, middle, &left);
                return root.or_else(|| self.on_a_polynomial(middle, high, &right));
            }
            Roots::Unknown | Roots::Hidden => {
                let polynomial = self.line.polynomial::<N>(Interval { low, high });
                return match Bernstein::of(&polynomial) {
                    Some(again) if *self.pieces > 0 && again.error() < SMALLER * form.error() => {
                        *self.pieces -= 1;
                        self.on_a_polynomial(low, high, &again)
                    }
                    _ => self.hide(low, high),
                };
            }
            Roots::One { rises, near } => {
                let hidden = self.reveal();
                if hidden.is_some() || is_before || !self.counts(rises) {
                    return hidden;
                }
                let (start, end) = (self.inner.start - low, high - self.inner.end);
                if !form.has_clear_ends(start.max(end) / (high - low)) {
                    self.note_ends(low, high);
                }
                let near = form.near_root(rises, near);
                let root = low + near.place * (high - low);
                if self.is_outside(root, BESIDE * (high - low), rises, (low, high)) {
                    return None;
                }
                let near = NearRoot { place: root, slope: near.slope / (high - low), ..near };
                if let Some(root) = self.line.finished(&near, form.error()) {
                    let root = root.clamp(low, high);
                    return self.is_in_range(root).then_some(root);
                }
                Judgement::Root(self.newton(low, high, rises, root))
            }
            Roots::Monotone { rises, near } => {
                let hidden = self.reveal();
                if hidden.is_some() || is_before {
                    return hidden;
                }
                self.note_ends(low, high);
                self.judge_monotone(low, high, rises, low + near * (high - low))
            }
        };
        // Clamping to the piece omits the same pieces regardless of the ends of the range.
        let Judgement::Root(root) = judgement else { return None };
        let root = self.line.polished(root).clamp(low, high);
        self.is_in_range(root).then_some(root)
    }

    /// Tells whether the only root on a piece, where the function rises or falls, is certainly out of the range. It is
    /// near a place, and within `beside` of it if the function has different signs there.
    fn is_outside(&self, near: f64, beside: f64, rises: bool, (low, high): (f64, f64)) -> bool {
        let (before, after) = ((near - beside).max(low), (near + beside).min(high));
        let is_above = |t: f64, above: bool| {
            let value = self.value(t);
            if above { value.low > 0.0 } else { value.high < 0.0 }
        };
        self.base + after < self.range.near && is_above(after, rises)
            || self.base + before > self.range.far && is_above(before, !rises)
    }

    /// Notes that nothing is certain if the root on a piece may lie where rounding hides whether the line is still
    /// between the ends.
    fn note_ends(&mut self, low: f64, high: f64) {
        let Range { start, end } = self.inner;
        let may_be_zero = |low: f64, high: f64| low < high && self.line.at(Interval { low, high }).has_zero();
        if may_be_zero(low, start.min(high)) || may_be_zero(end.max(low), high) {
            self.is_certain = false;
        }
    }

    /// Adds a piece to the hidden one, or decides the hidden one if the two are not adjacent. A line that leaves a
    /// surface is on it at its start, but not on the next pieces.
    fn hide(&mut self, low: f64, high: f64) -> Option<f64> {
        match self.hidden {
            Some((start, end)) if end == low && (start != self.start || self.range.origin_side.is_none()) => {
                self.hidden = Some((start, high));
                None
            }
            _ => {
                let root = self.reveal();
                self.hidden = Some((low, high));
                root
            }
        }
    }

    /// Returns the first root on the hidden piece.
    fn reveal(&mut self) -> Option<f64> {
        let (low, high) = self.hidden.take()?;
        match self.undecided(low, high) {
            Judgement::Root(root) if self.is_in_range(root) => Some(root),
            _ => None,
        }
    }
}
