//! Formulas in x, y and z.

use super::{Formula, MAX_DEPTH, SMALL_STACK};
use crate::numeric::scalar::Scalar;
use std::sync::Arc;

/// The variables of a formula of space.
pub const SPACE: &[&str] = &["x", "y", "z"];

/// A formula in x, y and z: `x^2 + y^2 + z^2 - 1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Field(Arc<Formula>);

impl Field {
    /// Takes a formula, if its variables are x, y and z.
    pub fn new(formula: Arc<Formula>) -> Option<Self> {
        (formula.variables() == SPACE).then_some(Self(formula))
    }

    /// Returns the formula.
    pub fn formula(&self) -> &Arc<Formula> {
        &self.0
    }

    /// Evaluates the formula at a point.
    #[inline(always)]
    pub fn at<N: Scalar>(&self, at: [N; 3]) -> N {
        let variable = |index: u8| at[usize::from(index)];
        if self.0.stack_depth <= SMALL_STACK {
            self.0.run(variable, &mut [at[0]; SMALL_STACK])
        } else {
            self.0.run(variable, &mut [at[0]; MAX_DEPTH])
        }
    }
}
