//! Number types that formulas are evaluated with, and formulas.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the system's functions"))]

pub mod affine;
pub mod decimal;
pub mod double_double;
pub mod dual;
pub mod f64x8;
pub mod formula;
pub mod interval;
pub mod jet;
pub mod polynomial;
pub mod roots;
pub mod scalar;
pub mod spline;
pub mod text;

pub use dual::Dual;
pub use formula::Formula;
pub use interval::{Float, Interval, Wide};
pub use jet::Jet;
pub use scalar::Scalar;
