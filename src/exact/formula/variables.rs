//! The names of the variables that formulas are written in.

/// The variable of a profile.
pub const HEIGHT: &[&str] = &["y"];

/// The variables of a formula of space.
pub const SPACE: &[&str] = &["x", "y", "z"];

/// The variables of a formula of a surface: the point, u and v, and the unit normal.
pub const SURFACE: &[&str] = &["x", "y", "z", "u", "v", "nx", "ny", "nz"];
