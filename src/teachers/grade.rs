//! `tabray grade`: compares a picture with what its scene shows, and says in what way it differs.

use crate::grading::{Finding, Grade};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use tabray_cli::files::input;
use tabray_cli::files::picture;
use tabray_cli::options::number::whole;
use tabray_cli::options::{method, scene, threads};
use tabray_cli::process::failure::{Failure, print, report};
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::{Command, Group, Run};
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_core::text::{self, count};
use tabray_lang::registry::Registry;
use tabray_tools::probe::{self, PixelExplained};
use tabray_tools::threads::renderer_with;

/// Name the mistakes in a picture that another program made of a scene
///
/// For exercises: renders the scene as it is, and then with the usual mistakes: flipped, shifted by up to three pixels,
/// with another curve of levels, without each light, without the objects in a light's way, without highlights, without
/// the visible object. A pixel of the picture counts under a mistake if it has the colour of that image, to one level.
/// Then explains one pixel, like `probe`: the first, in rows from the top, of the most frequent mistake.
#[derive(clap::Args)]
#[command(after_help = EXIT_STATUS, after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// The picture: a PPM or PNG file, of the size in the scene's camera
    #[arg(value_name = "PICTURE")]
    picture: PathBuf,
    /// Ignore differences of up to this many levels in each channel
    #[arg(long, value_name = "LEVELS", default_value = "0", value_parser = whole::<u8>(0..=255))]
    tolerance: u8,
    /// Print the findings and the explanation as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    method: method::Args,
    #[command(flatten)]
    threads: threads::Args,
}

macro_rules! exit_status {
    () => {
        "\
Exit status:
    0  the picture is what the scene shows
    1  it differs
    2  trouble: the scene or the picture could not be read, or their sizes differ"
    };
}

const EXIT_STATUS: &str = exit_status!();

const EXAMPLES: &str = concat!(
    exit_status!(),
    "\n\nExamples:
  tabray grade ball.ray handed-in.ppm
  tabray grade ball.ray handed-in.ppm --tolerance 1
  tabray grade ball.ray handed-in.png --json"
);

inventory::submit! {
    Command::new("grade", Group::Inside, &Run(run)).placed(3, 18)
}

/// Grades a picture. The exit status distinguishes errors of any kind from a difference, as with `diff`.
fn run(registry: &Registry, args: Args) -> ExitCode {
    match graded(registry, &args) {
        Ok(is_same) => ExitCode::from(u8::from(!is_same)),
        Err(failure) => {
            report(&failure);
            ExitCode::from(2)
        }
    }
}

/// Tells whether the picture is what the scene shows.
fn graded(registry: &Registry, args: &Args) -> Result<bool, Failure> {
    let accuracy = args.method.accuracy()?;
    let source = args.scene.read()?;
    let model = input::print_warnings(source.load(registry, accuracy))?.model;
    let picture = picture::read(&args.picture)?;
    let [width, height] = model.camera.value.pixels;
    let size = picture.dimensions();
    if (size.0 as usize, size.1 as usize) != (width, height) {
        return Err(Failure::usage(format!(
            "`{}` has {} x {} pixels, and the image of the scene {width} x {height}",
            text::shown(&args.picture),
            size.0,
            size.1
        ))
        .help(format!(
            "if the picture is meant to be smaller, add `--set \"{}.pixeldim={} {}\"`",
            model.camera.args.name(),
            size.0,
            size.1
        )));
    }
    interrupt::catch(InterruptAction::Exit("the picture was not graded"))?;
    let mut make = || match source.load(registry, accuracy) {
        Ok(loaded) => Ok(loaded.model),
        Err(report) => Err(Failure::Scene(report)),
    };
    let grade = Grade::new(&args.threads.renderer()?, &model, &mut make, &picture, args.tolerance)?;
    let plan = Plan::new(&model);
    let look = grade.findings.first().map(|finding| finding.first);
    let theirs = look.map(|[x, y]| picture.get_pixel(x as u32, (height - 1 - y) as u32).0);
    let look = look.zip(theirs);
    let said =
        renderer_with(1).map_err(|error| Failure::Failed(text::reason(&error)))?.run(|| match args.json {
            true => text::json_in_lines(&Numbers::of(&grade, &plan, look)),
            false => message(&grade, &plan, look),
        });
    print(&said)?;
    Ok(grade.findings.is_empty())
}

/// The pixel to look at, and its bytes in the picture.
type Look = Option<([usize; 2], [u8; 3])>;

fn share(finding: &Finding, grade: &Grade) -> f64 {
    finding.pixels as f64 / grade.differing() as f64
}

fn message(grade: &Grade, plan: &Plan, look: Look) -> String {
    let pixels = count(grade.pixels, "pixel");
    let Some(([x, y], [r, g, b])) = look else {
        return format!("the picture is what the scene shows: none of {pixels} differs\n");
    };
    let differing = grade.differing();
    let (verb, percent) =
        (if differing == 1 { "differs" } else { "differ" }, 100.0 * differing as f64 / grade.pixels as f64);
    let mut text = format!("{differing} of {pixels} {verb} ({percent:.4} %); the picture\n");
    for finding in &grade.findings {
        let ([x, y], percent) = (finding.first, 100.0 * share(finding, grade));
        let percent = if percent < 1.0 { "<1".to_owned() } else { format!("{percent:.0}") };
        let words = finding.mistake.words(plan.model);
        let _ = writeln!(text, "{:>9}  {percent:>3} %  {words}; first at {x} {y}", finding.pixels);
    }
    let _ = writeln!(text, "\nlook first at pixel {x} {y}, which is ({r}, {g}, {b}) in the picture\n");
    let mut explained = Vec::new();
    // Memory takes all.
    let _ = probe::pixel(plan, x, y, &mut explained);
    text + &String::from_utf8_lossy(&explained)
}

/// What is printed as JSON.
#[derive(Serialize)]
struct Numbers<'m> {
    same: bool,
    pixels: usize,
    differing: usize,
    findings: Vec<Found>,
    #[serde(skip_serializing_if = "Option::is_none")]
    look: Option<LookAt<'m>>,
}

/// The pixels that differ in one way.
#[derive(Serialize)]
struct Found {
    kind: &'static str,
    /// In words that complete "the picture".
    what: String,
    pixels: usize,
    /// The part of the pixels that differ.
    share: f64,
    first: [usize; 2],
}

/// The pixel to look at first.
#[derive(Serialize)]
struct LookAt<'m> {
    picture: [u8; 3],
    scene: PixelExplained<'m>,
}

impl<'m> Numbers<'m> {
    fn of(grade: &Grade, plan: &Plan<'m>, look: Look) -> Self {
        let model: &Model = plan.model;
        let found = |finding: &Finding| Found {
            kind: finding.mistake.kind(),
            what: finding.mistake.words(model),
            pixels: finding.pixels,
            share: share(finding, grade),
            first: finding.first,
        };
        Self {
            same: grade.findings.is_empty(),
            pixels: grade.pixels,
            differing: grade.differing(),
            findings: grade.findings.iter().map(found).collect(),
            look: look.map(|([x, y], picture)| LookAt { picture, scene: probe::explained(plan, x, y) }),
        }
    }
}
