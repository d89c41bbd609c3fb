//! The progress of a measurement: a bar on a terminal, and lines elsewhere. An interruption ends it, and so does a time
//! limit.

use crate::chart::{self, Panel};
use std::io::{self, IsTerminal};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::process::messages;
use tabray_cli::process::progress::Progress;
use tabray_tools::clock;

/// The time between two lines of progress.
const LINES: Duration = Duration::from_secs(10);

/// The time that a measurement under way may take beyond its limit, as a divisor of the limit.
const GRACE: u32 = 10;

/// How much longer than on an idle machine a measurement may take on a busy one, where the user gives no limit.
const BUSY: u32 = 10;

/// A measurement under way.
pub struct Work {
    progress: Progress,
    time: Time,
    units: Units,
    kept: Panels,
}

/// The time that a measurement may take.
#[derive(Clone, Copy)]
pub struct Limit {
    /// The time.
    pub time: Duration,
    /// Whether the time counts that the machine spends on other work.
    is_of_wall: bool,
}

impl Limit {
    /// Limits a measurement to a time that the user has given, or to this CPU time on each core.
    pub fn new(given: Option<Duration>, usual: Duration) -> Self {
        // No measurement takes years, and sums of times must not overflow.
        let time = given.unwrap_or(usual).min(Duration::from_secs(1 << 30));
        Self { time, is_of_wall: given.is_some() }
    }

    /// Returns the time until a measurement under way is no longer waited for: a little longer than the limit.
    pub fn last(self) -> Duration {
        let time = if self.is_of_wall { self.time } else { self.time * BUSY };
        time.saturating_add(time / GRACE).saturating_add(Duration::from_millis(500))
    }
}

/// The time for a measurement, which its panels share.
pub struct Time {
    start: Instant,
    limit: Limit,
    /// The times from the start at which the current panel began and must end.
    panel: [Duration; 2],
}

impl Time {
    /// Starts the time of a measurement.
    pub fn within(limit: Limit) -> Self {
        Self { start: Instant::now(), limit, panel: [Duration::ZERO, limit.time] }
    }

    /// Returns the time since the start that counts.
    fn spent(&self) -> Duration {
        if self.limit.is_of_wall {
            return self.start.elapsed();
        }
        let cores = thread::available_parallelism().map_or(1, usize::from);
        clock::of_process() / cores as u32
    }

    /// Gives the next panel its share of the remaining time, of this many panels.
    pub fn share(&mut self, panels: usize) {
        let now = self.spent();
        let left = self.limit.time.saturating_sub(now);
        // Some panels take less than their share, so that one may take more.
        let share = if panels > 1 { left.mul_f64(1.5 / (panels as f64 + 0.5)) } else { left };
        self.panel = [now, now + share];
    }

    /// Breaks if the time of the current panel is over.
    pub fn check(&self) -> ControlFlow<()> {
        if self.spent() >= self.panel[1] { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Tells whether half of the current panel's time is over.
    pub fn is_late(&self) -> bool {
        let [from, to] = self.panel;
        2 * self.spent().saturating_sub(from) > to - from
    }
}

/// The units of work that are done, and all units.
#[derive(Clone, Default)]
pub struct Units(Arc<[AtomicUsize; 2]>);

/// The panels of a chart so far.
type Panels = Arc<Mutex<Vec<Panel>>>;

impl Work {
    /// Starts work that is to end within a time.
    pub fn within(limit: Limit) -> Self {
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
