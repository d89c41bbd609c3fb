//! A shape with what it has opted into.

use crate::world::certify::Equation;
use crate::world::hittable::{Bracketed, Certified, Hittable, Searched};
use std::marker::PhantomData;

/// A shape, how packets of rays find it (`S`), and what can be proven of its hits (`P`).
///
/// Without more, it is found by its distance, and nothing is proven of that.
pub struct Shape<T, S = ByDistance, P = Unproven> {
    pub(crate) shape: T,
    how: PhantomData<fn() -> (S, P)>,
}

impl<T: Hittable> Shape<T> {
    /// A shape that is found by its distance.
    pub fn new(shape: T) -> Self {
        Self { shape, how: PhantomData }
    }
}

impl<T, S, P> Shape<T, S, P> {
    /// The same shape, found and proven in other ways.
    pub(crate) fn by<U, Q>(self) -> Shape<T, U, Q> {
        Shape { shape: self.shape, how: PhantomData }
    }
}

impl<T: Bracketed, P> Shape<T, ByDistance, P> {
    /// Found by its brackets.
    pub fn bracketed(self) -> Shape<T, ByBracket, P> {
        self.by()
    }
}

impl<T: Certified, S> Shape<T, S> {
    /// Proven by its equation.
    pub fn certified(self) -> Shape<T, S, ByEquation> {
        self.by()
    }
}

impl<T: Searched, S> Shape<T, S> {
    /// Proven by its equation, and found by other methods for comparison.
    pub fn searched(self) -> Shape<T, S, ByRoots> {
        self.by()
    }
}

impl<T: Hittable + Equation> Shape<T> {
    /// Found by a formula of the notes, whose distance is as quick as a bracket, and taken as it is: where it lies
    /// together with another surface nobody looks closer. The equation proves what the notes mean.
    pub fn classic(self) -> Shape<T, ByDistance, ByFormula> {
        self.by()
    }
}

/// Found by its distance.
pub struct ByDistance;
/// Found by its bracket, and by its distance where that is refined.
pub struct ByBracket;
/// Found by functions of its own that take packets.
pub struct ByPackets;

/// Nothing is certain of it.
pub struct Unproven;
/// Proven by its equation.
pub struct ByEquation;
/// Likewise, of a shape that other methods of finding roots find, too.
pub struct ByRoots;
/// A formula of the notes, with an equation of what they mean.
pub struct ByFormula;
