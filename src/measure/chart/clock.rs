//! Measures times that can be compared: the choices take turns, so that other work of the machine slows all of them;
//! times are CPU times of the thread, the minimum of many rounds.

use super::progress::Progress;
use super::times::Times;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};
use tabray_tools::clock;

/// The maximum number of rounds.
const MAX_ROUNDS: usize = 15;

/// The minimum number of rounds of the usual work, however long they take.
const MIN_ROUNDS: usize = 3;

/// The time that one choice may take in all its rounds.
const CHOICE_TIME: Duration = Duration::from_millis(200);

/// The shortest duration that is measured; shorter work is repeated within a round.
const MIN_DURATION: Duration = Duration::from_millis(2);

/// The estimate of the work for one choice before it is known, in units of [`Progress`].
const UNITS: usize = 100_000;

/// Returns the work of timing this many choices, in units of [`Progress`].
pub fn work(choices: usize) -> usize {
    choices * UNITS
}

/// Times the work of choices, by index. The work of each consists of `count` equal items; the times are for one item.
/// `effort` is the part of the usual time that is spent.
pub fn rounds(
    (choices, count): (usize, usize),
    effort: f64,
    mut work: impl FnMut(usize),
    progress: &mut dyn Progress,
) -> ControlFlow<(), Vec<Times>> {
    let patience = CHOICE_TIME.mul_f64(effort);
    let min_rounds = if effort < 1.0 { 1 } else { MIN_ROUNDS };
    let mut repeats = vec![1_u32; choices];
    let mut all = vec![Vec::new(); choices];
    let mut waits = vec![Duration::ZERO; choices];
    // The first round warms up the caches and tells how long the work takes. It counts where that is long.
    for choice in 0..choices {
        let (took, waited) = time(|| work(choice));
        repeats[choice] = (MIN_DURATION.as_nanos() / took.as_nanos().max(1)).clamp(1, 1000) as u32;
        if took > patience {
            all[choice].push(took);
            waits[choice] = waited;
        }
        progress.done(UNITS / (MAX_ROUNDS + 1))?;
    }
    'rounds: for _ in 0..MAX_ROUNDS {
        for choice in 0..choices {
            let spent: Duration = all[choice].iter().sum::<Duration>() * repeats[choice];
            if all[choice].len() < min_rounds || spent < patience {
                let (took, waited) = time(|| (0..repeats[choice]).for_each(|_| work(choice)));
                all[choice].push(took / repeats[choice]);
                waits[choice] += waited / repeats[choice];
            }
            if progress.done(UNITS / (MAX_ROUNDS + 1)).is_break() {
                match all.iter().any(Vec::is_empty) {
                    true => return ControlFlow::Break(()),
                    false => break 'rounds,
                }
            }
        }
    }
    let one = |time: &Duration| time.as_secs_f64() / count as f64;
    ControlFlow::Continue(
        all.iter_mut()
            .zip(waits)
            .map(|(times, waited)| {
                times.sort_unstable();
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

/// Returns the CPU time that some work takes on this thread, and how much longer it takes on the wall clock.
fn time(work: impl FnOnce()) -> (Duration, Duration) {
    let (start, wall) = (clock::now(), Instant::now());
    work();
    let took = (clock::now() - start).max(Duration::from_nanos(1));
    (took, wall.elapsed().saturating_sub(took))
}
