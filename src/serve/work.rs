//! Computes the results of requests: not on the thread that answers them, and only a few at a time.

use std::ops::ControlFlow;
use std::sync::{Arc, Weak};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::spawn_blocking;

/// Limits the number of jobs that run at the same time.
pub struct Work {
    turns: Arc<Semaphore>,
}

/// The client that waits for a result.
pub struct Client(Weak<()>);

impl Client {
    /// Breaks if no client waits for the result any more.
    pub fn check(&self) -> ControlFlow<()> {
        if self.0.strong_count() == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Work {
    /// Allows this many jobs at the same time.
    pub fn new(max_jobs: usize) -> Self {
        Self { turns: Arc::new(Semaphore::new(max_jobs)) }
    }

    /// Waits for a permit, which is held until the value is dropped.
    pub async fn turn(&self) -> OwnedSemaphorePermit {
        self.turns.clone().acquire_owned().await.expect("nobody closes it")
    }

    /// Runs a job on another thread, once there is a permit. Returns `None` if the job panicked. If this future is
    /// dropped, a waiting job is not started, and a running one can learn of it.
    pub async fn run<T: Send + 'static>(&self, job: impl FnOnce(&Client) -> T + Send + 'static) -> Option<T> {
        let turn = self.turn().await;
        let waiting = Arc::new(());
        let client = Client(Arc::downgrade(&waiting));
        let done = spawn_blocking(move || {
            let _turn = turn;
            job(&client)
        });
        let result = done.await.ok();
        drop(waiting);
        result
    }
}
