//! The configuration of property tests, for the unit tests of several crates.

use proptest::test_runner::{Config, FileFailurePersistence};

/// Returns the configuration of property tests. Failed cases are kept below `tests/`.
pub(crate) fn properties() -> Config {
    let kept = FileFailurePersistence::SourceParallel("../tests/proptest-regressions");
    Config { failure_persistence: Some(Box::new(kept)), ..Config::default() }
}
