//! What formulas compute with, and formulas.

pub(crate) mod dual;
pub(crate) mod formula;
pub(crate) mod interval;
pub(crate) mod number;
pub(crate) mod octet;
pub mod twofold;

pub use dual::Dual;
pub use formula::Formula;
pub use interval::{Float, Interval, Wide};
pub use number::Number;
