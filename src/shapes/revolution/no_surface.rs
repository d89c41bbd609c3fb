//! Profiles that do not make a surface.

/// The reason why a profile does not make a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoSurface {
    /// The profile is unbounded.
    Unbounded {
        /// A height near which the profile is unbounded, in world units.
        near: f64,
    },
    /// The profile is positive nowhere.
    Nowhere,
    /// The ranges with a negative profile cannot be separated within the budget of operations.
    Signs {
        /// The height above which they are not separated, in world units.
        from: f64,
    },
    /// The bends of the profile cannot be bounded within the budget of operations.
    Bends {
        /// The height above which they are not bounded, in world units.
        from: f64,
    },
    /// Rounding hides the sign of the profile.
    Rounding {
        /// A height near which rounding hides the sign, in world units.
        near: f64,
        /// A bound of the profile there, in world units.
        hidden: f64,
    },
}

impl NoSurface {
    /// Returns the error of the profile and its correction, for messages such as "has a profile ...".
    pub fn message(self) -> (String, &'static str) {
        match self {
            Self::Unbounded { near } => (
                format!("that is unbounded near y = {near:.6}"),
                "a profile is the distance from the axis, finite at each height from 0 to `height`",
            ),
            Self::Nowhere => (
                "that is nowhere above 0".to_owned(),
                "a profile is the distance from the axis, finite at each height from 0 to `height`",
            ),
            Self::Signs { from } => (
                format!("with too many parts below 0 to separate them from y = {from:.6} upward"),
                "give a lower `height`, or a profile that crosses 0 less often",
            ),
            Self::Bends { from } => (
                format!("that bends too often to be bounded from y = {from:.6} upward"),
                "give a lower `height`, or a profile that bends less often",
            ),
            Self::Rounding { near, hidden } => (
                format!(
                    "whose sign is lost in rounding near y = {near:.6}: there it is 0 to within an error of {hidden:.1e}"
                ),
                "write the formula so that large terms do not cancel, such as `(y - 3)^2` in place of `y^2 - 6*y + 9`",
            ),
        }
    }
}
