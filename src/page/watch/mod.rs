//! `tabray watch`: a page that shows the image while its scene is edited.

mod alternative;
pub(super) mod answer;
mod browser;
mod camera;
mod chart;
mod events;
pub(super) mod feed;
mod files;
pub(super) mod frame;
mod scenes;
pub(super) mod session;
mod watched;

use files::Files;
use hyper::Request;
use hyper::body::Bytes;
use scenes::Scenes;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;
use tabray_cli::files::input;
use tabray_cli::options::{method, set};
use tabray_cli::process::failure::{self, Failure};
use tabray_cli::process::{interrupt, messages};
use tabray_cli::{Command, Group, Run};
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_serve::{Reach, Server, Work};
use watched::Watched;

/// The time for which a file must have been left alone before it is read: many editors write a file in several steps.
const SETTLED: Duration = Duration::from_millis(10);

/// How often files are looked at, as the system does not tell of every change.
const LOOK: Duration = Duration::from_secs(1);

/// The time in which the program ends by itself when it is interrupted.
const PATIENCE: Duration = Duration::from_millis(300);

/// Show the image in the browser, and again after each change
///
/// Unless `--host` says otherwise, only this machine can reach the page, and only at the printed address. The address
/// contains a token, new for each run, that keeps other users out. Click a pixel to see how it gets its colour. For
/// several scenes, the page has a list; only scenes that are open on a page are read and rendered. An image waits while no page is open. Ctrl-C quits, with
/// status 0.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scenes: files, or folders with .ray and .toml files, including files that are added later
    #[arg(required = true, value_name = "SCENE|DIR")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    set: set::Args,
    #[command(flatten)]
    reach: Reach,
    /// Open the page in the browser
    #[arg(long)]
    open: bool,
    #[command(flatten)]
    method: method::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray watch ball.ray --open
  tabray watch ball.ray --port 3000
  tabray watch ball.ray --port 3000 --allow-host desk.example.org
  tabray watch ball.ray cone.ray
  tabray watch scenes/light";

/// The events that the command waits for.
enum Event {
    Changed,
    Interrupted,
    ServerFailed(String),
}

inventory::submit! {
    Command::new("watch", Group::First, &Run(run)).placed(4, 20)
}

fn run(registry: &'static Registry, args: Args) -> Result<(), Failure> {
    if args.scenes.iter().any(|scene| input::is_standard(scene)) {
        return Err(Failure::usage("standard input cannot be watched").help("name the scene's file"));
    }
    let accuracy = args.method.accuracy()?;
    let (sender, events) = mpsc::channel();
    let mut files = Files::new(notifier(&sender, || Event::Changed));
    let scenes = Scenes::new(
        registry,
        &args.scenes,
        args.set.values,
        Arc::new(notifier(&sender, || Event::Changed)),
        &mut files,
    )?;
    let server = Server::open(args.reach)?;
    let url = server.url();
    let interrupted = notifier(&sender, || Event::Interrupted);
    interrupt::catch_with(move || {
        interrupted();
        // The loop below may be reading a large scene.
        thread::spawn(|| {
            thread::sleep(PATIENCE);
            failure::exit();
        });
    })?;

    let scenes = Arc::new(scenes);
    thread::spawn({
        let scenes = scenes.clone();
        move || {
            let work = Work::new(answer::JOBS);
            let run = server.run(async move |request: Request<Bytes>| {
                ControlFlow::Continue(scenes.answer(&request, &work).await)
            });
            if let Err(error) = run {
                let reason = text::reason(&error);
                let _ = sender.send(Event::ServerFailed(format!("the server stopped: {reason}")));
            }
        }
    });
    messages::note(&format!("watching {} at {url} (Ctrl-C quits)", scenes.name()));
    // Keeps the file that leads the browser to the page.
    let opened = args.open.then(|| browser::open(&url));
    if let Some(Err(error)) = &opened {
        let reason = text::reason(error);
        messages::note(&format!("cannot open a browser: {reason}; open the address yourself"));
    }
    let (mut watched, mut told) = (Vec::new(), None);
    loop {
        // The stamps of the files are taken before the files are read, so that a change in the meantime is noticed.
        files.poll();
        let refused =
            files.refused().map(|reason| format!("{reason}; its files are looked at once a second"));
        if refused.is_some() && refused != told {
            messages::warning(refused.as_deref().unwrap_or_default(), None);
        }
        scenes.find();
        if refused.is_some() || told.is_some() {
            scenes.tell_of_refusal(refused.as_deref());
        }
        told = refused;
        for session in scenes.from(watched.len()) {
            watched.push(Watched::new(session, watched.len(), accuracy));
        }
        for (number, scene) in watched.iter_mut().enumerate() {
            scene.follow(scenes.is_wanted(number), &mut files)?;
        }
        match next(&events, &mut files) {
            Event::Changed => {}
            Event::Interrupted => return Ok(()),
            Event::ServerFailed(message) => return Err(Failure::Failed(message)),
        }
    }
}

/// Returns a function that sends an event, from any thread.
fn notifier(
    sender: &Sender<Event>,
    event: impl Fn() -> Event + Send + 'static,
) -> impl Fn() + Send + 'static {
    let sender = sender.clone();
    move || {
        // If no one receives the event, the program is about to end.
        let _ = sender.send(event());
    }
}

/// Waits for an event, and looks at the files meanwhile. Changes that follow one another count as one.
fn next(events: &Receiver<Event>, files: &mut Files) -> Event {
    let mut last = loop {
        match events.recv_timeout(LOOK) {
            Ok(event) => break event,
            Err(RecvTimeoutError::Timeout) if files.poll() => break Event::Changed,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break Event::Interrupted,
        }
    };
    while let Event::Changed = last {
        match events.recv_timeout(SETTLED) {
            Ok(more) => last = more,
            Err(_) => break,
        }
    }
    last
}
