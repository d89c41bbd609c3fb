//! The duration of work, in CPU time of the thread that does it. Other work of the machine hardly counts.

use std::time::Duration;

/// The shortest duration that is measured. Shorter work is repeated, so the cost of reading the clock does not count.
const MIN_DURATION: Duration = Duration::from_micros(200);

/// Returns the CPU time that this thread has used so far.
#[cfg(target_os = "linux")]
pub fn now() -> Duration {
    read(nix::time::ClockId::CLOCK_THREAD_CPUTIME_ID)
}

/// Returns the CPU time that all threads of this process have used so far.
#[cfg(target_os = "linux")]
pub fn of_process() -> Duration {
    read(nix::time::ClockId::CLOCK_PROCESS_CPUTIME_ID)
}

#[cfg(target_os = "linux")]
fn read(clock: nix::time::ClockId) -> Duration {
    // Every Linux has these clocks.
    nix::time::clock_gettime(clock).map_or(Duration::ZERO, Duration::from)
}

/// Returns the wall-clock time since the first call, on systems without a clock for the process.
#[cfg(not(target_os = "linux"))]
pub fn of_process() -> Duration {
    now()
}

/// Returns the wall-clock time since the first call, on systems without a clock for each thread.
#[cfg(not(target_os = "linux"))]
pub fn now() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// Returns the least time of each of several pieces of work, in seconds. They take turns for about as long as
/// `patience`, and at least three times: a machine that becomes slower slows down all of them.
pub fn least<const N: usize>(patience: Duration, works: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut works = works.map(|work| {
        let repeats = MIN_DURATION.as_nanos().div_ceil(time(work, 1).as_nanos().max(1));
        (work, repeats.max(1) as u32, Duration::MAX)
    });
    let (start, mut rounds) = (now(), 0);
    while rounds < 3 || now() - start < patience {
        for (work, repeats, least) in &mut works {
            *least = time(work, *repeats).min(*least);
        }
        rounds += 1;
    }
    works.map(|(_, repeats, least)| least.as_secs_f64() / f64::from(repeats))
}

fn time(work: &mut dyn FnMut(), repeats: u32) -> Duration {
    let start = now();
    for _ in 0..repeats {
        work();
    }
    now() - start
}
