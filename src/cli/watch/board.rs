//! What pages are to know, from the last sound scene on, and those who wait for more of it.

use super::events;
use super::frame::Frame;
use hyper::body::Bytes;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use tokio::sync::watch::{self, Receiver, Sender};

/// What every page is told, however late it comes.
pub struct Board {
    state: Sender<State>,
}

#[derive(Default)]
struct State {
    /// The last sound scene.
    frame: Option<Arc<Frame>>,
    /// What there is to tell of it so far.
    events: Vec<Bytes>,
    /// What is wrong with the text since.
    fault: Option<Bytes>,
    /// How many faults there were, to tell one from the next.
    faults: u64,
}

impl State {
    fn version(&self) -> u64 {
        self.frame.as_ref().map_or(0, |frame| frame.version)
    }
}

impl Board {
    /// An empty one.
    pub fn new() -> Self {
        Self { state: watch::channel(State::default()).0 }
    }

    /// Puts a sound scene in the place of the one before, whose picture nobody wants any more.
    pub fn show(&self, frame: &Arc<Frame>) {
        self.state.send_modify(|state| {
            if let Some(last) = state.frame.replace(frame.clone()) {
                last.stale.store(true, Ordering::Relaxed);
            }
            state.events = vec![events::scene(frame)];
            state.fault = None;
        });
    }

    /// Adds what there is to tell of a scene, unless that is the present one no more.
    pub fn add(&self, frame: &Frame, event: Bytes) {
        self.state.send_if_modified(|state| {
            let is_present = state.version() == frame.version;
            if is_present {
                state.events.push(event);
            }
            is_present
        });
    }

    /// Tells what is wrong with the text now. The last sound scene stays.
    pub fn fault(&self, event: Bytes) {
        self.state.send_modify(|state| {
            state.fault = Some(event);
            state.faults += 1;
        });
    }

    /// The last sound scene, if it has this version.
    pub fn frame(&self, version: u64) -> Option<Arc<Frame>> {
        self.state.borrow().frame.clone().filter(|frame| frame.version == version)
    }

    /// Someone who has been told nothing yet.
    pub fn reader(&self) -> Reader {
        Reader { state: self.state.subscribe(), version: 0, events: 0, faults: 0 }
    }
}

/// A page that is told one event after another.
pub struct Reader {
    state: Receiver<State>,
    /// The scene that it knows, and how many events of that.
    version: u64,
    events: usize,
    /// How many faults there were when it was told of the last one.
    faults: u64,
}

impl Reader {
    /// The next event, once there is one; nothing when there will be no more.
    pub async fn next(&mut self) -> Option<Bytes> {
        loop {
            if let Some(event) = self.known() {
                return Some(event);
            }
            self.state.changed().await.ok()?;
        }
    }

    fn known(&mut self) -> Option<Bytes> {
        let state = self.state.borrow_and_update();
        if self.version != state.version() {
            (self.version, self.events) = (state.version(), 0);
        }
        if let Some(event) = state.events.get(self.events) {
            self.events += 1;
            return Some(event.clone());
        }
        if self.faults == state.faults {
            return None;
        }
        self.faults = state.faults;
        state.fault.clone()
    }
}
