//! The search for the first root where a function is a polynomial: by the signs of its Bernstein coefficients, on shorter and
//! shorter pieces.

use super::{FunctionOnLine, Judgement, Search};
use crate::dual::Dual;
use crate::interval::Interval;
use crate::polynomial::Polynomial;
use crate::roots::bernstein::{Bernstein, Roots};
use crate::roots::newton;
use std::ops::Range;

/// The error of a root's guess, as a fraction of the piece.
const NEAR: f64 = 1e-9;

/// A polynomial is expanded once more on a piece where that makes its error smaller than this fraction.
const SMALLER: f64 = 0.25;

/// A polynomial, and the piece that it is expanded on.
struct Expansion<'p, const N: usize> {
    polynomial: &'p Polynomial<f64, N>,
    low: f64,
    high: f64,
}

impl<const N: usize> Expansion<'_, N> {
    /// Returns a place near the only root on a part of the piece, from a guess: evaluating the polynomial is quicker than the
    /// function.
    fn near_root(&self, (low, high): (f64, f64), rises: bool, guess: f64) -> f64 {
        let (middle, half) = (0.5 * self.low + 0.5 * self.high, 0.5 * (self.high - self.low));
        let at = |t: f64| (t - middle) / half;
        let line = |s: f64| {
            let [value, slope] = self.polynomial.at(s);
            Dual { value, slope }
        };
        middle + half * newton::root(line, (at(low), at(high)), !rises, at(guess), NEAR)
    }
}

impl<L: FunctionOnLine> Search<'_, L> {
    /// Returns the first root on a piece on which the function is a polynomial.
    pub(super) fn expand<const N: usize>(&mut self, low: f64, high: f64) -> Option<f64> {
        let polynomial = self.line.polynomial::<N>(Interval { low, high });
        match Bernstein::of(&polynomial) {
            Some(form) => {
                let expansion = Expansion { polynomial: &polynomial, low, high };
                self.on_a_polynomial(low, high, &form, &expansion).or_else(|| self.reveal())
            }
            None => self.on_a_piece(low, high),
        }
    }

    /// Returns the first root on a piece on which the function is a polynomial, or adds to what is [hidden](Self::reveal).
    fn on_a_polynomial<const N: usize>(
        &mut self,
        low: f64,
        high: f64,
        form: &Bernstein<f64, N>,
        expansion: &Expansion<'_, N>,
    ) -> Option<f64> {
        let is_given_up = self.line.wants_proof() && !self.is_certain;
        // A hidden piece is judged together with all hidden pieces next to it, wherever the range begins or ends, so
        // that the root is the same for every range.
        let is_beyond = self.base + low >= self.range.far && self.hidden.is_none();
        if is_given_up || is_beyond {
            return None;
        }
        let middle = low + 0.5 * (high - low);
        let judgement = match form.roots() {
            Roots::None => return self.reveal(),
            Roots::Unknown if *self.pieces > 0 && high - low > self.shortest => {
                *self.pieces -= 1;
                let [left, right] = form.halves();
                let root = self.on_a_polynomial(low, middle, &left, expansion);
                return root.or_else(|| self.on_a_polynomial(middle, high, &right, expansion));
            }
            Roots::Unknown | Roots::Hidden => {
                let polynomial = self.line.polynomial::<N>(Interval { low, high });
                return match Bernstein::of(&polynomial) {
                    Some(again) if *self.pieces > 0 && again.error() < SMALLER * form.error() => {
                        *self.pieces -= 1;
                        let expansion = Expansion { polynomial: &polynomial, low, high };
                        self.on_a_polynomial(low, high, &again, &expansion)
                    }
                    _ => self.hide(low, high),
                };
            }
            Roots::One { rises, near } => {
                if let Some(root) = self.reveal() {
                    return Some(root);
                }
                self.note_ends(low, high);
                match self.counts(rises) {
                    true => {
                        let near = expansion.near_root((low, high), rises, low + near * (high - low));
                        Judgement::Root(self.newton(low, high, rises, near))
                    }
                    false => Judgement::Free,
                }
            }
            Roots::Monotone { rises, near } => {
                if let Some(root) = self.reveal() {
                    return Some(root);
                }
                self.note_ends(low, high);
                self.judge_monotone(low, high, rises, low + near * (high - low))
            }
        };
        // On its piece still, so that the same pieces are left out where the range begins or ends beside it.
        let Judgement::Root(root) = judgement else { return None };
        let root = self.line.polished(root).clamp(low, high);
        self.is_in_range(root).then_some(root)
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

    /// Adds a piece to what rounding hides, or judges what was hidden before, if that is not next to it. A line that leaves a
    /// surface is on it at its start, and not on what follows.
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

    /// Returns the first root on what is hidden.
    fn reveal(&mut self) -> Option<f64> {
        let (low, high) = self.hidden.take()?;
        match self.undecided(low, high) {
            Judgement::Root(root) if self.is_in_range(root) => Some(root),
            _ => None,
        }
    }
}
