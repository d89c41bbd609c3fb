//! Long work, done without the interpreter's lock, on threads of its own, until it is finished or Ctrl-C is pressed.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;
use tabray_core::render::Renderer;
use tabray_tools::threads;

/// How often signals are checked, and progress is told.
const POLL: Duration = Duration::from_millis(50);

/// How work is done.
pub struct How<'py> {
    /// The number of threads; `None` for one on each core.
    pub threads: Option<usize>,
    /// The progress callback: it is passed how much is done, and how much there is.
    pub progress: Option<Bound<'py, PyAny>>,
}

/// What the caller and the working threads tell each other.
#[derive(Default)]
pub struct Course {
    stops: AtomicBool,
    done: AtomicUsize,
}

impl Course {
    /// Tells whether the work is to end, as its results are not wanted.
    pub fn stops(&self) -> bool {
        self.stops.load(Ordering::Relaxed)
    }

    /// Counts what is done.
    pub fn step(&self, count: usize) {
        self.done.fetch_add(count, Ordering::Relaxed);
    }
}

impl How<'_> {
    /// Work that takes little time, or reports no progress.
    pub const PLAIN: Self = Self { threads: None, progress: None };

    /// Does the work, of which there is `all`, and returns its result. The interpreter runs other threads meanwhile. A signal
    /// ends the work, and is raised: `work` asks its [`Course`] often whether it stops.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        all: usize,
        work: impl FnOnce(&Renderer, &Course) -> T + Send,
    ) -> PyResult<T> {
        if self.threads == Some(0) {
            return Err(pyo3::exceptions::PyValueError::new_err("`threads` must be at least 1"));
        }
        let renderer = threads::renderer_with(self.threads.unwrap_or(0));
        // Threads of this call alone: those of the parent are not in a process that was forked.
        let renderer = renderer.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let (course, (send, receive)) = (Course::default(), mpsc::channel());
        let progress = self.progress.as_ref().map(|progress| progress.clone().unbind());
        let (renderer, course) = (&renderer, &course);
        let watch = move || {
            thread::scope(|scope| {
                scope.spawn(move || send.send(renderer.run(|| work(renderer, course))));
                let mut raised = Ok(());
                loop {
                    match receive.recv_timeout(POLL) {
                        Ok(result) => return raised.map(|()| Some(result)),
                        // It panicked, which the scope passes on.
                        Err(RecvTimeoutError::Disconnected) => return Ok(None),
                        Err(RecvTimeoutError::Timeout) => {}
                    }
                    if raised.is_ok() {
                        raised = Python::attach(|py| {
                            py.check_signals()?;
                            let done = course.done.load(Ordering::Relaxed);
                            progress.as_ref().map_or(Ok(()), |tell| tell.call1(py, (done, all)).map(drop))
                        });
                        course.stops.store(raised.is_err(), Ordering::Relaxed);
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
