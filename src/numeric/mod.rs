//! What formulas compute with, and formulas.

pub mod dual;
pub mod formula;
pub mod interval;
pub mod number;
pub mod octet;
pub mod twofold;
