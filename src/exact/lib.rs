//! Formulas, number types for their evaluation, and proven roots.
//!
//! The same formula can be evaluated with any [`Scalar`]: `f64`, an [`Interval`] that encloses all values, a [`Dual`]
//! number or a [`Jet`] for derivatives, or [`Wide`] intervals with endpoints of 237 bits.
//!
//! ```
//! use tabray_exact::{Dual, Formula, Interval};
//!
//! let wave = Formula::parse("1.5 + sin(y) - y/4").map_err(|fault| fault.message)?;
//! assert_eq!(wave.at(0.0), 1.5);
//! assert_eq!(wave.at(Dual { value: 0.0, slope: 1.0 }).slope, 0.75);
//! // It has no root from 0 to 1, whatever rounding does.
//! let over = wave.at(Interval { low: 0.0, high: 1.0 });
//! assert!(!over.has_zero() && over.low > 1.2 && over.high < 2.5);
//! # Ok::<(), String>(())
//! ```
//!
//! `cargo run -p tabray-exact --example bounds` proves the first zero of that formula.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the system's functions"))]

pub mod affine;
mod chain_rule;
pub mod decimal;
pub mod double_double;
pub mod dual;
pub mod f64x8;
pub mod formula;
pub mod gradient;
pub mod interval;
pub mod jet;
mod noise;
pub mod polynomial;
pub mod roots;
pub mod scalar;
mod sines;
pub mod spline;
pub mod text;
pub mod whole_line;

pub use dual::Dual;
pub use formula::Formula;
pub use interval::{Float, Interval, Wide};
pub use jet::Jet;
pub use scalar::Scalar;

/// Returns the configuration of property tests. Failed cases are kept below `tests/`.
#[cfg(test)]
pub(crate) fn properties() -> proptest::prelude::ProptestConfig {
    use proptest::test_runner::{Config, FileFailurePersistence};
    let kept = FileFailurePersistence::SourceParallel("../tests/proptest-regressions");
    Config { failure_persistence: Some(Box::new(kept)), ..Config::default() }
}
