//! Number types that formulas are evaluated with, and formulas.

pub(crate) mod affine;
pub(crate) mod decimal;
pub mod double_double;
pub(crate) mod dual;
pub(crate) mod f64x8;
pub(crate) mod formula;
pub(crate) mod interval;
pub(crate) mod jet;
pub(crate) mod polynomial;
pub(crate) mod scalar;
pub(crate) mod spline;

pub use dual::Dual;
pub use formula::Formula;
pub use interval::{Float, Interval, Wide};
pub use jet::Jet;
pub use scalar::Scalar;
