//! Functions for root isolation.

use crate::interval::Interval;
use crate::jet::Jet;
use crate::polynomial::Polynomial;
use crate::roots::bernstein::{Bernstein, NearRoot};
use crate::roots::range::Side;
use crate::roots::twice;
use crate::scalar::Scalar;

/// A function along a line, positive outside of an object and negative inside.
pub trait FunctionOnLine {
    /// Returns the value at a place, in any number type.
    fn at<N: Scalar>(&self, t: N) -> N;

    /// Whether bounds of the value alone are tried on a piece before bounds with derivatives, which take three to six
    /// times as long. This helps if the line is mostly far from its roots.
    const VALUES_FIRST: bool = false;

    /// Whether only roots proven by bounds in `f64` are wanted. A search may then stop where these bounds do not
    /// decide.
    fn wants_proof(&self) -> bool {
        false
    }

    /// Returns bounds of the first and the second derivative on a piece, or `None` if bounds of the value exclude a
    /// root.
    fn slopes(&self, piece: Interval) -> Option<[Interval; 2]> {
        let Jet { value, first, second } = self.at(Jet::variable(piece));
        value.has_zero().then_some([first, second])
    }

    /// Tells whether no root on a piece counts: the function is undefined, the surface is cut off, or known bounds
    /// exclude 0.
    fn is_left_out(&self, _piece: Interval) -> bool {
        false
    }

    /// Tells whether the function certainly has no root on a piece with a jump or a pole. By default, the ends of a
    /// jump past 0 count as connected.
    fn is_broken(&self, _piece: Interval) -> bool {
        false
    }

    /// Returns the degree of the function, less than [`MAX_COEFFICIENTS`](crate::polynomial::MAX_COEFFICIENTS), if it is a polynomial.
    /// Isolating the roots of a polynomial takes fewer operations.
    fn degree(&self) -> Option<usize> {
        None
    }

    /// Returns the function on a piece, if it is a polynomial with at most `N` coefficients.
    fn polynomial<const N: usize>(&self, _piece: Interval) -> Polynomial<f64, N> {
        Polynomial::unknown()
    }

    /// Returns the function's Bernstein form on a piece, if it is a polynomial with at most `N` coefficients.
    fn form<const N: usize>(&self, piece: Interval) -> Option<Bernstein<f64, N>> {
        Bernstein::of(&self.polynomial(piece))
    }

    /// Returns the root of a polynomial near a place, with correct last digits. The polynomial is known there to within
    /// `hidden`. Returns `None` if that takes more steps.
    fn finished(&self, _near: &NearRoot, _hidden: f64) -> Option<f64> {
        None
    }

    /// Returns a simple root of a polynomial with correct last digits. The given root may be off by rounding.
    fn polished(&self, root: f64) -> f64 {
        root
    }

    /// Calls a function with the pieces between two places that may have roots, in order, until it returns a root.
    /// Pieces that begin after `far` may be omitted.
    fn pieces(
        &self,
        (low, high): (f64, f64),
        _far: f64,
        visit: &mut dyn FnMut(f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        visit(low, high)
    }

    /// Returns the root on a piece that bounds in `f64` cannot decide, because rounding hides the function's sign, or
    /// after the maximum number of pieces. A rounded line may answer for the exact line.
    fn undecided(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        let hidden = self.at(Interval::constant(piece.middle())).width();
        twice::first_root(|t| self.at(t), piece, origin_side, hidden)
    }
}
