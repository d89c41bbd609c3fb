//! The order in which a search visits the children of a node.

/// Which children of a node are visited first: those whose boxes a ray enters first, or those whose boxes it enters last.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// For the nearest hit, behind which nothing is visited.
    Nearest,
    /// For any hit of a ray that leaves a surface: the many boxes around its origin hold the surface that it leaves, and
    /// seldom what it hits.
    Farthest,
}

impl Order {
    /// Tells whether the child that a ray enters at one distance is visited after that which it enters at another one.
    #[inline(always)]
    pub(super) fn is_later(self, one: f64, other: f64) -> bool {
        match self {
            Self::Nearest => other < one,
            Self::Farthest => one < other,
        }
    }
}
