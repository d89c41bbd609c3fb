//! Messages about a file of another program.

use tabray_lang::reader::{Fault, Report};

/// The messages about a file.
pub(super) struct Notes {
    pub report: Report,
    /// The words that do not affect the picture, and their places.
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
