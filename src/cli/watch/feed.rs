//! The state that pages show, from the last valid scene on, and the pages that wait for changes.

use super::events;
use super::frame::Frame;
use hyper::body::Bytes;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use tokio::sync::watch::{self, Receiver, Sender};

/// The events that every page receives, however late it connects.
pub struct EventFeed {
    state: Sender<State>,
}

#[derive(Default)]
struct State {
    /// The last valid scene.
    frame: Option<Arc<Frame>>,
    /// The events about this scene so far.
    events: Vec<Bytes>,
    /// The error in the text since then.
    fault: Option<Bytes>,
    /// The number of errors so far, which tells one error from the next.
    faults: u64,
    /// All scenes, where there may be several.
    list: Option<Bytes>,
    /// The number of lists so far.
    lists: u64,
}

impl State {
    fn version(&self) -> u64 {
        self.frame.as_ref().map_or(0, |frame| frame.version)
    }
}

impl EventFeed {
    /// Makes a feed without events.
    pub fn new() -> Self {
        Self { state: watch::channel(State::default()).0 }
    }

    /// Replaces the last valid scene; the image of the scene before is no longer needed.
    pub fn show(&self, frame: &Arc<Frame>) {
        self.state.send_modify(|state| {
            if let Some(last) = state.frame.replace(frame.clone()) {
                last.stale.store(true, Ordering::Relaxed);
            }
            state.events = vec![events::scene(frame)];
            state.fault = None;
        });
    }

    /// Adds an event about a scene, unless the scene has been replaced.
    pub fn add(&self, frame: &Frame, event: Bytes) {
        self.state.send_if_modified(|state| {
            let is_present = state.version() == frame.version;
            if is_present {
                state.events.push(event);
            }
            is_present
        });
    }

    /// Sets the error in the current text. The last valid scene stays.
    pub fn fault(&self, event: Bytes) {
        self.state.send_modify(|state| {
            state.fault = Some(event);
            state.faults += 1;
        });
    }

    /// Sets the list of all scenes.
    pub fn list(&self, event: Bytes) {
        self.state.send_modify(|state| {
            state.list = Some(event);
            state.lists += 1;
        });
    }

    /// Forgets the scene, whose image nobody needs any more.
    pub fn clear(&self) {
        self.state.send_modify(|state| {
            if let Some(last) = state.frame.take() {
                last.stale.store(true, Ordering::Relaxed);
            }
            state.events.clear();
            state.fault = None;
        });
    }

    /// Returns the last valid scene, if it has this version.
    pub fn frame(&self, version: u64) -> Option<Arc<Frame>> {
        self.state.borrow().frame.clone().filter(|frame| frame.version == version)
    }

    /// Returns the last valid scene, if there is one.
    pub fn last(&self) -> Option<Arc<Frame>> {
        self.state.borrow().frame.clone()
    }

    /// Returns the text of the last valid scene.
    pub fn text(&self) -> Option<String> {
        self.state.borrow().frame.as_ref().map(|frame| frame.text.clone())
    }

    /// Makes a subscriber that has received no event yet.
    pub fn subscribe(&self) -> Subscriber {
        Subscriber { state: self.state.subscribe(), version: 0, events: 0, faults: 0, lists: 0 }
    }
}

/// A page that receives one event after another.
pub struct Subscriber {
    state: Receiver<State>,
    /// The version of the scene that the subscriber knows, and the number of its events that were received.
    version: u64,
    events: usize,
    /// The number of errors when the last one was received.
    faults: u64,
    /// The number of lists when the last one was received.
    lists: u64,
}

impl Subscriber {
    /// Returns the next event when there is one, or `None` when there will be no more.
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
        if self.lists != state.lists {
            self.lists = state.lists;
            return state.list.clone();
        }
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
