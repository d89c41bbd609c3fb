//! `tabray judge`: judges the answers of another tracer.

use super::files::{name, open, refuse, refuse_two_on_standard_input, tell_of_bad};
use super::model;
use crate::hits::columns;
use crate::hits::judge::{self, Finding, Judged, Report};
use crate::hits::theirs::TheirReader;
use glam::DVec3;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use tabray_cli::files::output::{self, Output, format_by_name};
use tabray_cli::options::{set, threads};
use tabray_cli::process::failure::{Failure, print};
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::{Command, Group, Run};
use tabray_core::query::{Answer, Query, Verdict};
use tabray_core::render::{Plan, Renderer};
use tabray_core::scene::model::Model;
use tabray_core::text::{self, count, shortest};
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::camera::Projected;
use tabray_lang::reader::UNUSED_CAMERA;
use tabray_lang::registry::Registry;

/// Judge the answers of another ray tracer
///
/// Reads rays with the answers of the other ray tracer: as CSV with the columns ox, oy, oz, dx, dy, dz and t, and
/// perhaps hit, object, face and t_max, or as JSON lines with origin, direction and the same names. A t that is
/// missing, negative or not finite means a miss. An object is a name or an index, and a face is an index. Values that
/// are left out are not judged.
///
/// The right answers are proven, as by `hits`. An answer is wrong if it misses the first surface, invents one, hits a
/// later one, has a t at which no surface lies, or names another object or face. Rays that the proof does not decide
/// are not judged. The exit status is 1 if any answer is wrong.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scene, or the file of a mesh
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// The answers; by default, or with `-`, they are read from standard input
    #[arg(value_name = "ANSWERS")]
    answers: Option<PathBuf>,
    #[command(flatten)]
    set: set::Args,
    /// The error of t that is accepted, as a fraction of t
    #[arg(long, value_name = "PART", default_value = "1e-5", value_parser = part)]
    tolerance: f64,
    /// Write the scene's image to this .png or .ppm file, dark, with a dot where each wrong answer lies: red where a surface
    /// was missed, yellow where one was invented, blue for a later one, white for other faults
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print the numbers and the worst answers as JSON
    #[arg(long)]
    json: bool,
    /// Leave out lines that are no answers, and count them
    #[arg(long)]
    skip_bad: bool,
    #[command(flatten)]
    threads: threads::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray judge ball.ray answers.csv
  tabray judge part.stl answers.csv --tolerance 1e-12
  tabray judge ball.ray answers.csv -o wrong.png";

fn part(text: &str) -> Result<f64, String> {
    let part = text.parse().ok().filter(|part: &f64| (0.0..1.0).contains(part));
    part.ok_or_else(|| "give a number from 0 to 1".to_owned())
}

/// The place of a wrong answer.
type Dot = (DVec3, Finding);

inventory::submit! {
    Command::new("judge", Group::Rays, &Run(run)).placed(1, 12)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let path = args.answers.as_deref().unwrap_or(Path::new("-"));
    refuse_two_on_standard_input(&args.scene, path, "answers")?;
    let model = model::load(registry, &args.scene, &args.set, Some(Accuracy::Exact))?;
    let picture = args.output.as_deref().map(|picture| {
        let format = format_by_name(picture, "end it in .png or .ppm")?;
        if model.camera.args.name() == UNUSED_CAMERA {
            let help = "give it a `look_at`; `tabray new scene --mesh FILE` makes a scene of a mesh";
            return Err(Failure::usage("the scene has no camera to show it").help(help));
        }
        output::refuse_source(picture, &args.scene, &model)?;
        output::refuse_input(picture, path, "the answers", "the image")?;
        Ok((picture, format, Output::open(picture)?))
    });
    let picture = picture.transpose()?;
    interrupt::catch(InterruptAction::Exit("the answers were not judged"))?;
    let answers = TheirReader::new(open(path, "answers")?);
    let mut answers = answers.map_err(|bad| Failure::usage(format!("`{}`, {bad}", name(path))))?;
    let (renderer, query) = (args.threads.renderer()?, Query::new(&model));
    let mut dots: Vec<Dot> = Vec::new();
    let mut each = |judged: &Judged| {
        if picture.is_some() {
            dots.extend(place(judged).map(|at| (at, judged.finding)));
        }
    };
    let report = judge::read(&renderer, &query, args.tolerance, &mut answers, args.skip_bad, &mut each);
    let report = report.map_err(|bad| refuse(path, &bad, "lines"))?;
    print(&match args.json {
        true => text::json_in_lines(&Numbers::of(&report, &model, &args)),
        false => message(&report, &model, &args),
    })?;
    if let Some((path, format, output)) = picture {
        let bytes = drawn(&renderer, &model, &dots);
        output::write_image(path, output, |out| format.write(out, model.camera.value.pixels, [Ok(bytes)]))?;
    }
    tell_of_bad(report.bad, "answer");
    match report.is_wrong() {
        true => Err(Failure::Failed(format!("{} wrong", are_wrong(&report)))),
        false => Ok(()),
    }
}

fn are_wrong(report: &Report) -> String {
    let kinds = Finding::ALL.iter().zip(&report.counts).filter(|(finding, _)| finding.is_wrong());
    let wrong: u64 = kinds.map(|(_, count)| count).sum();
    format!("{} {}", count(wrong as usize, "answer"), if wrong == 1 { "is" } else { "are" })
}

/// Returns where a wrong answer lies: where they hit, or else where a surface is.
fn place(judged: &Judged) -> Option<DVec3> {
    let [a, b, c, d, e, f] = judged.theirs.numbers;
    let t = judged.theirs.t.unwrap_or(judged.ours.t);
    t.is_finite().then(|| DVec3::new(a, b, c) + t * DVec3::new(d, e, f))
}

/// Renders the scene, dark and grey, with dots of 3 x 3 pixels.
fn drawn(renderer: &Renderer, model: &Model, dots: &[Dot]) -> Vec<u8> {
    let mut bytes = renderer.picture(&Plan::new(model));
    for pixel in bytes.chunks_exact_mut(3) {
        let grey = pixel.iter().map(|byte| u32::from(*byte)).sum::<u32>() / 6;
        pixel.fill(grey as u8);
    }
    let camera = &model.camera.value;
    let [width, height] = camera.pixels;
    for (at, finding) in dots {
        let Projected::At(at) = camera.project(*at) else { continue };
        let colour = match finding {
            Finding::Missed => [255, 40, 40],
            Finding::Invented => [255, 220, 0],
            Finding::Later => [80, 120, 255],
            _ => [255; 3],
        };
        let (x, y) = (at.x.round() as i64, height as i64 - 1 - at.y.round() as i64);
        for (x, y) in (-1..=1).flat_map(|up| (-1..=1).map(move |right| (x + right, y + up))) {
            if (0..width as i64).contains(&x) && (0..height as i64).contains(&y) {
                let index = 3 * (y as usize * width + x as usize);
                bytes[index..index + 3].copy_from_slice(&colour);
            }
        }
    }
    bytes
}

/// Returns a line that repeats a question.
fn command(judged: &Judged, scene: &Path) -> String {
    let numbers = judged.theirs.numbers.map(shortest).join(" ");
    let end = judged.theirs.row.t_max.map_or(String::new(), |end| format!(" {}", shortest(end)));
    format!("echo '{numbers}{end}' | tabray hits {}", name(scene))
}

/// Returns the findings and the proofs in words.
fn words(judged: &Judged, model: &Model) -> [String; 2] {
    let theirs = match (judged.theirs.hits, judged.theirs.t) {
        (false, _) => "miss".to_owned(),
        (true, None) => "hit".to_owned(),
        (true, Some(t)) => format!("t {}", shortest(t)),
    };
    let Answer { verdict, object, t, .. } = judged.ours;
    let of = object.map_or(String::new(), |object| format!(" of `{}`", model.objects[object].args.name()));
    let ours = match verdict {
        Verdict::Hit => format!("t {}{of}", shortest(t)),
        _ => format!("{}{of}", columns::verdict(verdict).0),
    };
    [theirs, ours]
}

fn message(report: &Report, model: &Model, args: &Args) -> String {
    let mut text = String::new();
    let all = count(report.all() as usize, "answer");
    let _ = writeln!(text, "{all} judged, to a tolerance of {} of t", shortest(args.tolerance));
    for (finding, count) in Finding::ALL.iter().zip(&report.counts).rev().filter(|(_, count)| **count > 0) {
        let _ = writeln!(text, "{count:>10}  {}", finding.meaning());
    }
    let [double, single] = &report.errors;
    if let (Some(half), Some(most)) = (double.within(0.5), double.within(0.99)) {
        let _ = writeln!(
            text,
            "error of t where right, in units in the last place of f64: half at most {}, 99 % at most {}, the largest {}; \
             of f32 {}",
            text::short(half),
            text::short(most),
            text::short(double.most),
            text::short(single.most)
        );
    }
    for judged in &report.worst {
        let [theirs, ours] = words(judged, model);
        let _ = writeln!(
            text,
            "answer {}: {}: {theirs}, where right is {ours}\n  {}",
            judged.number,
            judged.finding.meaning(),
            command(judged, &args.scene)
        );
    }
    text
}

/// What is printed as JSON.
#[derive(Serialize)]
struct Numbers {
    tolerance: f64,
    answers: u64,
    missed: u64,
    invented: u64,
    later: u64,
    inaccurate: u64,
    other_object: u64,
    other_face: u64,
    open: u64,
    right: u64,
    /// The largest error of t of right answers, in units in the last place.
    largest_error_ulp: f64,
    largest_error_ulp_of_f32: f64,
    worst: Vec<Wrong>,
}

/// A wrong answer, for JSON.
#[derive(Serialize)]
struct Wrong {
    number: u64,
    finding: Finding,
    theirs: String,
    right: String,
    repeat: String,
}

impl Numbers {
    fn of(report: &Report, model: &Model, args: &Args) -> Self {
        let [missed, invented, later, inaccurate, other_object, other_face, open, right] = report.counts;
        let wrong = |judged: &Judged| {
            let ([theirs, right], repeat) = (words(judged, model), command(judged, &args.scene));
            Wrong { number: judged.number, finding: judged.finding, theirs, right, repeat }
        };
        let [double, single] = &report.errors;
        Self {
            tolerance: args.tolerance,
            answers: report.all(),
            missed,
            invented,
            later,
            inaccurate,
            other_object,
            other_face,
            open,
            right,
            largest_error_ulp: double.most,
            largest_error_ulp_of_f32: single.most,
            worst: report.worst.iter().map(wrong).collect(),
        }
    }
}
