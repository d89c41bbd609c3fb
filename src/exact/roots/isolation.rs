//! Isolation of the roots of a polynomial, in order, as far as the precision of its coefficients allows.

use super::bernstein::{Bernstein, Roots};
use crate::polynomial::{Coefficient, Polynomial};

/// A part of a polynomial's piece, with ends from -1 to 1.
#[derive(Clone, Copy, Debug)]
pub enum RootPart<C> {
    /// There is no root.
    Free([C; 2]),
    /// There is exactly one root.
    Root {
        /// The ends of the part.
        ends: [C; 2],
        /// Whether the polynomial rises at the root.
        rises: bool,
    },
    /// Rounding hides the roots.
    Hidden([C; 2]),
}

/// Visits the parts into which a piece is cut, in order, until the visitor returns a value. Also returns `None`
/// if nothing is known of the polynomial.
pub fn visit<C: Coefficient, const N: usize, R>(
    polynomial: &Polynomial<C, N>,
    visit: impl FnMut(RootPart<C>) -> Option<R>,
) -> Option<R> {
    let form = Bernstein::of(polynomial)?;
    let mut search = Search { polynomial, visit, hidden: None };
    let taken = search.piece(&form, [C::from(-1.0), C::from(1.0)], depth::<C>());
    taken.or_else(|| search.flush())
}

/// Returns the maximum number of halvings of a piece: slightly more than rounding allows for a polynomial with a double
/// root.
fn depth<C: Coefficient>() -> usize {
    let bits = 1023 - (C::ROUNDING.to_bits() >> 52) as usize;
    bits / 2 + 8
}

struct Search<'p, V, C, const N: usize> {
    polynomial: &'p Polynomial<C, N>,
    visit: V,
    /// A hidden part that the next one may extend.
    hidden: Option<[C; 2]>,
}

impl<C: Coefficient, R, V: FnMut(RootPart<C>) -> Option<R>, const N: usize> Search<'_, V, C, N> {
    fn piece(&mut self, form: &Bernstein<C, N>, ends: [C; 2], depth: usize) -> Option<R> {
        let [low, high] = ends;
        match form.roots() {
            Roots::None => self.flush().or_else(|| (self.visit)(RootPart::Free(ends))),
            Roots::One { rises, .. } => self.flush().or_else(|| (self.visit)(RootPart::Root { ends, rises })),
            Roots::Unknown | Roots::Monotone { .. } if depth > 0 => {
                let middle = C::from(0.5) * (low + high);
                let [lower, upper] = form.halves();
                let taken = self.piece(&lower, [low, middle], depth - 1);
                taken.or_else(|| self.piece(&upper, [middle, high], depth - 1))
            }
            Roots::Unknown | Roots::Monotone { .. } | Roots::Hidden => {
                let low = self.hidden.map_or(low, |[low, _]| low);
                self.hidden = Some([low, high]);
                None
            }
        }
    }

    /// Visits the hidden part. A root where halving cuts a piece is hidden by both halves, and simple all the same.
    fn flush(&mut self) -> Option<R> {
        let ends = self.hidden.take()?;
        let root = only_root(self.polynomial, ends).map(|rises| RootPart::Root { ends, rises });
        (self.visit)(root.unwrap_or(RootPart::Hidden(ends)))
    }
}

/// Tells whether the polynomial rises between two places, if it certainly has exactly one root there and is certainly
/// monotonic.
fn only_root<C: Coefficient, const N: usize>(polynomial: &Polynomial<C, N>, ends: [C; 2]) -> Option<bool> {
    let hidden = polynomial.error_at();
    let [from, to] = ends.map(|end| polynomial.at(end));
    let [low, high] = [from, to].map(|[value, _]| value.nearest());
    let slope = from[1].nearest();
    let changes = low.abs().min(high.abs()) > hidden && (low < 0.0) != (high < 0.0);
    let is_steep = slope.abs() > polynomial.slope_change((ends[1] - ends[0]).nearest());
    (changes && is_steep && (slope > 0.0) == (high > 0.0)).then_some(high > 0.0)
}

/// The maximum number of steps of [`refined`]. By then, mere bisection has shrunk a bracket by 2^-240.
const MAX_STEPS: usize = 240;

/// Returns the only root between two places, by Newton's method in a bracket.
pub fn refined<C: Coefficient, const N: usize>(
    polynomial: &Polynomial<C, N>,
    [mut low, mut high]: [C; 2],
    rises: bool,
) -> C {
    let (zero, half, hidden) = (C::from(0.0), C::from(0.5), polynomial.error_at());
    let mut at = half * (low + high);
    for _ in 0..MAX_STEPS {
        let [value, slope] = polynomial.at(at);
        if value.nearest().abs() <= hidden {
            break;
        }
        if (value < zero) == rises {
            low = at;
        } else {
            high = at;
        }
        let newton = at - value / slope;
        // The comparisons are false for NaN.
        let next = if newton > low && newton < high { newton } else { half * (low + high) };
        if !(next > low && next < high) {
            break;
        }
        at = next;
    }
    at
}

/// Returns places around the only root between two others, as close to it as rounding allows. The signs of the
/// polynomial are certain at these places, unless they are the ends.
pub fn enclosed<C: Coefficient, const N: usize>(
    polynomial: &Polynomial<C, N>,
    [low, high]: [C; 2],
    rises: bool,
) -> [C; 2] {
    let at = refined(polynomial, [low, high], rises);
    let (hidden, slope) = (polynomial.error_at(), polynomial.at(at)[1].nearest().abs());
    let mut reach = 4.0 * (hidden / slope + C::ROUNDING);
    while reach < 1.0 {
        let around = [at - C::from(reach), at + C::from(reach)];
        let signs = around.map(|place| polynomial.at(place)[0].nearest() * if rises { 1.0 } else { -1.0 });
        let inside = around[0] > low && around[1] < high;
        if inside && signs[0] < -hidden && signs[1] > hidden {
            return around;
        }
        reach *= 4.0;
    }
    [low, high]
}
