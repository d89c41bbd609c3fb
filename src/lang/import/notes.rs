//! The messages about a file of another program.

use crate::reader::{Fault, Report};

/// What is to be said of a file.
pub(super) struct Notes {
    pub report: Report,
    /// Words that have no part in what is seen, and where they stand.
    pub left: Vec<(String, usize)>,
}

impl Notes {
    pub fn add(&mut self, fault: Fault) {
        self.report.add(fault);
    }

    pub fn leave(&mut self, word: &str, at: usize) {
        self.left.push((word.to_owned(), at));
    }
}
