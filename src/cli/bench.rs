//! `tabray bench`: how fast scenes are traced on one core.

use super::failure::{Failure, print};
use super::{cpu, input, method};
use crate::scene::model::Model;
use crate::scene::reader;
use crate::scene::registry::Registry;
use crate::simd::cpu::Cpu;
use crate::tools::bench::{Cost, Speed, scenes};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Duration;

/// Measure how fast scenes are traced on one core
///
/// For each scene it prints the rays per second by kind, the time of a test by entity, and how near the frame comes to
/// the bare arithmetic of its tests. Times are the core's own for the work, the least of several rounds.
#[derive(clap::Args)]
pub struct Args {
    /// The scenes; `-` reads one from standard input; by default four that are built in
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    cpu: cpu::Args,
    /// For how long to measure each number, in seconds
    #[arg(long, value_name = "S", default_value = "0.3", value_parser = seconds, allow_negative_numbers = true)]
    seconds: Duration,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    method: method::Args,
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds
        .filter(|seconds| *seconds <= Duration::from_secs(3600))
        .ok_or_else(|| "seconds are from 0 to 3600".to_owned())
}

pub fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let cpu = args.cpu.cpu()?;
    let accuracy = args.method.accuracy()?;
    let mut models = Vec::new();
    for path in &args.scenes {
        models.push((path.display().to_string(), input::load(registry, path, accuracy)?));
    }
    if args.scenes.is_empty() {
        for (name, scene) in scenes::all() {
            let built = reader::build(registry, scene).map_err(Failure::Scene)?;
            models.push((name.to_owned(), built.model));
        }
    }
    let mut values = Vec::new();
    for (name, model) in models {
        let about = About::of(name, &model, cpu);
        let speed = Speed::measure(model, cpu, args.seconds)?;
        if args.json {
            values.push(about.json(&speed));
        } else {
            print(&about.table(&speed))?;
        }
    }
    if args.json {
        print(&format!("{:#}\n", Value::from(values)))?;
    }
    Ok(())
}

/// What was measured.
struct About {
    name: String,
    size: [usize; 2],
    objects: usize,
    lights: usize,
    cpu: Cpu,
}

impl About {
    fn of(name: String, model: &Model, cpu: Cpu) -> Self {
        let size = model.camera.value.pixels;
        Self { name, size, objects: model.objects.len(), lights: model.lights.len(), cpu }
    }

    fn table(&self, speed: &Speed) -> String {
        let Self { name, size: [width, height], objects, lights, cpu } = self;
        let mut text = format!(
            "{name}: {width} x {height} pixels, {}, {}, {cpu}, one core\n\n",
            count(*objects, "object"),
            count(*lights, "light"),
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
            ("from the viewer", &speed.primary),
            ("to lights", &speed.shadow),
            ("mirrors and glass", &speed.onward),
            ("all", &speed.frame),
        ] {
            let rate = number(cost.rate().map(|rate| rate / 1e6), 1);
            let time = number((cost.rays > 0).then_some(1e3 * cost.seconds), 2);
            line([kind, &cost.rays.to_string(), &time, &rate, "", ""]);
        }
        line([""; 6]);
        line(["ns per ray", "tests", "meet", "block", "settle", "bare"]);
        for tests in &speed.tests {
            let [meet, block, settle, bare] =
                [tests.times.meet, tests.times.block, tests.times.settle, tests.bare]
                    .map(|time| number(time, 2));
            line([tests.entity, &tests.number.to_string(), &meet, &block, &settle, &bare]);
        }
        match (speed.bare, speed.share()) {
            (Some(bare), Some(share)) => {
                let _ = writeln!(
                    text,
                    "\n{:.0} % of the ceiling: as bare arithmetic the frame's tests take {:.2} ms\n",
                    100.0 * share,
                    1e3 * bare,
                );
            }
            _ => text += "\nno ceiling: not every entity here has a formula of textbooks\n\n",
        }
        text
    }

    fn json(&self, speed: &Speed) -> Value {
        let cost = |cost: &Cost| json!({ "rays": cost.rays, "seconds": cost.seconds, "rays_per_second": cost.rate() });
        let tests = speed.tests.iter().map(|tests| {
            json!({
                "entity": tests.entity,
                "tests": tests.number,
                "meet_ns": tests.times.meet,
                "block_ns": tests.times.block,
                "settle_ns": tests.times.settle,
                "bare_ns": tests.bare,
            })
        });
        json!({
            "scene": self.name,
            "pixels": self.size,
            "objects": self.objects,
            "lights": self.lights,
            "cpu": self.cpu.to_string(),
            "rays": {
                "primary": cost(&speed.primary),
                "shadow": cost(&speed.shadow),
                "onward": cost(&speed.onward),
                "all": cost(&speed.frame),
            },
            "tests": tests.collect::<Vec<_>>(),
            "bare_seconds": speed.bare,
            "share_of_ceiling": speed.share(),
        })
    }
}

fn count(number: usize, of: &str) -> String {
    format!("{number} {of}{}", if number == 1 { "" } else { "s" })
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
