//! What is computed for requests: off the thread that answers them, and only so much at once.

use std::ops::ControlFlow;
use std::sync::{Arc, Weak};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::spawn_blocking;

/// Takes turns at computing.
pub struct Work {
    turns: Arc<Semaphore>,
}

/// Who waits for a result.
pub struct Client(Weak<()>);

impl Client {
    /// Breaks where nobody waits for the result any more.
    pub fn check(&self) -> ControlFlow<()> {
        if self.0.strong_count() == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Work {
    /// Lets so many jobs run at once.
    pub fn new(most: usize) -> Self {
        Self { turns: Arc::new(Semaphore::new(most)) }
    }

    /// Waits for a turn, which lasts until the value is dropped.
    pub async fn turn(&self) -> OwnedSemaphorePermit {
        self.turns.clone().acquire_owned().await.expect("nobody closes it")
    }

    /// Does a job on another thread once it has its turn. There is no result where it panicked. If this future is
    /// dropped, a job that waits is not begun, and one under way can learn of it.
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
