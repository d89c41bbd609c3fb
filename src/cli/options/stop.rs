//! Stops a render before its image is finished: at an interruption, or at a limit of time or memory.

use crate::files::output;
use crate::process::failure::Failure;
use crate::process::interrupt::{self, InterruptAction};
use crate::process::{memory, messages, time_limit};
use bytesize::ByteSize;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};
use tabray_core::render::tiles::{BAND, TILE};
use tabray_core::text;

/// The time to leave an unfinished image, as a multiple of the time in which it was written: it is read, and written
/// again as a checkpoint and with transparency. The time limit includes that, up to a quarter of the limit.
const LEAVING: u32 = 3;

/// The interval at which time and memory are checked.
const LOOK: Duration = Duration::from_millis(20);

/// The memory for a pixel of a band, in bytes: three for its colour, the rest for its share of the tiles' state.
const PIXEL: u64 = 4;

/// The memory for each pixel of the row that is being written, in bytes.
const ROW: u64 = 64;

/// The message if no image was written.
const NOT_BEGUN: &str = "nothing has been rendered yet, and nothing is written";

/// The message if the program ends while an image is not finished.
const NOT_FINISHED: &str = "the image was not finished";

/// The limits of time and memory.
#[derive(clap::Args)]
#[group(id = "when to stop")]
#[command(next_help_heading = "Limits")]
pub struct Args {
    /// Continue from the checkpoint that was left beside the image when its render was stopped; if there is none, start
    /// from the beginning. Existing parts and frames are not rendered again
    #[arg(long)]
    pub resume: bool,
}

/// A limit on a render.
#[derive(Clone, Copy)]
enum Limit {
    Time(Duration),
    Memory(ByteSize),
}

impl Limit {
    fn report(&self) {
        messages::note(&format!("the {self} has been reached"));
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time(limit) => write!(f, "time limit of {}", humantime::format_duration(*limit)),
            Self::Memory(limit) => write!(f, "memory limit of {limit}"),
        }
    }
}

/// Tells whether a render is to stop.
#[derive(Default)]
pub struct Stop {
    reached: Arc<OnceLock<Limit>>,
    /// Whether rendering has begun.
    begun: Arc<OnceLock<()>>,
    /// The time spent on writing the image so far, in microseconds.
    written: Arc<AtomicU64>,
}

impl Stop {
    /// Tells whether the render is to stop.
    pub fn is_due(&self) -> bool {
        interrupt::check().is_break() || self.reached.get().is_some()
    }

    /// Reports why the render stops.
    pub fn report(&self) {
        match self.reached.get() {
            Some(limit) => limit.report(),
            None => messages::note("interrupted; press Ctrl-C again to quit at once"),
        }
    }

    /// Adds time that was spent on writing the image.
    pub fn add_writing_time(&self, time: Duration) {
        self.written.fetch_add(time.as_micros() as u64, Ordering::Relaxed);
    }

    /// Lets interruptions and limits only be noted from now on, because there is something to keep.
    pub fn begin(&self) {
        interrupt::set_action(InterruptAction::SetFlag);
        memory::stops_at_limit();
        let _ = self.begun.set(());
    }

    /// Does what [`begin`](Self::begin) does where the image goes to a reader, who may have stopped reading: then the program
    /// ends.
    pub fn begin_sending(&self) {
        self.begin();
        interrupt::set_action(InterruptAction::SetFlagUntilStuck(output::sent, NOT_FINISHED));
    }

    /// Lets interruptions and limits end the program with this message from now on, because no part of the image can be
    /// kept.
    pub fn begin_unkept(&self, said: &'static str) {
        interrupt::set_action(InterruptAction::Exit(said));
        memory::stops_at_limit();
        let _ = self.begun.set(());
    }

    /// Lets interruptions and limits end the program from now on; images not yet written are lost.
    pub fn exit_on_interrupt(&self) -> Result<(), Failure> {
        interrupt::set_action(InterruptAction::Exit(NOT_FINISHED));
        match self.reached.get() {
            Some(limit) if matches!(limit, Limit::Time(_)) => {
                limit.report();
                messages::note(NOT_FINISHED);
                Err(Failure::Stopped)
            }
            _ if interrupt::check().is_break() => Err(Failure::Interrupted(NOT_FINISHED)),
            _ => Ok(()),
        }
    }
}

impl Args {
    /// Starts watching the limits, and catches interruptions. Both end the program until rendering begins.
    pub fn watch(&self) -> Result<Stop, Failure> {
        interrupt::catch(InterruptAction::Exit(NOT_FINISHED))?;
        let stop = Stop::default();
        let (time_limit, max_memory) = (time_limit::given(), memory::chosen());
        if time_limit.is_none() && max_memory.is_none() {
            return Ok(stop);
        }
        let (start, reached, begun) = (Instant::now(), stop.reached.clone(), stop.begun.clone());
        let written = stop.written.clone();
        let left = move || {
            let leaving = LEAVING * Duration::from_micros(written.load(Ordering::Relaxed));
            time_limit.map(|limit| limit.saturating_sub(start.elapsed() + leaving.min(limit / 4)))
        };
        let watch = move || {
            let look = || {
                let time = time_limit.filter(|_| left() == Some(Duration::ZERO));
                let over = max_memory.filter(|limit| memory::now().is_some_and(|now| now > limit.as_u64()));
                time.map(Limit::Time).or(over.map(Limit::Memory))
            };
            loop {
                if let Some(limit) = look() {
                    let _ = reached.set(limit);
                    // If nothing is rendered yet, there is nothing to keep.
                    if matches!(limit, Limit::Time(_)) {
                        interrupt::exit_if_interrupt_would(|said| {
                            limit.report();
                            messages::note(if begun.get().is_some() { said } else { NOT_BEGUN });
                        });
                    }
                    return;
                }
                thread::sleep(LOOK.min(left().unwrap_or(LOOK)));
            }
        };
        let started = thread::Builder::new().name("limits".to_owned()).spawn(watch);
        started.map(|_| stop).map_err(|error| {
            Failure::Failed(format!("cannot start a thread to watch the limits: {}", text::reason(&error)))
        })
    }

    /// Returns the memory that the textures and the objects of a scene may take, in bytes, if there is a limit.
    pub fn memory_left(&self) -> Option<u64> {
        memory::left()
    }

    /// Refuses an image that takes more memory at one time, in bytes, than the limit leaves.
    pub fn refuse_too_large(&self, bytes: usize) -> Result<(), Failure> {
        match (memory::chosen(), self.memory_left()) {
            (Some(limit), Some(left)) if left < bytes as u64 => {
                Err(Failure::usage(format!("{limit} of memory is not enough for this image"))
                    .help(format!("it needs about {} more", ByteSize(bytes as u64 - left))))
            }
            _ => Ok(()),
        }
    }

    /// Returns how many pixels of an image of this width may be in memory at one time.
    pub fn band(&self, width: usize) -> Result<usize, Failure> {
        let Some(limit) = memory::chosen() else { return Ok(BAND) };
        let Some(now) = memory::now() else {
            let message = "this system does not report how much memory the program uses";
            return Err(Failure::usage(message).help("leave out `--max-memory`"));
        };
        let row = ROW * width as u64;
        let strip = PIXEL * (TILE * width) as u64;
        let least = now + memory::ASIDE + row + strip;
        if limit.as_u64() < least {
            return Err(Failure::usage(format!("{limit} of memory is not enough for this image"))
                .help(format!("it needs at least about {}", ByteSize(least))));
        }
        // Three quarters are left for the rays: how much their reflections need shows only during the render.
        let bytes = ((limit.as_u64() - now - row) / 4).max(strip);
        Ok(usize::try_from(bytes / PIXEL).map_or(BAND, |pixels| pixels.min(BAND)))
    }
}
