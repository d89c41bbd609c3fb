//! The state that pages show, from the last valid scene on, and the pages that wait for changes.

use super::events;
use super::frame::Frame;
use hyper::body::Bytes;
use std::mem;
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
    /// The last event of each kind of news, and the number of these so far, which tells one from the next.
    news: [(Option<Bytes>, u64); News::ALL.len()],
}

/// News that replaces older news of its kind.
#[derive(Clone, Copy, PartialEq)]
pub enum News {
    /// All scenes, where there may be several.
    Scenes,
    /// Whether the system tells of changes.
    Watching,
    /// The values that differ from the scene's file.
    Tried,
    /// The error in the text since the last valid scene.
    Fault,
}

impl News {
    /// All kinds, in the order in which a page receives them; what is about the scene is between the last two.
    const ALL: [Self; 4] = [Self::Scenes, Self::Watching, Self::Tried, Self::Fault];
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
            state.news[News::Fault as usize].0 = None;
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

    /// Replaces the news of a kind, unless it is the same.
    pub fn tell(&self, kind: News, event: Option<Bytes>) {
        self.state.send_if_modified(|state| {
            let (last, count) = &mut state.news[kind as usize];
            let is_new = *last != event;
            if is_new {
                (*last, *count) = (event, *count + 1);
            }
            is_new
        });
    }

    /// Tells whether there has been news of a kind.
    pub fn has(&self, kind: News) -> bool {
        self.state.borrow().news[kind as usize].0.is_some()
    }

    /// Forgets the scene. Its image is no longer needed.
    pub fn clear(&self) {
        self.state.send_modify(|state| {
            if let Some(last) = state.frame.take() {
                last.stale.store(true, Ordering::Relaxed);
            }
            state.events.clear();
            state.news[News::Fault as usize].0 = None;
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
        Subscriber { state: self.state.subscribe(), version: 0, events: 0, news: [0; News::ALL.len()] }
    }
}

/// A page that receives one event after another.
pub struct Subscriber {
    state: Receiver<State>,
    /// The version of the scene that the subscriber knows, and the number of its events that were received.
    version: u64,
    events: usize,
    /// The number of news of each kind when the last one was received.
    news: [u64; News::ALL.len()],
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
        let mut unseen = |kind: News| {
            let (event, count) = &state.news[kind as usize];
            let seen = mem::replace(&mut self.news[kind as usize], *count);
            event.clone().filter(|_| seen != *count)
        };
        if let Some(news) = News::ALL.into_iter().filter(|kind| *kind != News::Fault).find_map(&mut unseen) {
            return Some(news);
        }
        if self.version != state.version() {
            (self.version, self.events) = (state.version(), 0);
        }
        if let Some(event) = state.events.get(self.events) {
            self.events += 1;
            return Some(event.clone());
        }
        unseen(News::Fault)
    }
}
