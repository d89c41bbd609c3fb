//! `tabray hard`: writes rays that are hard to decide.

use super::files::of_name;
use super::model;
use crate::hits::answers::AnswerFormat;
use crate::hits::hard;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tabray_cli::files::output::{self, Output};
use tabray_cli::options::number::whole;
use tabray_cli::options::{set, threads};
use tabray_cli::process::failure::Failure;
use tabray_cli::process::interrupt::{self, InterruptAction};
use tabray_cli::process::messages;
use tabray_cli::{Command, Group, Run};
use tabray_core::query::Query;
use tabray_core::text::count;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::registry::Registry;

/// Write rays that are hard to decide
///
/// The rays are aimed at outlines, at edges between faces, at seams between objects, and at corners. They pass these at
/// distances of 1e-2 to 1e-15 of the object's size, or, up to rounding, meet them. `hits` answers such rays, and
/// `judge` judges the answers of another ray tracer.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scene, or a mesh file; `-` reads a scene from standard input
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    #[command(flatten)]
    set: set::Args,
    /// The number of rays
    #[arg(short = 'n', long = "count", value_name = "N", default_value = "1000", value_parser = whole::<u32>(1..=100_000_000))]
    count: u32,
    /// The seed: another number gives other rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write the rays to this file; its ending, .csv, .jsonl or .npy, is their format
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The format on standard output
    #[arg(long, value_name = "FORM", default_value = "csv", conflicts_with = "output")]
    to: AnswerFormat,
    #[command(flatten)]
    threads: threads::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray hard ball.ray -n 100000 -o rays.csv
  tabray hard part.stl --seed 2 --to jsonl";

inventory::submit! {
    Command::new("hard", Group::Rays, &Run(run)).placed(2, 13)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let format = match &args.output {
        None => args.to,
        Some(path) => of_name(path)?,
    };
    let model = model::load(registry, &args.scene, &args.set, Some(Accuracy::Exact))?;
    interrupt::catch(InterruptAction::Exit("the rays were not finished"))?;
    let path = args.output.as_deref().unwrap_or(Path::new("-"));
    if args.output.is_some() {
        output::refuse_source_by(path, "the rays", &args.scene, &model)?;
    }
    let wanted = args.count as usize;
    let rays = hard::rays(&args.threads.renderer()?, &Query::new(&model), wanted, args.seed);
    if rays.is_empty() {
        let help = "the scene has no edge, outline, seam or corner that rays from around its objects find";
        return Err(Failure::usage("no ray is hard to decide").help(help));
    }
    let is_text = args.output.is_none() && format != AnswerFormat::Npy;
    let mut out = BufWriter::new(if is_text { Output::Standard } else { Output::open(path)? });
    let written = hard::write(format, &rays, &mut out).and_then(|()| out.flush());
    match written {
        // A reader that closes the pipe is no failure.
        Err(error) if is_text && error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
        written => output::finished(path, written, out)?,
    }
    if rays.len() < wanted {
        messages::warning(&format!("only {} were found", count(rays.len(), "hard ray")), None);
    }
    Ok(())
}
