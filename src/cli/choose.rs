//! `tabray choose`: chooses accuracy and samples for a maximum error or time.

use super::chart::all_accuracies;
use super::failure::{Failure, print};
use super::input::{self, Source};
use super::interrupt::{self, Manner};
use super::measuring::Work;
use super::program;
use crate::scene::choice::Choice;
use crate::scene::registry::Registry;
use crate::tools::chart::{self, Estimate};
use crate::world::accuracy::Accuracy;
use clap::ArgGroup;
use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

/// Choose accuracy and samples for a maximum error or time
///
/// Measures the choices on a part of the image, shows those it considered, and prints the command line to use. The
/// whole image may come out a little worse or take a little longer.
#[derive(clap::Args)]
#[command(group = ArgGroup::new("limit").args(["max_error", "max_time"]).required(true))]
pub struct Args {
    /// The scene; `-` reads it from standard input
    scene: PathBuf,
    /// Maximum error: the root mean square error of the colours, where 1 is white
    #[arg(long, value_name = "E", value_parser = positive)]
    max_error: Option<f64>,
    /// Maximum time for the image on all cores, in seconds
    #[arg(long, value_name = "T", value_parser = positive)]
    max_time: Option<f64>,
}

/// The ratio up to which times and errors count as equal; among equal choices the default accuracy is taken.
const SAME: f64 = 1.1;

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("must be a number above 0".to_owned()),
    }
}

pub fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let source = Source::read(&args.scene)?;
    input::told(source.load(registry, None))?;
    let load = all_accuracies(registry, &source)?;
    interrupt::catch(Manner::Ends("nothing has been chosen"))?;
    let mut work = Work::within(Duration::from_secs(60));
    let estimates = chart::estimates(&load, &mut work);
    work.end();
    let estimates = estimates.map_err(|error| match error.kind() {
        io::ErrorKind::Interrupted => Failure::Interrupted("nothing has been chosen"),
        _ => error.into(),
    })?;
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let choice = Weighed { estimates: &estimates, cores };
    let (chosen, why) = if let Some(error) = args.max_error {
        (choice.for_error(error)?, format!("the fastest with a measured error of at most {error}"))
    } else {
        // Either the error or the time is given.
        let time = args.max_time.unwrap_or(f64::INFINITY);
        (choice.for_time(time)?, format!("the one with the least error within {time} s on {cores} threads"))
    };
    print(&choice.words(chosen, &why, &args.scene))
}

struct Weighed<'e> {
    estimates: &'e [Estimate],
    cores: usize,
}

impl<'e> Weighed<'e> {
    /// Returns the time of a choice on all cores, in seconds.
    fn time(&self, estimate: &Estimate) -> f64 {
        estimate.seconds / self.cores as f64
    }

    fn for_error(&self, error: f64) -> Result<&'e Estimate, Failure> {
        let fit: Vec<_> = self.estimates.iter().filter(|estimate| estimate.rmse <= error).collect();
        let fastest = fit.iter().min_by(|a, b| a.seconds.total_cmp(&b.seconds)).ok_or_else(|| {
            let least = self.estimates.iter().map(|estimate| estimate.rmse).fold(f64::INFINITY, f64::min);
            Failure::Failed(format!(
                "no choice has a measured error of at most {error:e}; the least is {least:.2e}"
            ))
        })?;
        Ok(fit
            .iter()
            .find(|own| own.accuracy == Accuracy::default() && own.seconds <= SAME * fastest.seconds)
            .unwrap_or(fastest))
    }

    fn for_time(&self, time: f64) -> Result<&'e Estimate, Failure> {
        let fit: Vec<_> = self.estimates.iter().filter(|estimate| self.time(estimate) <= time).collect();
        let best = fit.iter().min_by(|a, b| a.rmse.total_cmp(&b.rmse)).ok_or_else(|| {
            let least =
                self.estimates.iter().map(|estimate| self.time(estimate)).fold(f64::INFINITY, f64::min);
            let least = Duration::from_secs_f64(least);
            Failure::Failed(format!(
                "no choice is estimated to take at most {time} s; the fastest takes about {least:.2?}"
            ))
        })?;
        Ok(fit
            .iter()
            .find(|own| own.accuracy == Accuracy::default() && own.rmse <= SAME * best.rmse)
            .unwrap_or(best))
    }

    /// Says which choices were considered and which one was chosen, and shows the command line.
    fn words(&self, chosen: &Estimate, why: &str, scene: &Path) -> String {
        let mut text = format!("  {:<9}{:>8}{:>12}{:>12}\n", "accuracy", "samples", "error", "time");
        let mut shown: Vec<_> =
            self.estimates.iter().filter(|one| self.is_best(one) || std::ptr::eq(*one, chosen)).collect();
        shown.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        for estimate in shown {
            let mark = if std::ptr::eq(estimate, chosen) { '>' } else { ' ' };
            let name = estimate.accuracy.option().name;
            let (error, time) = (format!("{:.2e}", estimate.rmse), format!("{:.3} s", self.time(estimate)));
            let _ = writeln!(text, "{mark} {name:<9}{:>8}{error:>12}{time:>12}", estimate.samples);
        }
        let how = match chosen.accuracy {
            Accuracy::Classic => "--method classic".to_owned(),
            accuracy => format!("--accuracy {}", accuracy.option().name),
        };
        let _ = write!(
            text,
            "\nThe marked choice is {why}. The others have less error and take longer, or take less time and have more \
             error. All were measured on a part of the image.\n\n\
             {} render {} {how} --samples {}\n",
            program::name(),
            scene.display(),
            chosen.samples
        );
        text
    }

    /// Tells whether no other choice is as fast and as accurate, and also clearly better in one of the two or the
    /// default.
    fn is_best(&self, one: &Estimate) -> bool {
        let is_default = |own: &Estimate| own.accuracy == Accuracy::default();
        !self.estimates.iter().any(|other| {
            let (time, error) = (other.seconds / one.seconds, other.rmse / one.rmse);
            let is_better = time <= 1.0 && error <= SAME && (time * SAME < 1.0 || error * SAME < 1.0);
            let is_equal = time <= SAME && error <= SAME;
            is_better || (is_equal && is_default(other) && !is_default(one))
        })
    }
}
