//! The times of a choice.

/// The times of a piece of work, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// The time of the shortest round.
    pub least: f64,
    /// The median time of the rounds.
    pub median: f64,
    /// The number of rounds.
    pub rounds: usize,
    /// The time that the rounds waited for other work of the machine, as a fraction of the time that they took.
    pub waited: f64,
}

impl Times {
    /// Returns the relative excess of the median round over the shortest.
    pub fn spread(&self) -> f64 {
        self.median / self.least - 1.0
    }
}
