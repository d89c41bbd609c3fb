//! The chart of a scene, measured for a page that waits for it.

use super::frame::Frame;
use serde::Serialize;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use tabray_cli::process::crash;
use tabray_cli::process::failure::report;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_measure::chart::{self, Chart, Panel, Progress};
use tabray_measure::measuring::{Limit, Time};

/// The longest time that a page may give a chart, in seconds.
pub const MAX_SECONDS: u64 = 3600;

/// The time between two checks whether the chart is still wanted.
const LOOK: Duration = Duration::from_millis(50);

/// A measurement under way, as it is seen by the thread that measures.
struct Measurement {
    time: Time,
    frame: Arc<Frame>,
    is_wanted: Arc<AtomicBool>,
    kept: Arc<Mutex<Vec<Panel>>>,
}

impl Progress for Measurement {
    fn more(&mut self, units: usize) {
        self.frame.charting.units[1].fetch_add(units, Ordering::Relaxed);
    }

    fn done(&mut self, units: usize) -> ControlFlow<()> {
        self.frame.charting.units[0].fetch_add(units, Ordering::Relaxed);
        self.time.check()?;
        if self.is_wanted.load(Ordering::Relaxed) {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    }

    fn share(&mut self, panels: usize) {
        self.time.share(panels);
    }

    fn is_late(&self) -> bool {
        self.time.is_late()
    }

    fn kept(&mut self, panels: &[Panel]) {
        panels.clone_into(&mut self.kept.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// Another may measure once the one before has ended.
impl Drop for Measurement {
    fn drop(&mut self) {
        self.frame.charting.is_busy.store(false, Ordering::Relaxed);
    }
}

/// A chart, as a page receives it.
#[derive(Serialize)]
struct ChartMessage {
    /// The chart as an image.
    svg: String,
    /// The verdict.
    words: String,
    /// Whether all of it could be measured in the time.
    is_whole: bool,
}

/// Measures the chart of a scene within a time, and returns it as JSON.
///
/// # Errors
/// The faults of the scene with one of the accuracies; `Interrupted` if `check` breaks.
pub fn measure(
    registry: &'static Registry,
    frame: &Arc<Frame>,
    limit: Duration,
    check: impl Fn() -> ControlFlow<()>,
) -> io::Result<Vec<u8>> {
    let limit = Limit::new(Some(limit), limit);
    let refuse = |reason: &str| io::Error::new(io::ErrorKind::InvalidData, reason);
    if frame.charting.is_busy.swap(true, Ordering::Relaxed) {
        return Err(refuse("the chart of this scene is being measured already"));
    }
    for units in &frame.charting.units {
        units.store(0, Ordering::Relaxed);
    }
    let (is_wanted, kept) = (Arc::new(AtomicBool::new(true)), Arc::<Mutex<Vec<Panel>>>::default());
    let measurement = Measurement {
        time: Time::within(limit),
        frame: frame.clone(),
        is_wanted: is_wanted.clone(),
        kept: kept.clone(),
    };
    let name = Path::new(&frame.name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (sender, measured) = mpsc::channel();
    let title = text::shown(&name);
    thread::Builder::new().spawn(move || {
        let mut measurement = measurement;
        let frame = measurement.frame.clone();
        let load = |accuracy| frame.load(registry, accuracy);
        let chart = crash::catch(|| chart::measure(&title, &load, &mut measurement));
        drop(measurement);
        let _ = sender.send(chart);
    })?;
    let (start, last) = (Instant::now(), limit.last());
    let chart = loop {
        match measured.recv_timeout(LOOK) {
            Ok(Ok(chart)) => break chart?,
            Ok(Err(failure)) => {
                report(&failure);
                return Err(refuse("internal error: see the terminal"));
            }
            // The thread that measures ends as soon as it looks.
            Err(RecvTimeoutError::Timeout) if check().is_break() => {
                is_wanted.store(false, Ordering::Relaxed);
                return Err(io::ErrorKind::Interrupted.into());
            }
            Err(RecvTimeoutError::Timeout) if start.elapsed() < last => {}
            Err(_) => {
                is_wanted.store(false, Ordering::Relaxed);
                let panels = kept.lock().unwrap_or_else(PoisonError::into_inner).clone();
                break Chart { panels, ..Chart::empty(&name) };
            }
        }
    };
    if chart.panels.is_empty() {
        return Err(refuse("the time limit has been reached, and nothing is measured yet"));
    }
    let (svg, words) = (chart::svg(&chart)?, chart::words(&chart));
    Ok(text::json(&ChartMessage { svg, words, is_whole: chart.is_whole }).into_bytes())
}
