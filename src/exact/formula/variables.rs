//! The names of the variables of formulas.

/// The variable of a profile.
pub const HEIGHT: &[&str] = &["y"];

/// The variables of a formula of space.
pub const SPACE: &[&str] = &["x", "y", "z"];

/// The variable of a formula of a curve.
pub const CURVE: &[&str] = &["t"];

/// The variables of a formula of a parametric surface.
pub const PATCH: &[&str] = &["u", "v"];

/// The variables of a formula on a surface: the point, u and v, the unit normal, and [`OF_FORMULAS`].
pub const SURFACE: &[&str] =
    &["x", "y", "z", "u", "v", "nx", "ny", "nz", "gradient", "mean_curvature", "gauss_curvature"];

/// The variables of a surface given by a formula. If the scene has a number with the name of a variable, the name means
/// that number.
pub const OF_FORMULAS: &[&str] = SURFACE.split_at(8).1;
