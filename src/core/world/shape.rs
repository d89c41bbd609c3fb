//! A shape together with the ways in which its hits are found and proven.

use crate::world::certify::Equation;
use crate::world::hittable::{Bracketed, Certified, Hittable, Searched};
use std::marker::PhantomData;

/// A shape, how packets of rays are tested against it (`S`), and how its hits are proven (`P`).
///
/// By default, hits are found by the shape's distance, and nothing about them is proven.
pub struct Shape<T, S = ByDistance, P = Unproven> {
    pub(crate) shape: T,
    how: PhantomData<fn() -> (S, P)>,
}

impl<T: Hittable> Shape<T> {
    /// Makes a shape whose hits are found by its distance.
    pub fn new(shape: T) -> Self {
        Self { shape, how: PhantomData }
    }
}

impl<T, S, P> Shape<T, S, P> {
    /// Returns the same shape, with hits found and proven in other ways.
    pub fn by<U, Q>(self) -> Shape<T, U, Q> {
        Shape { shape: self.shape, how: PhantomData }
    }
}

impl<T: Bracketed, P> Shape<T, ByDistance, P> {
    /// Finds hits by the shape's brackets.
    pub fn bracketed(self) -> Shape<T, ByBracket, P> {
        self.by()
    }
}

impl<T: Certified, S> Shape<T, S> {
    /// Proves hits by the shape's equation.
    pub fn certified(self) -> Shape<T, S, ByEquation> {
        self.by()
    }
}

impl<T: Searched, S> Shape<T, S> {
    /// Proves hits by the shape's equation, and finds them by other methods for comparison.
    pub fn searched(self) -> Shape<T, S, ByRoots> {
        self.by()
    }
}

impl<T: Hittable + Equation> Shape<T> {
    /// Finds hits by a formula of the notes, which computes a distance as quickly as a bracket. The distance is not
    /// refined, even where the shape coincides with another surface. The equation states the surface that the notes
    /// mean.
    pub fn classic(self) -> Shape<T, ByDistance, ByFormula> {
        self.by()
    }
}

/// Marks a shape whose hits are found by its distance.
pub struct ByDistance;
/// Marks a shape whose hits are found by its bracket, and refined by its distance.
pub struct ByBracket;
/// Marks a shape whose hits are found by functions of its own that take packets.
pub struct ByPackets;

/// Marks a shape about whose hits nothing is proven.
pub struct Unproven;
/// Marks a shape whose hits are proven by its equation.
pub struct ByEquation;
/// Marks a shape whose hits are proven by its equation, and can be found by other root-finding methods.
pub struct ByRoots;
/// Marks a shape whose hits are found by a formula of the notes, with an equation of the surface that they mean.
pub struct ByFormula;
