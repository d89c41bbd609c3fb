//! The interface between a plugin and the search for hits of its implicit surface.

use glam::{DVec2, DVec3};
use tabray_exact::formula::field::Field;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;
use tabray_world::luminous::Luminous;

/// The reason why a surface is not closed that the faces of its box would close: [`Implicit::why_not_closed`].
pub const CUT_BY_BOX: &str = "its box may cut its surface";

/// An implicit surface, in its own coordinates.
pub trait Implicit: Send + Sync {
    /// Whether the box may be far larger than the shape, with most of a ray in the box far from the surface.
    const IS_IN_WIDE_BOX: bool = false;

    /// Returns the value of the formula at a point: negative inside the shape, positive outside, and 0 on the surface.
    /// Proofs call it once, with numbers that record the operations: their bounds are infinite, and a branch that depends on
    /// bounds is taken as where nothing is known.
    fn value<N: Scalar>(&self, at: [N; 3]) -> N;

    /// Returns the value of a polynomial with the same sign as the formula everywhere. It is recorded when the shape is
    /// made, as [`value`](Self::value) is for proofs. A polynomial of degree 40 or less isolates first hits faster, and
    /// decides those exactly that rounding leaves open. By default, this is the formula itself, which need not be a polynomial.
    fn polynomial<N: Scalar>(&self, at: [N; 3]) -> N {
        self.value(at)
    }

    /// Returns the formula, if a scene gives it.
    fn field(&self) -> Option<&Field> {
        None
    }

    /// Tells whether more than the box cuts the surface. If not, [`inside_trim`](Self::inside_trim) is not called.
    #[inline]
    fn is_cut(&self) -> bool {
        false
    }

    /// Returns a number that is negative where the surface is cut off.
    fn inside_trim<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(1.0)
    }

    /// Returns a number that is negative where a condition of the scene cuts the surface off, although its formula is
    /// defined there. It is part of [`inside_trim`](Self::inside_trim).
    fn condition<N: Scalar>(&self, _at: [N; 3]) -> N {
        N::constant(1.0)
    }

    /// Returns the reason why the surface is not closed, or `None` for a closed surface within its box.
    fn why_not_closed(&self) -> Option<&'static str> {
        Some("it has no inside")
    }

    /// Returns the whole surface as rays aim at it where it gives light; `None` where only chance is to meet it.
    fn luminous(&self) -> Option<Luminous> {
        None
    }

    /// Returns the height of a prism or cylinder that ends in the planes at y = 0 and at this height. Returns `None`
    /// for other shapes.
    fn extruded(&self) -> Option<f64> {
        None
    }

    /// Returns the coordinates u and v of a point of the surface, for shaders, or `None` if it has none.
    fn uv(&self, _at: DVec3) -> Option<DVec2> {
        None
    }

    /// Encloses the exact coordinates u and v of the surface's points in a box. `None` stands for unknown coordinates,
    /// and is always correct. Proofs of colours call this.
    fn uv_bounds(&self, _at: [Interval; 3]) -> Option<[Interval; 2]> {
        None
    }

    /// Returns the low and the high corner of a box around the shape. The box cuts off the surface outside of it, and
    /// the inside of a cut shape is visible. Unless it [is exact](Self::is_box_exact), the box is widened by far more
    /// than the rounding of its numbers, so that it may touch the shape.
    fn bounds(&self) -> [DVec3; 2];

    /// Tells whether the box is to cut off the surface exactly where it is, as the box does that a scene gives.
    fn is_box_exact(&self) -> bool {
        false
    }
}
