//! `--stats`: statistics of a render: rays, tests, time and memory.

use crate::process::memory;
use serde::Serialize;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tabray_core::render::flaws::{BudgetCuts, Flaws, UndecidedPixels};
use tabray_core::render::observer::RayKind;
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::{Proofs, RayStats, TestCounts};
use tabray_core::scene::model::Model;
use tabray_core::text::{json, short, visible_lines};
use tabray_core::world::certify::Doubt;
use tabray_tools::unchecked;

#[derive(clap::Args)]
#[group(id = "statistics")]
#[command(next_help_heading = "Looking inside")]
pub struct Args {
    /// Print statistics of the render to standard error, as a table or as JSON: rays by kind, pixels that were not
    /// finished or could not be decided, tests by entity type, the time of each stage and the peak memory
    #[arg(long, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "table")]
    stats: Option<Format>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// For people
    Table,
    /// For programs: one JSON object on one line
    Json,
}

/// The statistics of a render.
#[derive(Default)]
pub struct Stats {
    pub tally: Sum,
    /// The time to read and parse the scene's text.
    pub reading: Duration,
    /// The time to make the model of the parsed entities, and the BVH if there is one.
    pub building: Duration,
    /// The time to trace rays.
    pub rendering: Cell<Duration>,
    /// The time to write the image's file.
    pub writing: Duration,
}

impl Args {
    /// Tells whether anything is to be counted.
    pub fn wants_any(&self) -> bool {
        self.stats.is_some()
    }

    /// Prints the statistics.
    pub fn print(&self, stats: &Stats, model: &Model) {
        let text = match self.stats {
            None => return,
            Some(Format::Table) => visible_lines(&stats.table(model)).into_owned(),
            Some(Format::Json) => json(&stats.counts(model)) + "\n",
        };
        // If standard error is closed, no one can be told.
        let _ = io::stderr().write_all(text.as_bytes());
    }
}

/// The counts of all parts of an image, from all threads.
#[derive(Default)]
pub struct Sum(Mutex<RayStats>);

impl Sum {
    fn get(&self) -> MutexGuard<'_, RayStats> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the pixels that are not as they should be.
    pub fn flaws(&self) -> Flaws {
        self.get().flaws.clone()
    }

    /// Returns the noise of the pixels, where it is known.
    pub fn noise(&self) -> Option<f64> {
        self.get().flaws.noise.rms()
    }

    /// Returns the proven bounds of pixels' colours.
    pub fn proofs(&self) -> Proofs {
        self.get().proofs
    }

    /// Adds what is wrong with the pixels of a part, of which nothing else is counted.
    pub fn add_flaws(&self, part: &Flaws) {
        self.get().flaws.add(part);
    }

    /// Adds the counts of a part.
    pub fn add(&self, part: &RayStats) {
        self.get().add(part);
    }
}

impl Stats {
    /// Runs `render`, and adds the time that it takes.
    pub fn timed(&self, render: impl FnOnce()) {
        let start = Instant::now();
        render();
        self.rendering.set(self.rendering.get() + start.elapsed());
    }

    fn seconds(&self) -> Seconds {
        let [building, reading, rendering, writing] =
            [self.building, self.reading, self.rendering.get(), self.writing].map(|time| time.as_secs_f64());
        Seconds { building, reading, rendering, writing }
    }

    fn table(&self, model: &Model) -> String {
        let tally = self.tally.get();
        let mut out = format!("{:<12} {:>14}\n", "rays", "cast");
        for kind in RayKind::ALL {
            if kind == RayKind::Scattered && tally.rays(kind) == 0 {
                continue;
            }
            let _ = writeln!(out, "{kind:<12} {:>14}", tally.rays(kind));
        }
        if let Some(mean) = mean_samples(&tally) {
            let _ = writeln!(out, "\n{:<12} {:>14}", "samples", "pixels");
            for (samples, pixels) in tally.sampled() {
                let _ = writeln!(out, "{samples:<12} {pixels:>14}");
            }
            let _ = writeln!(out, "{:<12} {mean:>14.2}", "mean");
        }
        if tally.proofs.pixels() > 0 {
            let Proofs { certified, open, most, footprints, .. } = tally.proofs;
            let _ = writeln!(out, "\n{:<12} {:>14} {:>14} {:>14}", "proven", "pixels", "levels", "mean");
            let _ = writeln!(out, "{:<12} {certified:>14}", "certain");
            let (most, mean) = (short(255.0 * most), short(255.0 * tally.proofs.mean()));
            let _ = writeln!(out, "{:<12} {open:>14} {most:>14} {mean:>14}", "open, within");
            let _ = writeln!(out, "{:<12} {footprints:>14}", "footprints");
        }
        let BudgetCuts { pixels, most } = tally.flaws.cuts;
        let _ = writeln!(out, "\n{:<12} {:>14} {:>14}", "not finished", "pixels", "levels");
        let _ = writeln!(out, "{:<12} {pixels:>14} {:>14}", "at most", short(255.0 * most));
        let undecided = undecided(&tally, model);
        if !undecided.is_empty() {
            let _ = writeln!(out, "\n{:<12} {:>14}", "undecided", "pixels");
        }
        for Undecided { object, pixels, reason, .. } in undecided {
            let _ = writeln!(out, "{object:<12} {pixels:>14}  {reason}");
        }
        let unchecked = unchecked::of(&Plan::new(model));
        if !unchecked.is_empty() {
            out += "\n";
        }
        for one in unchecked {
            let _ = writeln!(out, "{one}");
        }
        let _ = writeln!(
            out,
            "\n{:<12} {:>14} {:>14} {:>14} {:>14}",
            "tests", "objects", "tested", "culled", "of all rays"
        );
        for (name, tests) in tally.tests(model) {
            let percent = 100.0 * tests.tested as f64 / (tally.all_rays() * tests.objects) as f64;
            let (objects, tested, culled) = (tests.objects, tests.tested, tests.culled);
            let _ = writeln!(out, "{name:<12} {objects:>14} {tested:>14} {culled:>14} {percent:>12.1} %");
        }
        let _ = writeln!(out, "\n{:<12} {:>14}", "stages", "seconds");
        let Seconds { building, reading, rendering, writing } = self.seconds();
        for (stage, seconds) in
            [("reading", reading), ("building", building), ("rendering", rendering), ("writing", writing)]
        {
            let _ = writeln!(out, "{stage:<12} {seconds:>14.4}");
        }
        if let Some(bytes) = memory::peak() {
            let _ = writeln!(out, "\n{:<12} {:>10.1} MiB", "peak memory", bytes as f64 / f64::from(1 << 20));
        }
        out
    }

    fn counts<'m>(&self, model: &'m Model) -> Counts<'m> {
        let tally = self.tally.get();
        Counts {
            cut: Cut { levels: 255.0 * tally.flaws.cuts.most, pixels: tally.flaws.cuts.pixels },
            peak_memory: memory::peak(),
            proven: (tally.proofs.pixels() > 0).then(|| Proven {
                certain: tally.proofs.certified,
                footprints: tally.proofs.footprints,
                levels: 255.0 * tally.proofs.most,
                mean_levels: 255.0 * tally.proofs.mean(),
                open: tally.proofs.open,
            }),
            rays: Rays {
                primary: tally.rays(RayKind::Primary),
                reflected: tally.rays(RayKind::Reflected),
                scattered: Some(tally.rays(RayKind::Scattered)).filter(|rays| *rays != 0),
                shadow: tally.rays(RayKind::Shadow),
                transmitted: tally.rays(RayKind::Transmitted),
            },
            samples: mean_samples(&tally).map(|mean| Samples { mean, pixels: tally.sampled().collect() }),
            seconds: self.seconds(),
            tests: tally.tests(model),
            unchecked: unchecked::of(&Plan::new(model)).iter().map(ToString::to_string).collect(),
            undecided: undecided(&tally, model),
        }
    }
}

/// Lists the pixels whose first hit could not be decided, by object and reason.
fn undecided<'m>(tally: &RayStats, model: &'m Model) -> Vec<Undecided<'m>> {
    let of = |((object, doubt), pixels): (&(usize, Doubt), &UndecidedPixels)| Undecided {
        at: pixels.at.to_array(),
        object: model.objects[*object].args.name(),
        pixels: pixels.count,
        reason: doubt.to_string(),
    };
    tally.flaws.undecided.0.iter().map(of).collect()
}

/// The statistics of a render, for other programs.
#[derive(Serialize)]
struct Counts<'m> {
    /// The pixels that reached the limit on their number of rays.
    cut: Cut,
    /// The most memory that the program used at one time, in bytes; left out where the system does not report it.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_memory: Option<u64>,
    /// What is proven of pixels' colours; left out without `--certain`.
    #[serde(skip_serializing_if = "Option::is_none")]
    proven: Option<Proven>,
    /// The numbers of rays that were traced.
    rays: Rays,
    /// The numbers of samples that pixels took; left out where all take the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    samples: Option<Samples>,
    /// The time of each stage.
    seconds: Seconds,
    /// The outcomes of the tests, by entity type.
    tests: BTreeMap<&'static str, TestCounts>,
    /// What is not checked of the hits, one sentence for each entity type without an equation; left out where there is none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unchecked: Vec<String>,
    /// The pixels whose first hit could not be decided, by object and reason; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    undecided: Vec<Undecided<'m>>,
}

/// Pixels whose first hit could not be decided.
#[derive(Serialize)]
struct Undecided<'m> {
    /// Where one of their rays may hit the object.
    at: [f64; 3],
    /// The name of the object that may be hit first.
    object: &'m str,
    /// The number of pixels.
    pixels: u64,
    /// Why, phrased to follow the name.
    reason: String,
}

/// The numbers of rays that were traced.
#[derive(Serialize)]
struct Rays {
    /// Primary rays: pixels times samples; where pixels differ in their samples, also those around the tiles.
    primary: u64,
    /// Reflected rays.
    reflected: u64,
    /// Rays from matt surfaces, where light bounces.
    #[serde(skip_serializing_if = "Option::is_none")]
    scattered: Option<u64>,
    /// Shadow rays, from points that face the light; in a scene with glass, a new one from behind each pane.
    shadow: u64,
    /// Rays through glass.
    transmitted: u64,
}

/// What is proven of pixels' colours.
#[derive(Serialize)]
struct Proven {
    /// The number of pixels that are certain to be within the limit.
    certain: u64,
    /// The number of footprints that were examined.
    footprints: u64,
    /// The maximum error of the other pixels, in levels of a channel, from 0 to 255.
    levels: f64,
    /// The mean of the bounds of the other pixels' errors, in levels.
    mean_levels: f64,
    /// The number of the other pixels.
    open: u64,
}

/// The numbers of samples that pixels took.
#[derive(Serialize)]
struct Samples {
    /// The mean number per pixel.
    mean: f64,
    /// The number of pixels that took each number of samples.
    pixels: BTreeMap<u32, u64>,
}

/// Returns the mean number of samples of a pixel, where pixels differ in it.
fn mean_samples(tally: &RayStats) -> Option<f64> {
    let pixels: u64 = tally.sampled().map(|(_, pixels)| pixels).sum();
    let samples: u64 = tally.sampled().map(|(samples, pixels)| u64::from(samples) * pixels).sum();
    (pixels > 0).then(|| samples as f64 / pixels as f64)
}

/// The time of each stage, in seconds.
#[derive(Serialize)]
struct Seconds {
    /// Making the model of the parsed entities: checks, constructors, textures, and the BVH if there is one.
    building: f64,
    /// Reading and parsing the scene's text.
    reading: f64,
    /// Tracing rays, on all threads.
    rendering: f64,
    /// Writing the file.
    writing: f64,
}

/// Pixels that reached the limit on their number of rays.
#[derive(Serialize)]
struct Cut {
    /// The maximum amount of light missing from one pixel, in levels of a channel, from 0 to 255; null if it is
    /// unbounded.
    levels: f64,
    /// The number of these pixels.
    pixels: u64,
}
