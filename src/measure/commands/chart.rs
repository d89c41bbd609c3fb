//! `tabray chart`: the cost and the error of each choice in a scene.

use crate::chart::{self, Chart};
use crate::measuring::{Limit, Work, wait};
use std::io::{self, Write};
use std::panic;
use std::path::{Path, PathBuf};
use std::sync::PoisonError;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};
use tabray_cli::files::input::{self, Source};
use tabray_cli::files::output::{self, Output};
use tabray_cli::options::scene;
use tabray_cli::process::failure::{self, Failure, print};
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::process::{messages, progress, time_limit};
use tabray_cli::{Command, Group, Run};
use tabray_core::render::plan::Plan;
use tabray_core::scene::choice::Choice;
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::reader::ReadOptions;
use tabray_lang::registry::Registry;
use tabray_tools::unchecked;

/// Chart the cost and the error of each choice in a scene
///
/// Computes the true hits and colours, runs the choices of the scene in turn (methods of finding hits, and samples per
/// pixel), and says which are best. Ctrl-C keeps the measurements so far.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// The folder for the chart (SCENE-chart.svg and .png), its numbers (.csv and .json) and the verdict in words
    /// (.txt), by default the working directory; or a single file to write, such as `a.svg`
    #[arg(short, long, value_name = "DIR|FILE", default_value = ".", hide_default_value = true)]
    output: PathBuf,
}

const EXAMPLES: &str = "\
Examples:
  tabray chart ball.ray
  tabray chart ball.ray -o ball.svg --time-limit 5m";

/// The time that a chart may take if no time limit is given: on a quiet machine, most scenes take less.
const LIMIT: Duration = Duration::from_secs(120);

const NOTHING: &str = "nothing has been measured yet";

inventory::submit! {
    Command::new("chart", Group::Measuring, &Run(run)).placed(1, 15)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let limit = Limit::new(time_limit::given(), LIMIT);
    let (mut work, start) = (Work::within(limit), Instant::now());
    let source = args.scene.read()?;
    let model = input::print_warnings(source.load(registry, None))?.model;
    let load = all_accuracies(registry, &source)?;
    let name = match args.scene.path.file_stem() {
        Some(stem) if !input::is_standard(&args.scene.path) => stem.to_string_lossy().into_owned(),
        _ => "stdin".to_owned(),
    };
    let files = files(&args.output, &name, |path| output::refuse_source(path, &args.scene.path, &model))?;
    let unchecked = unchecked::of(&Plan::new(&model));
    drop(model);
    // Until here, what takes too long has nothing to keep.
    time_limit::keep();
    interrupt::catch(InterruptAction::SetFlagThenExit(NOTHING))?;
    let (kept, units) = (work.panels(), work.units());
    let end = |chart: Chart| {
        interrupt::set_action(InterruptAction::SetFlag);
        end(&chart, files)
    };
    thread::scope(|scope| {
        let (sender, measured) = mpsc::channel();
        let (title, load) = (text::shown(&name), &load);
        scope.spawn(move || {
            let chart = chart::measure(&title, load, &mut work);
            work.end();
            let _ = sender.send(chart);
        });
        // A measurement that takes far too long is not waited for.
        match wait(&measured, &units, limit.last().saturating_sub(start.elapsed())) {
            Ok(chart) => end(chart?),
            Err(RecvTimeoutError::Timeout) => {
                progress::clear();
                let panels = kept.lock().unwrap_or_else(PoisonError::into_inner).clone();
                match end(Chart { panels, unchecked, ..Chart::empty(&name) }) {
                    Ok(()) => failure::exit(),
                    Err(failure) => failure::end(&failure),
                }
            }
            // The thread panicked, and has said so.
            Err(RecvTimeoutError::Disconnected) => panic::resume_unwind(Box::new(())),
        }
    })
}

/// The extensions of the files of a chart.
const EXTENSIONS: [&str; 5] = ["svg", "png", "csv", "json", "txt"];

/// The files to write, each with its path; `None` for those that are not wanted.
type Files = [Option<(PathBuf, Output)>; 5];

/// Opens the files of a chart: all of them in a folder, or the one that is named. `may_be` refuses those that the scene was
/// read from.
fn files(output: &Path, name: &str, may_be: impl Fn(&Path) -> Result<(), Failure>) -> Result<Files, Failure> {
    let open = |path: PathBuf| {
        may_be(&path)?;
        Output::open(&path).map(|output| Some((path, output)))
    };
    let extension = output.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let named = EXTENSIONS.iter().position(|known| extension.eq_ignore_ascii_case(known));
    let mut files = [const { None }; 5];
    match named.filter(|_| !output.is_dir()) {
        Some(one) => files[one] = open(output.to_owned())?,
        None => {
            output::create_folder(output)?;
            for (file, extension) in files.iter_mut().zip(EXTENSIONS) {
                *file = open(output.join(format!("{name}-chart.{extension}")))?;
            }
        }
    }
    Ok(files)
}

/// Writes a chart and prints its verdict.
fn end(chart: &Chart, files: Files) -> Result<(), Failure> {
    if chart.panels.is_empty() {
        return Err(if interrupt::check().is_break() {
            Failure::Interrupted(NOTHING)
        } else {
            Failure::Failed("the time limit has been reached, and nothing is measured yet".to_owned())
        });
    }
    let words = chart::words(chart);
    for (file, bytes) in files.into_iter().zip(contents(chart, &words)?) {
        let Some((path, output)) = file else { continue };
        output::write_image(&path, output, |out| out.write_all(&bytes))?;
    }
    print(&words)?;
    if interrupt::check().is_break() {
        return Err(Failure::Interrupted("the chart shows what has been measured so far"));
    }
    if !chart.is_whole {
        messages::note("there was not enough time for all of the chart; `--time-limit` gives it more");
    }
    Ok(())
}

fn contents(chart: &Chart, words: &str) -> io::Result<[Vec<u8>; 5]> {
    Ok([
        chart::svg(chart)?.into_bytes(),
        chart::png(chart)?,
        chart::csv(chart).into_bytes(),
        chart::json(chart).into_bytes(),
        words.as_bytes().to_vec(),
    ])
}

/// Returns a function that loads a scene with any accuracy, after checking that the scene loads with each.
pub fn all_accuracies<'s>(
    registry: &'s Registry,
    source: &'s Source,
) -> Result<impl Fn(Option<Accuracy>) -> io::Result<Model> + 's, Failure> {
    // A change of the rules of light is no error of a method.
    let rules = source.load(registry, None).map_err(Failure::Scene)?.model.camera.value.rules;
    let by =
        move |accuracy| ReadOptions { above_all: accuracy, rules: Some(rules), ..ReadOptions::default() };
    for accuracy in Accuracy::all() {
        source.load_by(registry, by(Some(accuracy))).map_err(Failure::Scene)?;
    }
    Ok(move |accuracy| {
        let loaded = source.load_by(registry, by(accuracy));
        loaded.map(|loaded| loaded.model).map_err(|report| io::Error::other(report.to_string()))
    })
}
