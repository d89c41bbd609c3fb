//! `tabray chart`: what each choice costs in a scene, and how wrong it is.

use super::failure::{Failure, print};
use super::input::{self, Source};
use super::interrupt::{self, Manner};
use super::output::{self, Output};
use super::progress::Progress;
use crate::scene::choice::Choice;
use crate::scene::model::Model;
use crate::scene::registry::Registry;
use crate::tools::chart::{self, Chart};
use crate::world::accuracy::Accuracy;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Chart the cost and the error of each choice in a scene
///
/// Computes the ground truth, runs the choices that the scene has (methods of finding the hits of its shapes, and
/// samples per pixel) in turn, and says which are best. Ctrl-C keeps what has been measured so far.
#[derive(clap::Args)]
pub struct Args {
    /// The scene; `-` reads it from standard input
    scene: PathBuf,
    /// Directory for the chart (SCENE.svg and SCENE.png), its numbers (SCENE.csv and SCENE.json) and the verdict in
    /// words (SCENE.txt); by default the working directory
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
    interrupt::catch(Manner::NotesFirst("nothing has been measured yet"))?;
    let mut work = Work::new();
    let chart = chart::measure(&name, &load, &mut work);
    interrupt::from_here(Manner::Notes);
    work.end();
    let chart = chart?;
    if chart.panels.is_empty() {
        return Err(Failure::Interrupted("nothing has been measured yet"));
    }
    let words = chart::words(&chart);
    for (file, bytes) in files.into_iter().zip(contents(&chart, &words)?) {
        let (path, output) = file?;
        output::put(&path, output, |out| out.write_all(&bytes))?;
    }
    print(&words)?;
    if chart.is_whole {
        Ok(())
    } else {
        Err(Failure::Interrupted("the chart shows what has been measured so far"))
    }
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
    for accuracy in Accuracy::all() {
        source.load(registry, Some(accuracy)).map_err(Failure::Scene)?;
    }
    Ok(move |accuracy| {
        let loaded = source.load(registry, accuracy);
        loaded.map(|loaded| loaded.model).map_err(|report| io::Error::other(report.to_string()))
    })
}

/// The progress of a measurement on a terminal: a bar, which an interruption ends.
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

    fn kept(&mut self) {
        interrupt::from_here(Manner::NotesFirst(
            "the measurement under way takes too long, and there is no chart",
        ));
    }
}
