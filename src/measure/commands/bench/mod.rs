//! `tabray bench`: how fast scenes are traced on one core.

mod certain;
mod sampling;

use crate::bench::{Cost, Speed, TestTimes, scenes};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Duration;
use tabray_cli::files::{input, output};
use tabray_cli::options::{cpu, method, set};
use tabray_cli::process::failure::{Failure, print};
use tabray_cli::{Command, Group, Run};
use tabray_core::scene::model::Model;
use tabray_core::simd::cpu::Cpu;
use tabray_core::text;
use tabray_lang::reader;
use tabray_lang::registry::Registry;

/// Measure how fast scenes are traced on one core
///
/// For each scene, prints the rays per second of each kind, the time of a test of each entity type, and how close the
/// frame comes to the bare arithmetic of its tests. Times are CPU times of one core, the minimum of several rounds.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scenes; `-` reads one from standard input; by default four built-in ones
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    set: set::Args,
    #[command(flatten)]
    cpu: cpu::Args,
    /// Measuring time for each number, in seconds
    #[arg(long, value_name = "S", default_value = "0.3", value_parser = seconds, allow_negative_numbers = true)]
    seconds: Duration,
    /// Compare numbers of samples per pixel instead, and print a table in Markdown
    #[arg(long, value_name = "QUESTION", conflicts_with_all = ["json", "seconds"])]
    sampling: Option<sampling::Question>,
    /// The width and height of the images of --sampling in pixels; by default those of the scenes' cameras
    #[arg(long, value_name = "WxH", value_parser = size, requires = "sampling")]
    size: Option<[usize; 2]>,
    /// Write a chart of --sampling, an .svg or a .png file
    #[arg(short, long, value_name = "FILE", requires = "sampling")]
    output: Option<PathBuf>,
    /// Keep the measurements of --sampling in this directory, and measure only what is missing there
    #[arg(long, value_name = "DIR", requires = "sampling")]
    keep: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    method: method::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray bench
  tabray bench ball.ray --seconds 1 --json";

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds
        .filter(|seconds| *seconds <= Duration::from_secs(3600))
        .ok_or_else(|| "must be from 0 to 3600 seconds".to_owned())
}

fn size(text: &str) -> Result<[usize; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| (2..=4096).contains(side));
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "give the width and height as `160x120`, each from 2 to 4096".to_owned())
}

inventory::submit! {
    Command::new("bench", Group::Measuring, &Run(run)).placed(3, 21)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let cpu = args.cpu.cpu()?;
    let accuracy = args.method.accuracy()?;
    let mut models = Vec::new();
    for path in &args.scenes {
        models.push((text::shown(path), input::load(registry, path, &args.set, accuracy)?));
    }
    if args.scenes.is_empty() {
        for (name, scene) in scenes::all() {
            let built = reader::build(registry, scene).map_err(Failure::Scene)?;
            models.push((name.to_owned(), built.model));
        }
    }
    if args.sampling == Some(sampling::Question::Certain) {
        return certain::run(models, args.size);
    }
    if let Some(question) = args.sampling {
        if let Some(file) = &args.output {
            for (scene, (_, model)) in args.scenes.iter().zip(&models) {
                output::refuse_source(file, scene, model)?;
            }
        }
        return sampling::run(question, models, args.size, args.output.as_deref(), args.keep.as_deref());
    }
    let mut measured = Vec::new();
    for (name, model) in models {
        let about = SceneSummary::of(name, &model, cpu);
        let speed = Speed::measure(model, cpu, args.seconds)?;
        if args.json {
            measured.push(about.measured(speed));
        } else {
            print(&about.table(&speed))?;
        }
    }
    if args.json {
        print(&text::json_in_lines(&measured))?;
    }
    Ok(())
}

/// The measured scene and its counts, for the heading.
struct SceneSummary {
    name: String,
    size: [usize; 2],
    objects: usize,
    lights: usize,
    cpu: Cpu,
}

impl SceneSummary {
    fn of(name: String, model: &Model, cpu: Cpu) -> Self {
        let size = model.camera.value.pixels;
        Self { name, size, objects: model.objects.len(), lights: model.lights.len(), cpu }
    }

    fn table(&self, speed: &Speed) -> String {
        let Self { name, size: [width, height], objects, lights, cpu } = self;
        let mut text = format!(
            "{name}: {width} x {height} pixels, {}, {}, {cpu}, one core\n\n",
            text::count(*objects, "object"),
            text::count(*lights, "light"),
        );
        let mut line = |cells: [&str; 6]| {
            let [first, cells @ ..] = cells;
            let mut line = format!("{first:<20}");
            for cell in cells {
                let _ = write!(line, "{cell:>11}");
            }
            text += line.trim_end();
            text += "\n";
        };
        line(["rays", "number", "ms", "million/s", "", ""]);
        for (kind, cost) in [
            ("primary", &speed.primary),
            ("shadow", &speed.shadow),
            ("secondary", &speed.secondary),
            ("all", &speed.frame),
        ] {
            let rate = number(cost.rate().map(|rate| rate / 1e6), 1);
            let time = number((cost.rays > 0).then_some(1e3 * cost.seconds), 2);
            line([kind, &cost.rays.to_string(), &time, &rate, "", ""]);
        }
        line([""; 6]);
        line(["ns per ray", "tests", "closest", "occluded", "refine", "bare"]);
        for tests in &speed.tests {
            let [closest, occluded, refine, bare] =
                [tests.times.closest, tests.times.occluded, tests.times.refine, tests.bare]
                    .map(|time| number(time, 2));
            line([tests.entity, &tests.number.to_string(), &closest, &occluded, &refine, &bare]);
        }
        match (speed.bare, speed.share()) {
            (Some(bare), Some(share)) => {
                let _ = writeln!(
                    text,
                    "\n{:.0} % of the ceiling: in bare arithmetic the frame's tests take {:.2} ms\n",
                    100.0 * share,
                    1e3 * bare,
                );
            }
            _ => text += "\nno ceiling: not every entity type here has a textbook formula\n\n",
        }
        text
    }

    fn measured(self, speed: Speed) -> Measured {
        Measured {
            bare_seconds: speed.bare,
            cpu: self.cpu.to_string(),
            lights: self.lights,
            objects: self.objects,
            pixels: self.size,
            rays: Rays {
                all: Rate::of(&speed.frame),
                onward: Rate::of(&speed.secondary),
                primary: Rate::of(&speed.primary),
                shadow: Rate::of(&speed.shadow),
            },
            scene: self.name,
            share_of_ceiling: speed.share(),
            tests: speed.tests.iter().map(Times::of).collect(),
        }
    }
}

/// The measurements of a scene, for other programs. Times are CPU times of one core, the minimum of several rounds.
#[derive(Serialize)]
struct Measured {
    /// The time of the frame's tests as bare arithmetic, in seconds; null if there is no textbook formula for one of
    /// them.
    bare_seconds: Option<f64>,
    /// The level of CPU instructions that was used, as `--cpu` names it.
    cpu: String,
    /// The number of lights in the scene.
    lights: usize,
    /// The number of objects in the scene.
    objects: usize,
    /// The width and the height of the image in pixels.
    pixels: [usize; 2],
    /// The cost of rays, by kind.
    rays: Rays,
    /// The scene as the command line names it.
    scene: String,
    /// The fraction of the frame's time that its tests take as bare arithmetic; null where `bare_seconds` is.
    share_of_ceiling: Option<f64>,
    /// The tests of rays, by entity type.
    tests: Vec<Times>,
}

/// The cost of rays, by kind.
#[derive(Serialize)]
struct Rays {
    /// All rays, and the whole frame without writing a file.
    all: Rate,
    /// Reflected and transmitted rays, with the shadow rays from their hits, and what they add to the cost.
    onward: Rate,
    /// Primary rays, in the scene without lights, mirrors and glass.
    primary: Rate,
    /// Shadow rays of primary hits, and what lights add to the cost, shading included.
    shadow: Rate,
}

/// The number and the cost of rays of one kind.
#[derive(Serialize)]
struct Rate {
    /// The number of rays in a frame.
    rays: u64,
    /// The number of rays per second; null where there are none or their share of the time is too small to measure.
    rays_per_second: Option<f64>,
    /// The time for all rays, in seconds.
    seconds: f64,
}

impl Rate {
    fn of(cost: &Cost) -> Self {
        Self { rays: cost.rays, rays_per_second: cost.rate(), seconds: cost.seconds }
    }
}

/// The tests of rays against the objects of one type. Times are in nanoseconds per ray, and null where there was
/// nothing to time.
#[derive(Serialize)]
struct Times {
    /// The textbook formula.
    bare_ns: Option<f64>,
    /// The occlusion test of shadow rays.
    occluded_ns: Option<f64>,
    /// The entity type.
    entity: &'static str,
    /// The closest-hit test of primary rays.
    closest_ns: Option<f64>,
    /// The refinement of the hit's distance.
    refine_ns: Option<f64>,
    /// The number of tests in a frame, one for each ray and object.
    tests: u64,
}

impl Times {
    fn of(tests: &TestTimes) -> Self {
        Self {
            bare_ns: tests.bare,
            occluded_ns: tests.times.occluded,
            entity: tests.entity,
            closest_ns: tests.times.closest,
            refine_ns: tests.times.refine,
            tests: tests.number,
        }
    }
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
