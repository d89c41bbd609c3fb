//! `tabray render --debug`: the notes' debug lines, for some pixels or for all.

use crate::options::named::by_name;
use crate::probe;
use crate::process::failure::Failure;
use crate::process::visible::Visible;
use std::io::{self, BufWriter, Write};
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_tools::debug::{self, LogLine};
use tabray_tools::threads::renderer_with;

#[derive(clap::Args)]
#[group(id = "debug lines")]
#[command(next_help_heading = "Looking inside")]
pub struct Args {
    /// Print the course notes' debug lines to standard error before rendering
    #[arg(long, value_name = "LINES", value_delimiter = ',', value_parser = by_name::<LogLine>())]
    debug: Vec<LogLine>,
    /// Print the debug lines of one pixel, or of a rectangle including both corners. Columns count from 0 at the left,
    /// and rows from 0 at the bottom
    #[arg(long, value_name = "X,Y|X0,Y0,X1,Y1", requires = "debug", value_parser = corners)]
    #[arg(allow_hyphen_values = true)]
    at: Option<[[i64; 2]; 2]>,
}

/// Prints the debug lines that are asked for.
pub fn print(model: &Model, args: &Args) -> Result<(), Failure> {
    if args.debug.is_empty() {
        return Ok(());
    }
    let [width, height] = model.camera.value.pixels;
    let [a, b] = match args.at {
        Some([a, b]) => [probe::inside(model, a)?, probe::inside(model, b)?],
        None => [[0, 0], [width - 1, height - 1]],
    };
    let plan = Plan::new(model);
    // If standard error is closed, no one can be told.
    let _: io::Result<()> = renderer_with(1)?.run(|| {
        let mut out = BufWriter::new(io::stderr());
        // The notes' order of pixels.
        for y in a[1].min(b[1])..=a[1].max(b[1]) {
            for x in a[0].min(b[0])..=a[0].max(b[0]) {
                debug::pixel(&plan, x, y, &args.debug, &mut Visible(&mut out))?;
            }
        }
        // The notes' lines begin with a line end and have none at their end, so later output needs one here.
        writeln!(out)?;
        out.flush()
    });
    Ok(())
}

/// Parses one pixel or two corners.
fn corners(text: &str) -> Result<[[i64; 2]; 2], String> {
    let numbers: Result<Vec<i64>, _> = text.split(',').map(str::parse).collect();
    match numbers.as_deref() {
        Ok([x, y]) => Ok([[*x, *y]; 2]),
        Ok([x0, y0, x1, y1]) => Ok([[*x0, *y0], [*x1, *y1]]),
        _ => Err("give a pixel as `X,Y` or two corners as `X0,Y0,X1,Y1`, whole numbers".to_owned()),
    }
}
