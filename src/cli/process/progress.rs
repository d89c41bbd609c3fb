//! Shows progress on a terminal.

use crate::process::messages;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The bar that is shown, if there is one.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// The index of the scene under way, and the number of scenes.
static OVERALL: Mutex<Option<[usize; 2]>> = Mutex::new(None);

/// Says that a scene begins, after so many others, of so many.
pub fn begin(done: usize, all: usize) {
    *OVERALL.lock().unwrap_or_else(PoisonError::into_inner) = Some([done, all]);
}

/// Says that all scenes are over.
pub fn clear_overall() {
    *OVERALL.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

/// Returns how many of several scenes are over, and how many there are.
pub fn overall() -> Option<[usize; 2]> {
    *OVERALL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns which of several scenes is under way, for the beginning of a message; nothing where there is one.
pub fn count() -> String {
    overall().map_or(String::new(), |[done, all]| format!("[{}/{all}] ", done + 1))
}

/// Removes the bar from the terminal, when the program ends.
pub fn clear() {
    if let Some(bar) = SHOWN.lock().unwrap_or_else(PoisonError::into_inner).take() {
        bar.finish_and_clear();
    }
}

/// A progress bar on a terminal, shown once the work takes noticeable time.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
}

impl Progress {
    pub fn new(steps: usize) -> Self {
        let style = ProgressStyle::with_template("{msg}{wide_bar} {percent:>3} % {eta} left");
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        if let Some([done, all]) = overall() {
            // As if every scene had as many steps.
            bar.set_length((all * steps) as u64);
            bar.set_position((done * steps) as u64);
            bar.reset_eta();
            bar.set_message(count());
        }
        Self {
            bar: bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())),
            start: Instant::now(),
        }
    }

    /// Adds steps that are to be done.
    pub fn inc_length(&self, steps: usize) {
        self.bar.inc_length(steps as u64);
    }

    pub fn step(&self) {
        self.advance(1);
    }

    /// Counts steps as done.
    pub fn advance(&self, steps: usize) {
        if self.bar.is_hidden() && !messages::is_quiet() && self.start.elapsed() > Duration::from_millis(500)
        {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(self.bar.clone());
        }
        self.bar.inc(steps as u64);
    }

    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}
