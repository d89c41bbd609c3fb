//! Shows progress on a terminal.

use crate::process::messages;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, Write};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// The form of the progress display.
#[derive(Clone, Copy, Default, PartialEq, clap::ValueEnum)]
pub enum Form {
    /// As a bar, on a terminal
    #[default]
    Bar,
    /// For programs: as JSON on standard error, one object per line, at most ten per second
    Json,
}

/// The form of the progress display.
static CHOSEN: OnceLock<Form> = OnceLock::new();

/// Sets how all later progress is shown.
pub fn choose(form: Form) {
    CHOSEN.get_or_init(|| form);
}

/// The least time between two lines of progress.
const BETWEEN: Duration = Duration::from_millis(100);

/// The progress bar, if one is shown.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// The index of the scene under way, and the number of scenes.
static OVERALL: Mutex<Option<[usize; 2]>> = Mutex::new(None);

/// Reports that a scene begins: how many were before it, and how many there are.
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

/// Returns which of several scenes is under way, for the beginning of a message; nothing if there is only one scene.
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
    /// When progress was last told to a program.
    told: Mutex<Instant>,
    /// The noise of what is done, in levels, where it is known.
    noise: Mutex<Option<f64>>,
}

impl Progress {
    /// Begins with nothing of this many steps done.
    pub fn new(steps: usize) -> Self {
        let style = ProgressStyle::with_template("{prefix}{wide_bar} {percent:>3} % {eta} left{msg}");
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        if let Some([done, all]) = overall() {
            // As if every scene had as many steps.
            bar.set_length((all * steps) as u64);
            bar.set_position((done * steps) as u64);
            bar.reset_eta();
            bar.set_prefix(count());
        }
        Self {
            bar: bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())),
            start: Instant::now(),
            told: Mutex::new(Instant::now()),
            noise: Mutex::default(),
        }
    }

    /// Tells a program how much is done.
    fn tell(&self) {
        let (done, of) = (self.bar.position(), self.bar.length().unwrap_or_default());
        let noise = *self.noise.lock().unwrap_or_else(PoisonError::into_inner);
        let noise = noise.map_or(String::new(), |levels| format!(",\"noise\":{levels:.3}"));
        // Who does not read it misses it.
        let _ = writeln!(io::stderr(), "{{\"progress\":{{\"done\":{done},\"of\":{of}{noise}}}}}");
    }

    /// Sets the noise of what is done: its root mean square error as it is shown, in levels of 255.
    pub fn set_noise(&self, levels: f64) {
        *self.noise.lock().unwrap_or_else(PoisonError::into_inner) = Some(levels);
        if !self.bar.is_hidden() {
            self.bar.set_message(format!(", noise {levels:.2} levels"));
        }
    }

    fn is_for_programs() -> bool {
        CHOSEN.get() == Some(&Form::Json)
    }

    /// Adds steps that are to be done.
    pub fn inc_length(&self, steps: usize) {
        self.bar.inc_length(steps as u64);
    }

    /// Counts a step as done.
    pub fn step(&self) {
        self.advance(1);
    }

    /// Counts steps as done.
    pub fn advance(&self, steps: usize) {
        if Self::is_for_programs() {
            self.bar.inc(steps as u64);
            if let Ok(mut told) = self.told.try_lock()
                && told.elapsed() >= BETWEEN
            {
                *told = Instant::now();
                self.tell();
            }
            return;
        }
        if self.bar.is_hidden() && !messages::is_quiet() && self.start.elapsed() > Duration::from_millis(500)
        {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(self.bar.clone());
        }
        self.bar.inc(steps as u64);
    }

    /// Takes the bar away.
    pub fn end(&self) {
        if Self::is_for_programs() && !self.bar.is_finished() {
            self.tell();
        }
        self.bar.finish_and_clear();
    }
}
