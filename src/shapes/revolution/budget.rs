//! What cutting a profile may cost.

use crate::numeric::formula::Formula;

/// The operations of formulas that one profile may take, a function counted as eight: half a second's worth in a
/// program built without optimisation, a tenth of that in one built with it.
pub const OPERATIONS: u64 = 60_000_000;

/// How many of them are left.
pub(super) struct Budget(u64);

impl Budget {
    pub fn new() -> Self {
        Self(OPERATIONS)
    }

    /// Pays for evaluating a formula, so many times as the value alone costs; tells whether that could be paid.
    pub fn spend(&mut self, formula: &Formula, times: u64) -> bool {
        let cost = formula.cost() * times;
        let can = cost <= self.0;
        self.0 = self.0.saturating_sub(cost);
        can
    }
}
