//! `tabray probe`: explains one pixel.

use crate::command::{Command, Group, Run};
use crate::files::standard::StandardOutput;
use crate::options::{method, scene};
use crate::process::failure::Failure;
use crate::process::visible::Visible;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_tools::probe;
use tabray_tools::threads::renderer_with;

/// Explain how a pixel gets its colour
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// The pixel's column, from 0 at the left
    #[arg(allow_negative_numbers = true, value_parser = place)]
    x: i64,
    /// The pixel's row, from 0 at the bottom
    #[arg(allow_negative_numbers = true, value_parser = place)]
    y: i64,
    /// Print all rays and colours as JSON, with all digits
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    method: method::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray probe ball.ray 160 120
  tabray probe ball.ray 160 120 --json
  tabray probe ball.ray 160 120 --method classic";

/// Reads the number of a column or a row.
fn place(text: &str) -> Result<i64, String> {
    text.parse().map_err(|_| "give the pixel's column and row as whole numbers".to_owned())
}

inventory::submit! {
    Command::new("probe", Group::First, &Run(run)).placed(5, 10)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let model = args.scene.load(registry, args.method.accuracy()?)?;
    let [x, y] = inside(&model, [args.x, args.y])?;
    let mut out = BufWriter::new(StandardOutput);
    let plan = Plan::new(&model);
    let printed = renderer_with(1)?.run(|| {
        match args.json {
            true => out.write_all(text::json_in_lines(&probe::explained(&plan, x, y)).as_bytes())?,
            false => probe::pixel(&plan, x, y, &mut Visible(&mut out))?,
        }
        out.flush()
    });
    match printed {
        // A reader that closes the pipe is no failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::cannot_write(Path::new("-"), &error))
        }
        _ => Ok(()),
    }
}

/// Returns a pixel that the user named, if the image contains it.
pub fn inside(model: &Model, pixel: [i64; 2]) -> Result<[usize; 2], Failure> {
    let size = model.camera.value.pixels;
    let find = |side: usize| usize::try_from(pixel[side]).ok().filter(|at| *at < size[side]);
    find(0).zip(find(1)).map(|(x, y)| [x, y]).ok_or_else(|| {
        let ([x, y], [width, height]) = (pixel, size);
        Failure::usage(format!("the image of {width} x {height} pixels has no pixel {x} {y}")).help(format!(
            "X counts from the left, from 0 to {}, and Y from the bottom, from 0 to {}",
            width - 1,
            height - 1
        ))
    })
}
