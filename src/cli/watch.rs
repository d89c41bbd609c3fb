//! `tabray watch`: a page that shows the image while its scene is edited.

pub(super) mod answer;
pub(super) mod board;
mod browser;
mod camera;
pub(super) mod desk;
mod events;
mod fields;
mod files;
pub(super) mod frame;
pub(super) mod tries;

use super::serve::{Server, Work};
use crate::cli::files::input;
use crate::cli::options::{method, set};
use crate::cli::process::failure::{Failure, tell};
use crate::cli::process::{crash, interrupt, messages};
use crate::render::plan::Plan;
use crate::render::progressive;
use crate::render::renderer::Renderer;
use crate::scene::model::Model;
use crate::scene::reader::{self, Chosen, Loaded};
use crate::scene::registry::Registry;
use crate::text;
use crate::world::accuracy::Accuracy;
use board::Board;
use desk::Desk;
use events::Fault;
use files::Files;
use frame::{Frame, lines};
use hyper::Request;
use hyper::body::Bytes;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::{Duration, Instant, SystemTime};
use tries::Tries;

/// The maximum number of pixels of an image on a page: all of it is in memory, here and in the browser.
const MAX_PIXELS: usize = 1 << 24;

/// How long a file must have been left alone before it is read: many editors write a file in several steps.
const SETTLED: Duration = Duration::from_millis(10);

/// Show the image in the browser, and render it again whenever the scene changes
///
/// Only this machine can reach the page, and only at the address that is printed: it contains a token, new for each run,
/// that keeps other users out. Click a pixel to see how it gets its colour. Ctrl-C quits, with status 0.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scene
    scene: PathBuf,
    #[command(flatten)]
    set: set::Args,
    /// The port of the page on 127.0.0.1; by default the first free one from 3000; 0 is any free one
    #[arg(long, value_name = "N")]
    port: Option<u16>,
    /// Open the page in the browser
    #[arg(long)]
    open: bool,
    #[command(flatten)]
    method: method::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray watch ball.ray --open
  tabray watch ball.ray --port 3000";

/// The events that the command waits for.
enum News {
    Changed,
    Interrupted,
    ServerFailed(String),
}

pub fn run(registry: &'static Registry, args: Args) -> Result<(), Failure> {
    if input::is_standard(&args.scene) {
        return Err(Failure::Usage(
            "standard input cannot be watched".to_owned(),
            Some("name the scene's file".to_owned()),
        ));
    }
    let accuracy = args.method.accuracy()?;
    let (sender, news) = mpsc::channel();
    let mut files = Files::new(teller(&sender, || News::Changed))?;
    files.watch([&args.scene])?;
    // A scene with faults has a page; a path that cannot be read has none.
    input::read(&args.scene)?;
    let server = Server::open(args.port)?;
    let url = server.url();
    interrupt::catch_and(teller(&sender, || News::Interrupted))?;

    let desk = Arc::new(Desk {
        board: Board::new(),
        tries: Tries::default(),
        registry,
        path: args.scene.clone(),
        changed: Box::new(teller(&sender, || News::Changed)),
    });
    let frames = painter(desk.clone())?;
    thread::spawn({
        let desk = desk.clone();
        move || {
            let work = Work::new(answer::JOBS);
            let run = server.run(async move |request: Request<Bytes>| {
                ControlFlow::Continue(answer::answer(&request, &desk, &work).await)
            });
            if let Err(error) = run {
                let reason = text::reason(&error);
                let _ = sender.send(News::ServerFailed(format!("the server stopped: {reason}")));
            }
        }
    });
    messages::note(&format!("watching {} at {url} (Ctrl-C quits)", args.scene.display()));
    // Keeps the file that leads the browser to the page.
    let opened = args.open.then(|| browser::open(&url));
    if let Some(Err(error)) = &opened {
        let reason = text::reason(error);
        messages::note(&format!("cannot open a browser: {reason}; open the address yourself"));
    }
    let mut watched = Watched {
        registry,
        path: args.scene,
        sets: args.set.values,
        accuracy,
        named: Vec::new(),
        last: None,
        version: 0,
    };
    loop {
        watched.read(&desk, &frames, &mut files)?;
        match next(&news) {
            News::Changed => {}
            News::Interrupted => return Ok(()),
            News::ServerFailed(message) => return Err(Failure::Failed(message)),
        }
    }
}

/// Returns a function that sends news, from any thread.
fn teller(sender: &Sender<News>, news: impl Fn() -> News + Send + 'static) -> impl Fn() + Send + 'static {
    let sender = sender.clone();
    move || {
        // If no one receives the news, the program is about to end.
        let _ = sender.send(news());
    }
}

/// Waits for news. Changes that follow one another count as one.
fn next(news: &Receiver<News>) -> News {
    let mut last = news.recv().unwrap_or(News::Interrupted);
    while let News::Changed = last {
        match news.recv_timeout(SETTLED) {
            Ok(more) => last = more,
            Err(_) => break,
        }
    }
    last
}

/// Starts the thread that renders images, one scene after another.
fn painter(desk: Arc<Desk>) -> Result<Sender<Arc<Frame>>, Failure> {
    let renderer = Renderer::new(0)?;
    let (sender, frames) = mpsc::channel::<Arc<Frame>>();
    thread::spawn(move || {
        let board = &desk.board;
        for frame in frames {
            let start = Instant::now();
            let part = |area, colours: Vec<_>| board.add(&frame, events::part(&frame, &area, &colours));
            let painted = crash::catch(|| {
                progressive::render(&renderer, &mut Plan::for_picture(&frame.model), part, || frame.check())
            });
            match painted {
                Ok(ControlFlow::Continue(())) => board.add(&frame, events::done(&frame, start.elapsed())),
                Ok(ControlFlow::Break(())) => {}
                Err(failure) => crashed(board, &frame.name, &frame.text, &failure),
            }
        }
    });
    Ok(sender)
}

/// The modification time of a file, and its length in bytes.
type Stamp = (SystemTime, u64);

fn stamp(file: &Path) -> Option<Stamp> {
    let meta = fs::metadata(file).ok()?;
    Some((meta.modified().ok()?, meta.len()))
}

/// What an image was made from.
#[derive(PartialEq)]
struct Read {
    /// The scene.
    bytes: Vec<u8>,
    /// The values that are set beside it.
    sets: Vec<String>,
    /// The stamps of the files that it names.
    stamps: Vec<Option<Stamp>>,
}

/// The file of a scene, which is read again and again.
struct Watched<'r> {
    registry: &'r Registry,
    path: PathBuf,
    /// The values that are set beside its text.
    sets: Vec<String>,
    accuracy: Option<Accuracy>,
    /// The files that the scene names.
    named: Vec<PathBuf>,
    /// What was read last.
    last: Option<Read>,
    /// The number of times that the scene was valid.
    version: u64,
}

impl Watched<'_> {
    /// Reads the current scene, shows it or its faults, and watches all files that it names.
    fn read(&mut self, desk: &Desk, frames: &Sender<Arc<Frame>>, files: &mut Files) -> Result<(), Failure> {
        let board = &desk.board;
        let (name, bytes) = match input::read(&self.path) {
            Ok(read) => read,
            Err(Failure::Usage(message, _) | Failure::Unread(message, _)) => {
                let name = self.path.display().to_string();
                let report = &format!("error: {message}");
                board.fault(events::fault(&Fault { lines: &[], name: &name, report, text: None }));
                self.last = None;
                return Ok(());
            }
            Err(failure) => return Err(failure),
        };
        // One save may cause several events. The stamps of the files are taken before the files are read, so that a
        // change in the meantime is noticed.
        let sets = [&self.sets[..], &desk.tries.sets()].concat();
        let now = Read { bytes, sets, stamps: self.named.iter().map(|file| stamp(file)).collect() };
        if self.last.as_ref() == Some(&now) {
            return Ok(());
        }
        let Read { bytes, sets, .. } = self.last.insert(now);
        let text = String::from_utf8_lossy(bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let folder = self.path.parent().unwrap_or(&self.path);
        let chosen = Chosen { above_all: self.accuracy, sets, ..Chosen::default() };
        let read = match crash::catch(|| reader::read_by(self.registry, &name, folder, bytes, chosen)) {
            Ok(read) => read,
            Err(failure) => {
                crashed(board, &name, text, &failure);
                return Ok(());
            }
        };
        let report = read.as_ref().map_or_else(|report| report, |loaded| &loaded.warnings);
        self.named = report.files().to_vec();
        files.watch(self.named.iter().chain([&self.path]))?;
        match read {
            Ok(Loaded { model, .. }) if !fits(&model) => {
                let [width, height] = model.camera.value.pixels;
                let report = &format!(
                    "error: an image of {width} x {height} pixels is too large for a page\n\
                     help: the maximum is {MAX_PIXELS} pixels, such as 4096 x 4096"
                );
                board.fault(events::fault(&Fault { lines: &[], name: &name, report, text: Some(text) }));
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
                    stale: AtomicBool::new(false),
                });
                board.show(&frame);
                // Sending fails only when the program ends, and the thread that renders with it.
                let _ = frames.send(frame);
            }
            Err(report) => {
                let places = report.faults().iter().filter_map(|fault| fault.place.as_ref());
                let lines = places.filter_map(|place| lines(text, place)).map(|[first, _]| first);
                let lines = &lines.collect::<Vec<_>>();
                let report = &report.to_string();
                board.fault(events::fault(&Fault { lines, name: &name, report, text: Some(text) }));
            }
        }
        Ok(())
    }
}

/// Reports that the program failed at a scene. It goes on with the next one.
fn crashed(board: &Board, name: &str, text: &str, failure: &Failure) {
    tell(failure);
    let Failure::Failed(message) = failure else { return };
    let report = &format!("error: {message}");
    board.fault(events::fault(&Fault { lines: &[], name, report, text: Some(text) }));
}

fn fits(model: &Model) -> bool {
    let [width, height] = model.camera.value.pixels;
    width * height <= MAX_PIXELS
}
