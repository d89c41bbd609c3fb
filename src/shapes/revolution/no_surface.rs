//! Profiles that make no surface.

/// Why a profile makes no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoSurface {
    /// It has no bound.
    Unbounded {
        /// A height where that is so.
        near: f64,
    },
    /// It is nowhere above 0.
    Nowhere,
    /// Where it is negative is not known above a height after as many operations as it may take.
    Signs {
        /// The height.
        from: f64,
    },
    /// It bends more often above a height than as many operations as it may take can follow.
    Bends {
        /// The height.
        from: f64,
    },
    /// Rounding hides where it is negative.
    Rounding {
        /// A height where that is so.
        near: f64,
        /// How large it may be there.
        hidden: f64,
    },
}

impl NoSurface {
    /// What is wrong with the profile, what would help, for messages: "has a profile ...".
    pub fn told(self) -> (String, &'static str) {
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
