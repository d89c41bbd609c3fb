//! What a plugin says of an implicit surface.

use glam::{DVec2, DVec3};
use tabray_exact::formula::field::Field;
use tabray_exact::interval::Interval;
use tabray_exact::polynomial::{Coefficient, Polynomial};
use tabray_exact::scalar::Scalar;

/// Why a surface that the faces of its box would close is not closed: [`Implicit::why_not_closed`].
pub const CUT_BY_BOX: &str = "its box may cut its surface";

/// An implicit surface, in coordinates of its own.
pub trait Implicit: Send + Sync {
    /// Whether the box may be far larger than the shape, so that most of a ray in the box is far from the surface.
    const IS_IN_WIDE_BOX: bool = false;

    /// Returns the value of the formula at a point: below 0 inside the shape, above 0 outside, and 0 on the surface.
    fn value<N: Scalar>(&self, at: [N; 3]) -> N;

    /// Returns the value of a polynomial that is below 0, 0 and above 0 where the formula is: a polynomial of degree 40
    /// or less isolates first hits faster. By default, this is the formula itself, which need not be a polynomial.
    fn polynomial<N: Scalar>(&self, at: [N; 3]) -> N {
        self.value(at)
    }

    /// Returns the [`polynomial`](Self::polynomial) along a line.
    fn along<C: Coefficient, const N: usize>(&self, at: [Polynomial<C, N>; 3]) -> Polynomial<C, N> {
        match self.field() {
            Some(field) => field.along(at),
            None => self.polynomial(at),
        }
    }

    /// Returns the formula itself, if it is one of a scene: where it is a polynomial with rational coefficients, no first hit is
    /// left open.
    fn field(&self) -> Option<&Field> {
        None
    }

    /// Tells whether more than the box cuts the surface. If not, [`inside_trim`](Self::inside_trim) is not called.
    #[inline]
    fn is_cut(&self) -> bool {
        false
    }

    /// Returns a number that is not below 0 where the surface is kept, and below 0 where it is cut off.
    fn inside_trim<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(1.0)
    }

    /// Says why the surface is not closed; `None` for a closed surface that lies within its box.
    fn why_not_closed(&self) -> Option<&'static str> {
        Some("it has no inside")
    }

    /// Returns the height of a closed shape that ends in planes at y = 0 and at this height, and has the same cross-section
    /// between them; `None` for any other shape.
    fn extruded(&self) -> Option<f64> {
        None
    }

    /// Returns the coordinates u and v of a point of the surface, for shaders; `None` where it has none.
    fn uv(&self, _at: DVec3) -> Option<DVec2> {
        None
    }

    /// Encloses the coordinates u and v, before any rounding, of the points of the surface in a box; `None` where they
    /// are not known, which is always correct. Proofs of colours ask for them.
    fn uv_bounds(&self, _at: [Interval; 3]) -> Option<[Interval; 2]> {
        None
    }

    /// Returns the low and the high corner of a box around the shape. The box cuts off the surface outside of it, and a
    /// shape that is cut shows its inside.
    fn bounds(&self) -> [DVec3; 2];
}
