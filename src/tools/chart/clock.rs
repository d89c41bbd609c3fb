//! Times that can be compared: the same work of each choice by turns, so that whatever else the machine does meets all
//! of them, in CPU time of the thread, the least of many rounds.

use super::progress::Progress;
use crate::tools::bench::clock;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// The rounds that are run at most.
const MOST: usize = 15;

/// The rounds that are run at least, however long they take.
const LEAST: usize = 3;

/// What one choice may take in all of its rounds.
const ENOUGH: Duration = Duration::from_millis(200);

/// Work that takes less is repeated within a round.
const SHORTEST: Duration = Duration::from_millis(2);

/// What a choice's work is taken for before it is known, in units of [`Progress`].
const UNITS: usize = 100_000;

/// What a piece of work took, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// In the shortest round.
    pub least: f64,
    /// In the middle one.
    pub median: f64,
    /// How many rounds there were.
    pub rounds: usize,
    /// How long they waited for other work of the machine, as a part of what they took.
    pub waited: f64,
}

impl Times {
    /// How much longer the middle round was than the shortest, as a part of that.
    pub fn spread(&self) -> f64 {
        self.median / self.least - 1.0
    }
}

/// What timing so many choices adds to the work.
pub fn work(choices: usize) -> usize {
    choices * UNITS
}

/// Times the work of choices by their index; each does `count` equal things, and the times are those of one.
pub fn rounds(
    choices: usize,
    count: usize,
    mut work: impl FnMut(usize),
    progress: &mut dyn Progress,
) -> ControlFlow<(), Vec<Times>> {
    let mut repeats = vec![1_u32; choices];
    let mut all = vec![Vec::new(); choices];
    let mut waits = vec![Duration::ZERO; choices];
    // To warm up, and to see how long it takes.
    for (choice, repeats) in repeats.iter_mut().enumerate() {
        let (took, _) = time(|| work(choice));
        *repeats = (SHORTEST.as_nanos() / took.as_nanos().max(1)).clamp(1, 1000) as u32;
        progress.done(UNITS / (MOST + 1))?;
    }
    'rounds: for round in 0..MOST {
        for choice in 0..choices {
            let spent: Duration = all[choice].iter().sum::<Duration>() * repeats[choice];
            if round < LEAST || spent < ENOUGH {
                let (took, waited) = time(|| (0..repeats[choice]).for_each(|_| work(choice)));
                all[choice].push(took / repeats[choice]);
                waits[choice] += waited / repeats[choice];
            }
            let is_broken_off = progress.done(UNITS / (MOST + 1)).is_break();
            if is_broken_off && round == 0 {
                return ControlFlow::Break(());
            } else if is_broken_off {
                break 'rounds;
            }
        }
    }
    let one = |time: &Duration| time.as_secs_f64() / count as f64;
    ControlFlow::Continue(
        all.iter_mut()
            .zip(waits)
            .map(|(times, waited)| {
                times.sort();
                Times {
                    least: one(&times[0]),
                    median: one(&times[times.len() / 2]),
                    rounds: times.len(),
                    waited: waited.div_duration_f64(times.iter().sum()),
                }
            })
            .collect(),
    )
}

/// The CPU time of this thread that some work takes, and how much longer the clock on the wall runs.
fn time(work: impl FnOnce()) -> (Duration, Duration) {
    let (start, wall) = (clock::now(), Instant::now());
    work();
    let took = (clock::now() - start).max(Duration::from_nanos(1));
    (took, wall.elapsed().saturating_sub(took))
}
