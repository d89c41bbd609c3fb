//! `tabray hits`: answers what rays hit.

mod files;
pub mod hard;
pub mod judge;
mod model;

use crate::hits::answers::AnswerFormat;
use crate::hits::rays::{BadRay, RayFormat, RayReader};
use crate::hits::starts::StartReader;
use crate::hits::{self, Asked, Ended, Tally};
use files::{name, of_name, open, refuse, refuse_two_on_standard_input, tell_of_bad};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tabray_cli::files::output::{self, Output};
use tabray_cli::options::{method, set, threads};
use tabray_cli::process::failure::Failure;
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::process::progress::Progress;
use tabray_cli::{Command, Group, Run};
use tabray_core::query::Query;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::registry::Registry;

/// Answer what rays hit first, each with a proof
///
/// Reads rays, and writes an answer for each, in the same order: the object that the ray hits, t in lengths of the
/// ray's direction, with bounds that contain the real t, the distance in world units, the point, the normal, and u, v
/// and the face if the shape has them. The scene needs no camera, and may be a mesh file.
///
/// The proof is about the real ray and the scene's numbers as they are read; `tabray help verify` has more. `hit` and
/// `miss` are proven. `edge` is a ray through the edge of a surface, as far as 237 bits tell. `tie` is a ray that hits
/// several objects at once; the answer names the first in the scene. `undecided` is a ray for which 237 bits do not
/// decide, or whose shape has no equation; the answer names the object that the tracer finds.
///
/// Rays are lines of six numbers: the origin and the direction, which need not be a unit vector. A seventh number is the t at
/// which the ray ends. Rays may also be CSV with the columns ox, oy, oz, dx, dy, dz and t_max, JSON lines, or a NumPy array of
/// shape (n, 6) or (n, 7).
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scene, or a mesh file; `-` reads a scene from standard input
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// The rays; by default, or with `-`, they are read from standard input
    #[arg(value_name = "RAYS")]
    rays: Option<PathBuf>,
    #[command(flatten)]
    set: set::Args,
    /// The format of the rays; by default, their first bytes tell it
    #[arg(long, value_name = "FORM")]
    from: Option<RayFormat>,
    /// Ask about the rays through the middles of the pixels of the scene's camera, row by row from the top, with t in world
    /// units
    #[arg(long, conflicts_with_all = ["rays", "from", "skip_bad"])]
    from_camera: bool,
    /// Let each ray start at the hit of one of these answers of an earlier run for the same scene, line by line. A rounded
    /// point lies on either side of its surface, which a ray that leaves it does not hit there
    #[arg(long, value_name = "ANSWERS", conflicts_with = "from_camera")]
    leaving: Option<PathBuf>,
    /// Write the answers to this file; its ending, .jsonl, .csv or .npy, is their format
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The format of the answers on standard output
    #[arg(long, value_name = "FORM", default_value = "jsonl", conflicts_with = "output")]
    to: AnswerFormat,
    /// Prove nothing, and give what the tracer finds, many times faster
    #[arg(long)]
    fast: bool,
    /// Narrow the bounds of t to about a unit in its last place, in many times the time
    #[arg(long, conflicts_with = "fast")]
    tight: bool,
    /// Answer with all surfaces that a ray crosses, in their order, one record each. `ray` is the number of the ray,
    /// from 0, and `enters` tells whether it enters a closed shape there. The last record of a ray is a `miss`, or
    /// `undecided` from `t_low` on, for example where the ray touches a surface or passes through an edge
    #[arg(long, conflicts_with_all = ["fast", "any"])]
    all: bool,
    /// Say only whether the ray hits something, as for shadows, without naming the object
    #[arg(long)]
    any: bool,
    /// The t at which rays without a t_max of their own end
    #[arg(long, value_name = "T", value_parser = end)]
    t_max: Option<f64>,
    /// Leave out lines that are no rays, and count them
    #[arg(long)]
    skip_bad: bool,
    #[command(flatten)]
    method: method::Args,
    #[command(flatten)]
    threads: threads::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray hits ball.ray < rays.txt
  tabray hits part.stl rays.csv -o answers.csv
  tabray hits part.stl rays.csv --all
  tabray hits part.stl rays.npy -o answers.npy --fast
  tabray hits part.stl shadows.npy --leaving answers.npy
  tabray hits ball.ray --from-camera --to csv";

/// Reads the t at which rays end.
fn end(text: &str) -> Result<f64, String> {
    let end = text.parse().ok().filter(|end: &f64| *end > 0.0);
    end.ok_or_else(|| "give a positive number".to_owned())
}

inventory::submit! {
    Command::new("hits", Group::Rays, &Run(run)).placed(0, 11)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let format = match &args.output {
        None => args.to,
        Some(path) => of_name(path)?,
    };
    let rays = args.rays.as_deref().unwrap_or(Path::new("-"));
    if !args.from_camera {
        refuse_two_on_standard_input(&args.scene, rays, "rays")?;
        for other in [&args.scene, rays] {
            refuse_two_on_standard_input(other, args.leaving.as_deref().unwrap_or(Path::new("")), "answers")?;
        }
    }
    let accuracy = args.method.accuracy()?.or(Some(Accuracy::Exact));
    let model = model::load(registry, &args.scene, &args.set, accuracy)?;
    interrupt::catch(InterruptAction::Exit("the answers were not finished"))?;
    let mut reader = match args.from_camera {
        true => None,
        false => {
            let input = open(rays, "rays, six numbers a line,")?;
            let refused = |path: &Path, bad: BadRay| Failure::usage(format!("`{}`, {bad}", name(path)));
            let reader = RayReader::new(input, args.from).map_err(|bad| refused(rays, bad))?;
            Some(match &args.leaving {
                None => reader,
                Some(path) => {
                    let answers = StartReader::new(open(path, "the answers that rays leave")?);
                    reader.leaving(answers.map_err(|bad| refused(path, bad))?)
                }
            })
        }
    };
    let [width, height] = model.camera.value.pixels;
    let known = match &reader {
        None => Some((width * height) as u64),
        Some(reader) => reader.count().filter(|_| !args.skip_bad),
    };
    if format == AnswerFormat::Npy && (known.is_none() || args.all) {
        let what =
            "an array needs to know the number of its answers first, which only an array of rays gives";
        let help = match (args.skip_bad, args.all) {
            (_, true) => "write .jsonl or .csv, or leave out `--all`",
            (true, _) => "write .jsonl or .csv, or leave out `--skip-bad`",
            (false, _) => "write .jsonl or .csv, or give the rays as a .npy file",
        };
        return Err(Failure::usage(what).help(help));
    }
    let path = args.output.as_deref().unwrap_or(Path::new("-"));
    if args.output.is_some() {
        output::refuse_source_by(path, "the answers", &args.scene, &model)?;
        output::refuse_input(path, rays, "the rays", "the answers")?;
        if let Some(leaving) = &args.leaving {
            output::refuse_input(path, leaving, "the answers that rays leave", "the answers")?;
        }
    }
    let cannot = |error: &io::Error| Failure::cannot_write(path, error);
    let is_text = args.output.is_none() && format != AnswerFormat::Npy;
    let mut out = BufWriter::new(if is_text { Output::Standard } else { Output::open(path)? });
    let asked = Asked {
        fast: args.fast,
        tight: args.tight,
        all: args.all,
        any: args.any,
        t_max: args.t_max.unwrap_or(f64::INFINITY),
        skip_bad: args.skip_bad,
    };
    let renderer = args.threads.renderer()?;
    let query = Query::new(&model);
    let progress = known.map(|known| Progress::new(known as usize));
    let mut step = |done: usize| progress.iter().for_each(|progress| progress.advance(done));
    let answered =
        format.begin(known, args.all, &mut out).map_err(Ended::Unwritten).and_then(|()| match &mut reader {
            None => hits::of_camera(&renderer, &query, &asked, (&format, &mut out), &mut step)
                .map_err(Ended::Unwritten),
            Some(reader) => hits::read(&renderer, &query, &asked, reader, (&format, &mut out), &mut step),
        });
    if let Some(progress) = &progress {
        progress.end();
    }
    let Tally { bad, .. } = match answered {
        Ok(tally) => tally,
        // A reader that closes the pipe is no failure.
        Err(Ended::Unwritten(error)) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
        Err(Ended::Unwritten(error)) => return Err(cannot(&error)),
        Err(Ended::Bad(bad)) => {
            // What was answered before stays, where it goes to a reader.
            let _ = out.flush();
            return Err(refuse(rays, &bad, "rays"));
        }
    };
    let written = out.flush();
    output::finished(path, written, out)?;
    tell_of_bad(bad, "ray");
    Ok(())
}
