//! `tabray choose`: chooses accuracy and samples for a maximum error or time.

use super::chart::all_accuracies;
use crate::chart::{self, Cost, Estimate, Estimates, Goal, Small};
use crate::measuring::{Limit, Work, wait};
use clap::ArgGroup;
use std::cmp::Ordering;
use std::fmt::Write;
use std::io;
use std::panic;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};
use tabray_cli::files::input;
use tabray_cli::options::max_error::{LEVELS, MaxError, levels};
use tabray_cli::options::{scene, set};
use tabray_cli::process::failure::{self, Failure, print};
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::process::{program, time_limit};
use tabray_cli::{Command, Group, Run};
use tabray_core::render::plan::Plan;
use tabray_core::scene::choice::Choice;
use tabray_core::text::{self, short};
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::registry::Registry;
use tabray_tools::clock;
use tabray_tools::unchecked::{self, Unchecked};

/// Choose accuracy and samples for a maximum error or time
///
/// Measures the choices on pixels from all parts of the image, against samples that no choice takes, and prints the
/// command line to use. The error of the whole image is at most what is printed, with a confidence of 95 %; with
/// --certain, by a bound that holds whatever the other pixels are, with one of 99 %. The comparison of the choices takes
/// 2 to 8 million rays for each of up to four ranges of samples, and the search for lamps, wires and glints that samples
/// may miss up to 4 million. Gives up after 30 seconds of an idle machine or after --time-limit, and may take a tenth longer.
#[derive(clap::Args)]
#[command(group = ArgGroup::new("limit").args(["max_error", "max_time"]).required(true))]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// Maximum error: the root mean square error of the colours, such as `2` (levels of 255) or `0.5%` (of white)
    #[arg(long, value_name = "LEVELS|PERCENT%", allow_negative_numbers = true)]
    max_error: Option<MaxError>,
    /// Maximum time for the image in seconds, on all cores of an otherwise idle machine
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    max_time: Option<f64>,
    /// Measure the error that one of a thousand pixels exceeds, instead of the root mean square of all: a few jagged edges
    /// count
    #[arg(long)]
    worst: bool,
    /// Promise only what bounds make certain: of all pixels, and of all that may be smaller than a sample
    #[arg(long)]
    certain: bool,
}

const EXAMPLES: &str = "\
Examples:
  tabray choose ball.ray --max-error 2       # levels of 255
  tabray choose ball.ray --max-error 2 --certain
  tabray choose ball.ray --max-time 2 --worst";

/// The time that choosing may take if no time limit is given.
const LIMIT: Duration = Duration::from_secs(30);

/// The ratio of costs or errors from which on another choice than the first is worth taking.
const GAIN: f64 = 0.8;

/// The greatest ratio of the time that a render may take to its estimate for which no range is told.
const SURE: f64 = 1.3;

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("must be a number above 0".to_owned()),
    }
}

inventory::submit! {
    Command::new("choose", Group::First, &Run(run)).placed(6, 16)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let limit = Limit::new(time_limit::given(), LIMIT);
    let (mut work, start) = (Work::within(limit), Instant::now());
    let units = work.units();
    let source = args.scene.read()?;
    let model = input::print_warnings(source.load(registry, None))?.model;
    let plan = Plan::for_picture(&model);
    // A render begins with the same work as this program.
    let beginning = clock::of_process().as_secs_f64();
    let unchecked = unchecked::of(&plan);
    drop(plan);
    drop(model);
    let load = all_accuracies(registry, &source)?;
    // Until here, what takes too long has nothing to keep.
    time_limit::keep();
    interrupt::catch(InterruptAction::Exit("nothing has been chosen"))?;
    let (worst, is_certain) = (args.worst, args.certain);
    // Either the error or the time is given.
    let time = args.max_time.unwrap_or(f64::INFINITY);
    let (goal, asked) = match args.max_error {
        Some(error) => (Goal::Error { most: error.of_white(), worst }, error.to_string()),
        None => (Goal::Time { most: time, worst }, format!("{time} s")),
    };
    let too_long = || {
        let limit = humantime::format_duration(limit.time);
        Failure::Failed(format!("choosing takes longer than {limit}; `--time-limit` gives it more"))
    };
    thread::scope(|scope| {
        let (sender, measured) = mpsc::channel();
        let load = &load;
        scope.spawn(move || {
            let estimates = chart::estimates(load, (goal, is_certain), beginning, &mut work);
            work.end();
            let _ = sender.send(estimates);
        });
        // A pixel that takes far too long is not waited for.
        let last = limit.last().saturating_sub(start.elapsed());
        let estimates = match wait(&measured, &units, last) {
            Ok(estimates) => estimates.map_err(|error| match error.kind() {
                io::ErrorKind::Interrupted => too_long(),
                _ => error.into(),
            })?,
            Err(RecvTimeoutError::Timeout) => failure::end(&too_long()),
            // The thread panicked, and has said so.
            Err(RecvTimeoutError::Disconnected) => panic::resume_unwind(Box::new(())),
        };
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let choice = Selection { estimates: &estimates, cores, goal, asked, is_certain, unchecked };
        print(&choice.words(choice.chosen()?, &args.scene.path, &args.scene.set))
    })
}

/// Selects among choices by their estimates.
struct Selection<'e> {
    estimates: &'e Estimates,
    cores: usize,
    goal: Goal,
    /// The maximum error or time in words.
    asked: String,
    is_certain: bool,
    /// What no number of samples makes right.
    unchecked: Vec<Unchecked>,
}

impl<'e> Selection<'e> {
    /// Tells whether one choice is clearly faster than another one. Those of one accuracy are compared by their rays, which
    /// are the same on each machine; times of choices that are timed apart are not.
    fn is_faster(one: &Estimate, other: &Estimate) -> bool {
        let costs = if one.accuracy == other.accuracy {
            [one.rays, other.rays]
        } else {
            [one.cost.tracing.mean, other.cost.tracing.mean]
        };
        costs[0] <= GAIN * costs[1]
    }

    /// Returns the choice that meets the goal: of the scene's own accuracy, unless another one is clearly better.
    fn chosen(&self) -> Result<&'e Estimate, Failure> {
        let accuracies = self.estimates.all.chunk_by(|one, other| {
            (one.accuracy, one.most.is_some()) == (other.accuracy, other.most.is_some())
        });
        let mut best: Option<&Estimate> = None;
        for met in accuracies.filter_map(|choices| self.goal.first_meeting(choices)) {
            let is_better = |best: &Estimate| match self.goal {
                Goal::Error { .. } | Goal::None => Self::is_faster(met, best),
                Goal::Time { .. } => met.bound <= GAIN * best.bound,
            };
            if best.is_none_or(is_better) {
                best = Some(met);
            }
        }
        best.ok_or_else(|| {
            let nearest = |of: &dyn Fn(&Estimate) -> f64| {
                self.estimates.all.iter().min_by(|one, other| of(one).total_cmp(&of(other)))
            };
            let asked = &self.asked;
            let short =
                if self.estimates.is_short { "; there was no time for more: `--time-limit` gives it" } else { "" };
            Failure::Failed(match self.goal {
                Goal::Error { most, .. }
                    if self.is_certain && self.estimates.all.iter().any(|one| self.is_hidden(one, most)) =>
                {
                    let Small { pixels, missed, .. } = self.estimates.small;
                    format!(
                        "no promise: in {pixels} of {} pixels, samples may have missed something bright and small, which \
                         may add {} to the error",
                        self.estimates.pixels,
                        levels(missed)
                    )
                }
                Goal::Error { .. } | Goal::None if self.is_certain => {
                    let least = nearest(&|one| one.bound).map_or(f64::INFINITY, |one| one.bound);
                    let least = if least.is_finite() { levels(least) } else { "unknown".to_owned() };
                    format!(
                        "no choice is certain to have an error of at most {asked}; the least bound is {least}{short}"
                    )
                }
                Goal::Error { .. } | Goal::None => {
                    let nearest = nearest(&|one| one.bound).map_or(String::new(), |one| {
                        let [error, most] = [one.error, one.bound].map(levels);
                        format!("; the nearest is `--samples {}`, with {error}, or at most {most}", one.numbers())
                    });
                    format!("no choice was measured to have an error of at most {asked}{nearest}{short}")
                }
                Goal::Time { .. } => {
                    let least = nearest(&|one| one.cost.time.range[1]);
                    let least = least.map_or(f64::INFINITY, |one| one.cost.time.range[1]);
                    format!("no choice is sure to take at most {asked}; the fastest may take {}", seconds(least))
                }
            })
        })
    }

    /// Tells whether a choice would meet the greatest error, if nothing could be missed that is smaller than a sample.
    fn is_hidden(&self, one: &Estimate, most: f64) -> bool {
        let small = self.estimates.small;
        small.pixels > 0 && (one.bound - small.missed <= most || small.missed > most)
    }

    /// Says which choices were considered and which one was chosen, and shows the command line.
    fn words(&self, chosen: &Estimate, scene: &Path, set: &set::Args) -> String {
        let how = match chosen.accuracy {
            Accuracy::Classic => "--method classic".to_owned(),
            accuracy => format!("--accuracy {}", accuracy.option().name),
        };
        let why = match self.goal {
            Goal::Error { .. } | Goal::None => format!("the fastest with an error of at most {}", self.asked),
            Goal::Time { .. } => {
                format!("the one with the least error within {} on {} cores", self.asked, self.cores)
            }
        };
        let Estimates { pixels: all, small, is_short, .. } = *self.estimates;
        let sure = if self.is_certain {
            "by a bound with a confidence of 99 %"
        } else {
            "with a confidence of 95 %"
        };
        let small = match small.pixels {
            0 if small.is_left_out => {
                " Most pixels may show something bright and small that samples have missed; `--certain` looks for it."
                    .to_owned()
            }
            0 => String::new(),
            pixels => {
                let missed = if self.is_certain { "; bounds include it" } else { "" };
                format!(
                    " In {pixels} of {all} pixels, samples may have missed something bright and small{missed}."
                )
            }
        };
        let short = if is_short { "; there was no time for more" } else { "" };
        let unchecked: String = self.unchecked.iter().map(|one| format!("\n{one}\n")).collect();
        format!(
            "{}\nThe marked choice is {why}. Errors are in levels of 255, and were measured on {} of {all} pixels, drawn from \
             all parts of the image{short}; that of the whole image is at most what the table says, {sure}.{small} Choices \
             of one accuracy are compared by their rays per pixel, those of several by their times.\n\n{}\n{unchecked}\n\
             {} render {}{} {how} --samples {}\n",
            self.table(chosen),
            chosen.pixels,
            self.times(chosen),
            program::name(),
            text::shown(scene),
            set.words(),
            chosen.numbers()
        )
    }

    /// Lists the choices that were considered, with a mark before the chosen one.
    fn table(&self, chosen: &Estimate) -> String {
        let head = ["accuracy", "samples", "error", "at most", "rays", "time", "CPU time"];
        let mut text = format!(
            "  {:<9}{:>8}{:>12}{:>12}{:>9}{:>12}{:>12}\n",
            head[0], head[1], head[2], head[3], head[4], head[5], head[6]
        );
        let is_chosen = |one: &Estimate| is_same(one, chosen);
        let mut shown: Vec<_> =
            self.estimates.all.iter().filter(|one| self.is_best(one) || is_chosen(one)).collect();
        shown.sort_by(|a, b| {
            (a.most, a.samples, a.cost.tracing.mean)
                .partial_cmp(&(b.most, b.samples, b.cost.tracing.mean))
                .unwrap_or(Ordering::Equal)
        });
        for estimate in shown {
            let mark = if is_chosen(estimate) { '>' } else { ' ' };
            let name = estimate.accuracy.option().name;
            let error =
                |error: f64| if error.is_finite() { short(LEVELS * error) } else { "unknown".to_owned() };
            let [measured, bound] = [error(estimate.error), error(estimate.bound)];
            let [time, cpu] = [estimate.cost.time, estimate.cost.cpu].map(|time| seconds(time.mean));
            let _ = writeln!(
                text,
                "{mark} {name:<9}{:>8}{measured:>12}{bound:>12}{:>9.1}{time:>12}{cpu:>12}",
                estimate.numbers(),
                estimate.rays
            );
        }
        text
    }

    /// Says how long the chosen render takes, and how sure that is.
    fn times(&self, chosen: &Estimate) -> String {
        let idle = format!("on {} cores that have nothing else to do", self.cores);
        let rays = rounded(chosen.cost.rays);
        let Cost { cpu, time, .. } = chosen.cost;
        if cpu.range[1] <= SURE * cpu.mean {
            let [cpu, time] = [cpu, time].map(|time| seconds(time.mean));
            return format!(
                "It takes about {cpu} of CPU time for {rays} rays of all kinds, and {time} {idle}."
            );
        }
        let [cpu, time] = [cpu, time].map(|time| {
            let [least, most] = time.range.map(seconds);
            format!("from {least} to {most}")
        });
        format!(
            "It takes {cpu} of CPU time for about {rays} rays of all kinds, and {time} {idle}. The places of the image where \
             rays were timed differ too much to say more."
        )
    }

    /// Tells whether no other choice is clearly faster and has no larger bound.
    fn is_best(&self, one: &Estimate) -> bool {
        !self
            .estimates
            .all
            .iter()
            .any(|other| !is_same(one, other) && Self::is_faster(other, one) && other.bound <= one.bound)
    }
}

/// Writes a time of this many seconds to about two digits.
fn seconds(seconds: f64) -> String {
    let digits = if seconds < 0.1 { 3 } else { 2 };
    if seconds.is_finite() { format!("{seconds:.digits$} s") } else { "an unknown time".to_owned() }
}

/// Writes a number of rays: a small one as it is, others to about three digits.
fn rounded(rays: f64) -> String {
    match rays {
        ..1e3 => format!("{rays:.0}"),
        ..1e6 => format!("{:.0} thousand", rays / 1e3),
        ..1e7 => format!("{:.2} million", rays / 1e6),
        _ => format!("{:.0} million", rays / 1e6),
    }
}

/// Tells whether two estimates are of the same choice.
fn is_same(one: &Estimate, other: &Estimate) -> bool {
    (one.accuracy, one.samples, one.most) == (other.accuracy, other.samples, other.most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_rays_are_told_as_they_are() {
        let told = [48.0, 999.0, 1500.0, 1.234e6, 3.21e7].map(rounded);
        assert_eq!(told, ["48", "999", "2 thousand", "1.23 million", "32 million"]);
    }
}
