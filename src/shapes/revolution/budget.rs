//! The budget of operations for cutting a profile.

use tabray_exact::formula::Formula;

/// The maximum number of formula operations for one profile, a function counted as eight: half a second in a build
/// without optimization, a tenth of that in an optimized one.
pub const OPERATIONS: u64 = 60_000_000;

/// The number of operations left.
pub(super) struct Budget(u64);

impl Budget {
    pub fn new() -> Self {
        Self(OPERATIONS)
    }

    /// Charges the cost of evaluating a formula's value this many times. Returns whether the budget sufficed.
    pub fn charge(&mut self, formula: &Formula, times: u64) -> bool {
        let cost = formula.cost() * times;
        let can = cost <= self.0;
        self.0 = self.0.saturating_sub(cost);
        can
    }
}
