//! `tabray chart`: what each choice costs in a scene, and how wrong it is.

use super::failure::{Failure, print};
use super::input::{self, Source};
use super::output::{self, Output, finished};
use super::progress::Progress;
use super::{interrupt, messages};
use crate::scene::choice::Choice;
use crate::scene::model::Model;
use crate::scene::registry::Registry;
use crate::tools::chart::{self, Chart};
use crate::world::accuracy::Accuracy;
use std::io::{self, BufWriter, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Chart what each choice costs in a scene, and how wrong it is
///
/// It finds the truth, runs the choices that the scene has - ways to find the hits of its shapes, and samples for each
/// pixel - by turns, and says which are best. Ctrl-C keeps what is measured by then.
#[derive(clap::Args)]
pub struct Args {
    /// The scene; `-` reads it from standard input
    scene: PathBuf,
    /// Where to put the chart, as SCENE.svg and SCENE.png, its numbers, as SCENE.csv and SCENE.json, and the verdict in
    /// words, as SCENE.txt; by default the working directory
    #[arg(short, long, value_name = "DIR", default_value = ".", hide_default_value = true)]
    output: PathBuf,
}

pub fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let source = Source::read(&args.scene)?;
    input::told(source.load(registry, None))?;
    let load = all_accuracies(registry, &source)?;
    let name = match args.scene.file_stem() {
        Some(stem) if !input::is_standard(&args.scene) => stem.to_string_lossy().into_owned(),
        _ => "stdin".to_owned(),
    };
    let folder = &args.output;
    output::folder(folder)?;
    let files = ["svg", "png", "csv", "json", "txt"].map(|extension| {
        let path = folder.join(format!("{name}.{extension}"));
        Output::open(&path).map(|output| (path, output))
    });
    interrupt::catch()?;
    let mut work = Work::new();
    let chart = chart::measure(&name, &load, &mut work);
    work.end();
    let chart = chart?;
    if chart.panels.is_empty() {
        return Err(Failure::Interrupted("nothing was measured yet"));
    }
    let words = chart::words(&chart);
    for (file, bytes) in files.into_iter().zip(contents(&chart, &words)?) {
        let (path, output) = file?;
        put(&path, output, &bytes)?;
    }
    print(&words)?;
    if chart.is_whole { Ok(()) } else { Err(Failure::Interrupted("the chart has what was measured by then")) }
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

fn put(path: &Path, output: Output, bytes: &[u8]) -> Result<(), Failure> {
    let mut out = BufWriter::new(output);
    let written = out.write_all(bytes);
    finished(path, written, out)?;
    messages::note(&format!("wrote {}", path.display()));
    Ok(())
}

/// Loads a scene in any accuracy, once it was seen that each can be had.
pub fn all_accuracies<'s>(
    registry: &'s Registry,
    source: &'s Source,
) -> Result<impl Fn(Option<Accuracy>) -> io::Result<Model> + 's, Failure> {
    for accuracy in Accuracy::all() {
        source.load(registry, Some(accuracy)).map_err(Failure::Scene)?;
    }
    Ok(move |accuracy| {
        let loaded = source.load(registry, accuracy);
        loaded.map(|loaded| loaded.model).map_err(|report| io::Error::other(report.to_string()))
    })
}

/// Measuring on a terminal: a bar, which an interruption ends.
pub struct Work(Progress);

impl Work {
    pub fn new() -> Self {
        Self(Progress::new(0))
    }

    pub fn end(&self) {
        self.0.end();
    }
}

impl chart::Progress for Work {
    fn more(&mut self, units: usize) {
        self.0.lengthen(units);
    }

    fn done(&mut self, units: usize) -> ControlFlow<()> {
        self.0.advance(units);
        interrupt::check()
    }
}
