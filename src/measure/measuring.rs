//! The progress of a measurement: a bar on a terminal, and lines elsewhere. An interruption ends it, and so does a time
//! limit.

use crate::chart::{self, Panel};
use std::io::{self, IsTerminal};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::process::messages;
use tabray_cli::process::progress::Progress;

/// The time between two lines of progress.
const LINES: Duration = Duration::from_secs(10);

/// The time that a measurement under way may take beyond its limit, as a divisor of the limit.
const GRACE: u32 = 10;

/// A measurement under way.
pub struct Work {
    progress: Progress,
    time: Time,
    units: Units,
    kept: Panels,
}

/// The time for a measurement, which its panels share.
pub struct Time {
    start: Instant,
    limit: Duration,
    /// The times at which the current panel began and must end.
    panel: [Instant; 2],
}

impl Time {
    /// Starts the time of a measurement.
    pub fn within(limit: Duration) -> Self {
        // No measurement takes years, and sums of times must not overflow.
        let limit = limit.min(Duration::from_secs(1 << 30));
        let now = Instant::now();
        Self { start: now, limit, panel: [now, now.checked_add(limit).unwrap_or(now)] }
    }

    /// Gives the next panel its share of the remaining time, of this many panels.
    pub fn share(&mut self, panels: usize) {
        let now = Instant::now();
        let left = self.limit.saturating_sub(self.start.elapsed());
        // Some panels take less than their share, so that one may take more.
        let share = if panels > 1 { left.mul_f64(1.5 / (panels as f64 + 0.5)) } else { left };
        self.panel = [now, now.checked_add(share).unwrap_or(now)];
    }

    /// Breaks if the time of the current panel is over.
    pub fn check(&self) -> ControlFlow<()> {
        if Instant::now() >= self.panel[1] { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Tells whether half of the current panel's time is over.
    pub fn is_late(&self) -> bool {
        let [from, to] = self.panel;
        from.elapsed() > (to - from) / 2
    }

    /// Returns the time until a measurement under way is no longer waited for: a little longer than the limit.
    pub fn last(limit: Duration) -> Duration {
        limit.saturating_add(limit / GRACE).saturating_add(Duration::from_millis(500))
    }
}

/// The units of work that are done, and all units.
#[derive(Clone, Default)]
pub struct Units(Arc<[AtomicUsize; 2]>);

/// The panels of a chart so far.
type Panels = Arc<Mutex<Vec<Panel>>>;

impl Work {
    /// Starts work that is to end within a time.
    pub fn within(limit: Duration) -> Self {
        let (progress, units, kept) = (Progress::new(0), Units::default(), Panels::default());
        Self { progress, time: Time::within(limit), units, kept }
    }

    /// Takes the bar away.
    pub fn end(&self) {
        self.progress.end();
    }

    /// Returns how far the work is, for others to look at.
    pub fn units(&self) -> Units {
        self.units.clone()
    }

    /// Returns the panels so far, for others to look at.
    pub fn panels(&self) -> Panels {
        Arc::clone(&self.kept)
    }
}

/// Waits for a measurement on another thread, up to a time after its start.
pub fn wait<T>(measured: &Receiver<T>, units: &Units, last: Duration) -> Result<T, RecvTimeoutError> {
    let start = Instant::now();
    loop {
        let left = last.saturating_sub(start.elapsed());
        match measured.recv_timeout(left.min(LINES)) {
            Err(RecvTimeoutError::Timeout) if left > LINES => units.tell(start.elapsed()),
            measured => return measured,
        }
    }
}

impl Units {
    /// Prints a line, where there is no terminal to show a bar on.
    fn tell(&self, spent: Duration) {
        if io::stderr().is_terminal() {
            return;
        }
        let [done, all] = [&self.0[0], &self.0[1]].map(|units| units.load(Ordering::Relaxed));
        let (spent, percent) = (spent.as_secs(), 100 * done.min(all) / all.max(1));
        messages::note(&format!("about {percent} % is measured after {spent} s"));
    }
}

impl chart::Progress for Work {
    fn more(&mut self, units: usize) {
        self.units.0[1].fetch_add(units, Ordering::Relaxed);
        self.progress.inc_length(units);
    }

    fn done(&mut self, units: usize) -> ControlFlow<()> {
        self.units.0[0].fetch_add(units, Ordering::Relaxed);
        self.progress.advance(units);
        self.time.check()?;
        interrupt::check()
    }

    fn share(&mut self, panels: usize) {
        self.time.share(panels);
    }

    fn is_late(&self) -> bool {
        self.time.is_late()
    }

    fn kept(&mut self, panels: &[Panel]) {
        panels.clone_into(&mut self.kept.lock().unwrap_or_else(PoisonError::into_inner));
        if !panels.is_empty() {
            let said = "the measurement under way takes too long, and there is no chart";
            interrupt::set_action(InterruptAction::SetFlagThenExit(said));
        }
    }
}
