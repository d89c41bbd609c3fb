//! Functions whose roots are found.

use crate::interval::Interval;
use crate::jet::Jet;
use crate::polynomial::Polynomial;
use crate::roots::bernstein::{Bernstein, NearRoot};
use crate::roots::range::Side;
use crate::roots::twice;
use crate::scalar::Scalar;

/// A function along a line: above 0 outside an object, below 0 inside.
pub trait FunctionOnLine {
    /// Returns the value at a place, in any number type.
    fn at<N: Scalar>(&self, t: N) -> N;

    /// Whether bounds of the value alone are tried on a piece before its derivatives, which take three to six times as long. That
    /// is worth it where the line is mostly far from its roots.
    const VALUES_FIRST: bool = false;

    /// Whether only a root that bounds in `f64` prove is wanted: then a search may stop where these bounds do not
    /// decide.
    fn wants_proof(&self) -> bool {
        false
    }

    /// Returns bounds of the first and the second derivative on a piece; `None` where the value is seen to have no root there.
    fn slopes(&self, piece: Interval) -> Option<[Interval; 2]> {
        let Jet { value, first, second } = self.at(Jet::variable(piece));
        value.has_zero().then_some([first, second])
    }

    /// Tells whether no root on a piece counts: where the function is not defined, the surface is cut off, or bounds that are known
    /// already are not 0.
    fn is_left_out(&self, _piece: Interval) -> bool {
        false
    }

    /// Tells whether the function certainly has no root on a piece on which it jumps, or has a pole. By default, the ends of a
    /// jump past 0 count as connected.
    fn is_broken(&self, _piece: Interval) -> bool {
        false
    }

    /// Returns the degree of the function, if it is a polynomial; less than [`MOST`](crate::polynomial::MOST). The
    /// roots of a polynomial are isolated with fewer operations.
    fn degree(&self) -> Option<usize> {
        None
    }

    /// Returns the function on a piece, if it is a polynomial of less than `N` coefficients.
    fn polynomial<const N: usize>(&self, _piece: Interval) -> Polynomial<f64, N> {
        Polynomial::unknown()
    }

    /// Returns the function's Bernstein form on a piece, if it is a polynomial of less than `N` coefficients.
    fn form<const N: usize>(&self, piece: Interval) -> Option<Bernstein<f64, N>> {
        Bernstein::of(&self.polynomial(piece))
    }

    /// Returns the root of a polynomial near a place, where it is known within `hidden`, with correct last digits; `None` where
    /// that takes more steps.
    fn finished(&self, _near: &NearRoot, _hidden: f64) -> Option<f64> {
        None
    }

    /// Returns a simple root of a polynomial with correct last digits. The given root may be off by rounding.
    fn polished(&self, root: f64) -> f64 {
        root
    }

    /// Calls a function with the pieces between two places on which there may be a root, in their order, until it returns one.
    /// Pieces that begin after `far` may be left out.
    fn pieces(
        &self,
        (low, high): (f64, f64),
        _far: f64,
        visit: &mut dyn FnMut(f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        visit(low, high)
    }

    /// Returns the root on a piece that bounds in `f64` cannot decide, however short: where rounding hides the
    /// function's sign, or after the largest number of pieces. A line that is itself rounded answers for the line that
    /// it stands for.
    fn undecided(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        let hidden = self.at(Interval::constant(piece.middle())).width();
        twice::first_root(|t| self.at(t), piece, origin_side, hidden)
    }
}
