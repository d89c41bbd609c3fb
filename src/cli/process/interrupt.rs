//! Ctrl-C: a command that keeps nothing ends at once; a command that keeps what is done notes the interruption and
//! stops soon. A second interruption ends the program at once.

use crate::process::failure::{self, Failure};
use crate::process::temporary;
#[cfg(target_os = "linux")]
use nix::sys::signal::{SigSet, Signal};
#[cfg(target_os = "linux")]
use std::fs;
use std::ops::ControlFlow;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

static ACTION: Mutex<InterruptAction> = Mutex::new(InterruptAction::SetFlag);

/// The time that a command with [`InterruptAction::SetFlagThenExit`] has to stop by itself.
const PATIENCE: Duration = Duration::from_millis(800);

/// The time within which a second signal is the same interruption: `timeout` sends one to the program, and then one to its
/// process group.
const TWICE: Duration = Duration::from_millis(100);

/// The effect of the first interruption.
#[derive(Clone, Copy)]
pub enum InterruptAction {
    /// The program exits with this message.
    Exit(&'static str),
    /// A flag is set, which [`check`] reports.
    SetFlag,
    /// A flag is set, which [`check`] reports. If this is still the action after `PATIENCE`, the program exits with
    /// this message.
    SetFlagThenExit(&'static str),
    /// A flag is set, which [`check`] reports. If nothing is sent to whoever reads the output for `PATIENCE`, the
    /// program exits with this message; the function tells how many bytes were sent.
    SetFlagUntilStuck(fn() -> u64, &'static str),
}

fn action() -> MutexGuard<'static, InterruptAction> {
    ACTION.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sets what the first interruption does from here on.
pub fn set_action(next: InterruptAction) {
    *action() = next;
}

/// Catches interruptions from here on; `first` is the effect of the first one.
pub fn catch(first: InterruptAction) -> Result<(), Failure> {
    set_action(first);
    handle(|| {
        // The lock is held while the program ends, so that the action does not change meanwhile.
        match *action() {
            InterruptAction::Exit(said) => {
                failure::end_even_if_blocked(&Failure::Stopped);
                failure::end(&Failure::Interrupted(said));
            }
            InterruptAction::SetFlag => {}
            InterruptAction::SetFlagThenExit(_) => drop(thread::spawn(|| {
                thread::sleep(PATIENCE);
                if let InterruptAction::SetFlagThenExit(said) = *action() {
                    failure::end(&Failure::Interrupted(said));
                }
            })),
            InterruptAction::SetFlagUntilStuck(sent, said) => drop(thread::spawn(move || {
                loop {
                    let before = sent();
                    thread::sleep(PATIENCE);
                    if !matches!(*action(), InterruptAction::SetFlagUntilStuck(..)) {
                        return;
                    }
                    if sent() == before {
                        failure::end_even_if_blocked(&Failure::Stopped);
                        failure::end(&Failure::Interrupted(said));
                    }
                }
            })),
        }
    })
}

/// Lets a program that `nohup` started go on when its terminal is closed. Catching interruptions catches hangups too, and
/// would undo that they are ignored; a blocked one does not arrive. This must be called before other threads begin. If it
/// cannot be told whether they are ignored, they are caught.
#[cfg(target_os = "linux")]
pub fn keep_ignoring_hangups() {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored =
        status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    if ignored.is_some_and(|signals| signals >> (Signal::SIGHUP as u32 - 1) & 1 == 1) {
        let _ = SigSet::from(Signal::SIGHUP).thread_block();
    }
}

/// Notes interruptions from here on; the first one calls `then`, on a thread of its own.
pub fn catch_with(then: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    handle(then)
}

fn handle(mut then: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    let mut first: Option<Instant> = None;
    ctrlc::set_handler(move || match first {
        Some(first) if first.elapsed() < TWICE => {}
        Some(_) => {
            temporary::remove_all();
            process::exit(130);
        }
        None => {
            first = Some(Instant::now());
            INTERRUPTED.store(true, Ordering::Relaxed);
            then();
        }
    })
    .map_err(|error| Failure::Failed(format!("cannot catch interruptions: {error}")))
}

/// If an interruption would end the program, calls `tell` with the message and ends the program.
pub fn exit_if_interrupt_would(tell: impl FnOnce(&'static str)) {
    if let InterruptAction::Exit(said) = *action() {
        failure::end_even_if_blocked(&Failure::Stopped);
        tell(said);
        failure::end(&Failure::Stopped);
    }
}

/// Breaks if the user has interrupted the program.
pub fn check() -> ControlFlow<()> {
    if INTERRUPTED.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
