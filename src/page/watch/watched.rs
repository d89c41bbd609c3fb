//! A scene that is read again whenever it changes, while pages look at it.

use super::events::{self, Fault};
use super::feed::{EventFeed, News};
use super::files::{Files, Stamp, stamp};
use super::frame::{ChartState, Frame};
use super::session::Session;
use crate::lines;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{self, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use tabray_cli::files::input;
use tabray_cli::process::crash;
use tabray_cli::process::failure::{Failure, report};
use tabray_core::render::Levels;
use tabray_core::render::plan::Plan;
use tabray_core::render::progressive::{self, Area};
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::reader::{self, Loaded, ReadOptions};
use tabray_tools::diagnosis;
use tabray_tools::threads::renderer_with;

/// The maximum number of pixels of an image on a page: all of it is in memory, here and in the browser.
const MAX_PIXELS: usize = 1 << 24;

/// How often an image that waits for a page looks for one.
const LOOK: Duration = Duration::from_millis(50);

/// Starts the thread that renders the images of a scene, one after another.
fn painter(session: Arc<Session>) -> Result<Sender<Arc<Frame>>, Failure> {
    let renderer = renderer_with(0)?;
    let (sender, frames) = mpsc::channel::<Arc<Frame>>();
    thread::spawn(move || {
        let feed = &session.feed;
        for frame in frames {
            let start = Instant::now();
            let (model, levels) = (&frame.model, Mutex::new(Levels::default()));
            let display = model.camera.value.display();
            let part = |area: Area, colours: Vec<_>| {
                if area.is_final {
                    let bytes: Vec<u8> = colours.iter().flat_map(|colour| display.bytes(*colour)).collect();
                    levels.lock().unwrap_or_else(PoisonError::into_inner).add(&bytes);
                }
                feed.add(&frame, events::part(&frame, &area, &colours));
            };
            // While no page is open, the image waits.
            let waited = Mutex::new(Duration::ZERO);
            let goes_on = || {
                if !session.has_viewers() {
                    // The other threads wait for the first one.
                    let mut waited = waited.lock().unwrap_or_else(PoisonError::into_inner);
                    let away = Instant::now();
                    while !session.has_viewers() {
                        frame.check()?;
                        thread::sleep(LOOK);
                    }
                    *waited += away.elapsed();
                }
                frame.check()
            };
            let painted = crash::catch(|| {
                let mut plan = Plan::for_picture(model);
                if progressive::render(&renderer, &mut plan, part, goes_on).is_break() {
                    return;
                }
                feed.add(
                    &frame,
                    events::done(
                        &frame,
                        start
                            .elapsed()
                            .saturating_sub(*waited.lock().unwrap_or_else(PoisonError::into_inner)),
                    ),
                );
                let levels = *levels.lock().unwrap_or_else(PoisonError::into_inner);
                let [width, height] = plan.camera.pixels;
                let remark = diagnosis::remark(&plan, [&(0..width), &(0..height)], &levels);
                if let Some(remark) = remark.filter(|_| !reader::is_black(model)) {
                    feed.add(&frame, events::remark(&frame, &remark));
                }
            });
            if let Err(failure) = painted {
                crashed(feed, &frame.name, &frame.text, &failure);
            }
        }
    });
    Ok(sender)
}

/// The text and files that an image was made from.
#[derive(PartialEq)]
struct SourceFiles {
    /// The scene.
    bytes: Vec<u8>,
    /// The values that are set beside it.
    sets: Vec<String>,
    /// The files that it names, and their stamps before they were read.
    stamps: BTreeMap<PathBuf, Option<Stamp>>,
}

/// The file of a scene, which is read again and again.
pub struct Watched {
    session: Arc<Session>,
    /// The number of the scene.
    number: usize,
    accuracy: Option<Accuracy>,
    /// The files that the scene named when it was read last.
    named: Vec<PathBuf>,
    /// The text and files that were read last.
    last: Option<SourceFiles>,
    /// The number of times that the scene was valid.
    version: u64,
    /// Takes the next part to render; `None` while nobody looks at the scene.
    painter: Option<Sender<Arc<Frame>>>,
}

impl Watched {
    /// Makes a scene that has not been read yet.
    pub fn new(session: Arc<Session>, number: usize, accuracy: Option<Accuracy>) -> Self {
        Self { session, number, accuracy, named: Vec::new(), last: None, version: 0, painter: None }
    }

    /// Shows the current scene if it is wanted; otherwise forgets it, and ends its render.
    pub fn follow(&mut self, is_wanted: bool, files: &mut Files) -> Result<(), Failure> {
        if !is_wanted {
            if self.painter.take().is_some() {
                (self.named, self.last) = (Vec::new(), None);
                self.session.feed.clear();
                files.watch(self.number, [&self.session.path]);
            }
            return Ok(());
        }
        let frames = match &self.painter {
            Some(frames) => frames.clone(),
            None => {
                files.watch(self.number, [&self.session.path]);
                self.painter.insert(painter(self.session.clone())?).clone()
            }
        };
        self.read(&frames, files)
    }

    /// Reads the current scene, shows it or its faults, and watches all files that it names.
    fn read(&mut self, frames: &Sender<Arc<Frame>>, files: &mut Files) -> Result<(), Failure> {
        let session = self.session.clone();
        let feed = &session.feed;
        let (name, bytes) = match input::read(&session.path) {
            Ok(read) => read,
            Err(Failure::Usage(message, _) | Failure::Unread(message, _)) => {
                let name = text::shown(&session.path);
                let report = &format!("error: {message}");
                feed.tell(
                    News::Fault,
                    Some(events::fault(&Fault { lines: &[], name: &name, report, text: None })),
                );
                self.last = None;
                return Ok(());
            }
            Err(failure) => return Err(failure),
        };
        session.tell_differences(&name, &bytes);
        // One save may cause several events. The stamps of the files are taken before the files are read, so that a
        // change in the meantime is noticed.
        let sets = [&session.sets[..], &session.trial_values.sets()].concat();
        let stamps = self.named.iter().map(|file| (file.clone(), stamp(file))).collect();
        let now = SourceFiles { bytes, sets, stamps };
        if self.last.as_ref() == Some(&now) {
            return Ok(());
        }
        let SourceFiles { bytes, sets, stamps } = self.last.insert(now);
        let text = String::from_utf8_lossy(bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let folder = session.path.parent().unwrap_or(&session.path);
        let chosen = ReadOptions { above_all: self.accuracy, sets, ..ReadOptions::default() };
        let read = match crash::catch(|| reader::read_by(session.registry, &name, folder, bytes, chosen)) {
            Ok(read) => read,
            Err(failure) => {
                crashed(feed, &name, text, &failure);
                return Ok(());
            }
        };
        let report = read.as_ref().map_or_else(|report| report, |loaded| &loaded.warnings);
        self.named = report.files().to_vec();
        files.watch(self.number, self.named.iter().chain([&session.path]));
        stamps.retain(|file, _| self.named.contains(file));
        for file in &self.named {
            stamps.entry(file.clone()).or_insert_with(|| stamp(file));
        }
        match read {
            Ok(Loaded { model, .. }) if !fits(&model) => {
                let [width, height] = model.camera.value.pixels;
                let report = &format!(
                    "error: an image of {width} x {height} pixels is too large for a page\n\
                     help: the maximum is {MAX_PIXELS} pixels, such as 4096 x 4096"
                );
                feed.tell(
                    News::Fault,
                    Some(events::fault(&Fault { lines: &[], name: &name, report, text: Some(text) })),
                );
            }
            Ok(Loaded { model, warnings, places, .. }) => {
                self.version += 1;
                let frame = Arc::new(Frame {
                    version: self.version,
                    name,
                    text: text.to_owned(),
                    warnings: warnings.to_string(),
                    model,
                    places,
                    folder: folder.to_owned(),
                    sets: sets.clone(),
                    accuracy: self.accuracy,
                    charting: ChartState::default(),
                    stale: AtomicBool::new(false),
                });
                feed.show(&frame);
                // Sending fails only when the program ends, and the thread that renders with it.
                let _ = frames.send(frame);
            }
            Err(report) => {
                let places = report.faults().iter().filter_map(|fault| fault.place.as_ref());
                let lines = places.filter_map(|place| lines(text, place)).map(|[first, _]| first);
                let lines = &lines.collect::<Vec<_>>();
                let report = &report.to_string();
                feed.tell(
                    News::Fault,
                    Some(events::fault(&Fault { lines, name: &name, report, text: Some(text) })),
                );
            }
        }
        Ok(())
    }
}

/// Reports that the program failed on a scene. It continues with the next one.
fn crashed(feed: &EventFeed, name: &str, text: &str, failure: &Failure) {
    report(failure);
    let Failure::Failed(message) = failure else { return };
    let report = &format!("error: {message}");
    feed.tell(News::Fault, Some(events::fault(&Fault { lines: &[], name, report, text: Some(text) })));
}

fn fits(model: &Model) -> bool {
    let [width, height] = model.camera.value.pixels;
    width * height <= MAX_PIXELS
}
