//! Long work without the interpreter's lock. It runs on threads of its own until it is finished or Ctrl-C is pressed.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;
use tabray_core::render::Renderer;
use tabray_tools::threads;

/// The time between two checks for signals and reports of progress.
const POLL: Duration = Duration::from_millis(50);

/// The maximum number of threads, as on the command line.
const MAX_THREADS: usize = 1024;

/// Settings of long work.
pub struct How<'py> {
    /// The number of threads; `None` for one on each core.
    pub threads: Option<usize>,
    /// The progress callback, called with the finished and the whole amount of work.
    pub progress: Option<Bound<'py, PyAny>>,
}

/// The state that the caller and the working threads share.
#[derive(Default)]
pub struct Progress {
    stops: AtomicBool,
    done: AtomicUsize,
}

impl Progress {
    /// Tells whether the work must stop, as its results are not wanted.
    pub fn stops(&self) -> bool {
        self.stops.load(Ordering::Relaxed)
    }

    /// Adds to the amount of finished work.
    pub fn step(&self, count: usize) {
        self.done.fetch_add(count, Ordering::Relaxed);
    }
}

impl How<'_> {
    /// Settings of work that takes little time, or reports no progress.
    pub const PLAIN: Self = Self { threads: None, progress: None };

    /// Does the work, of the amount `all`, and returns its result. The interpreter runs other threads meanwhile. A
    /// signal stops the work and is raised, so `work` must often ask its [`Progress`] whether to stop.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        all: usize,
        work: impl FnOnce(&Renderer, &Progress) -> T + Send,
    ) -> PyResult<T> {
        if self.threads.is_some_and(|threads| !(1..=MAX_THREADS).contains(&threads)) {
            return Err(PyValueError::new_err(format!("`threads` must be from 1 to {MAX_THREADS}")));
        }
        let renderer = threads::renderer_with(self.threads.unwrap_or(0));
        // This call starts its own threads: a forked process has none of its parent's.
        let renderer = renderer.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let (shared, (send, receive)) = (Progress::default(), mpsc::channel());
        let progress = self.progress.as_ref().map(|progress| progress.clone().unbind());
        let (renderer, shared) = (&renderer, &shared);
        let watch = move || {
            thread::scope(|scope| {
                scope.spawn(move || send.send(renderer.run(|| work(renderer, shared))));
                let mut raised = Ok(());
                loop {
                    match receive.recv_timeout(POLL) {
                        Ok(result) => return raised.map(|()| Some(result)),
                        // The work panicked. The scope passes the panic on.
                        Err(RecvTimeoutError::Disconnected) => return Ok(None),
                        Err(RecvTimeoutError::Timeout) => {}
                    }
                    if raised.is_ok() {
                        raised = Python::attach(|py| {
                            py.check_signals()?;
                            let done = shared.done.load(Ordering::Relaxed);
                            progress.as_ref().map_or(Ok(()), |tell| tell.call1(py, (done, all)).map(drop))
                        });
                        shared.stops.store(raised.is_err(), Ordering::Relaxed);
                    }
                }
            })
        };
        let result = py.detach(watch)?;
        if let Some(tell) = &self.progress {
            tell.call1((all, all))?;
        }
        result.ok_or_else(|| PyRuntimeError::new_err("the work ended early"))
    }
}
