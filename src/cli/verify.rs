//! `tabray verify`: proves, pixel by pixel, which object is seen, or what its colour is.

mod colours;

use crate::cli::files::input;
use crate::cli::files::output::{self, Output, format_by_name};
use crate::cli::options::number::whole;
use crate::cli::options::{method, set};
use crate::cli::process::failure::{Failure, print};
use crate::cli::process::interrupt::{self, InterruptAction};
use crate::cli::process::progress::Progress;
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::scene::registry::Registry;
use crate::text;
use crate::tools::verify::{self, Verdict};
use std::iter;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Prove for each pixel which object is seen, or the bytes of its colour
///
/// The proof is about the real ray through the centre of the pixel and the scene's numbers as they are written. It uses
/// intervals of 53 bits that contain all rounding errors and, where these do not decide, intervals of 237 bits; it is
/// independent of the methods that render the image. A pixel that 237 bits leave undecided is a tie, such as a point
/// where two objects coincide. The exit status is 1 if the tracer finds an object that is neither the first nor part of
/// a tie.
///
/// With --colours, every decision behind a pixel is proven: each hit, shadow, mirror and pane, and the tile or texel
/// that is hit. Intervals enclose the colour, and a pixel is proven if they contain a single colour in bytes, which is
/// that of the image. The image may differ by rounding, where the true ray passes exactly through an edge or a level is
/// a whole number; the exit status is 1 if it differs by more.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scene; `-` reads it from standard input
    scene: PathBuf,
    #[command(flatten)]
    set: set::Args,
    /// Write an image of the result: black for proven pixels, white for ties, red where the tracer finds another
    /// object; a .png or .ppm file. With --colours, white for open pixels, and grey where the image differs by rounding
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Prove the colours of pixels, byte by byte
    #[arg(long)]
    colours: bool,
    #[command(flatten)]
    of_colours: colours::Args,
    #[command(flatten)]
    method: method::Args,
    /// The number of threads; by default one per core
    #[arg(long, value_name = "N", value_parser = whole::<u16>(1..=1024))]
    threads: Option<u16>,
}

const EXAMPLES: &str = "\
Examples:
  tabray verify ball.ray
  tabray verify ball.ray -o proven.png
  tabray verify ball.ray --colours";

pub fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let model = input::load(registry, &args.scene, &args.set, args.method.accuracy()?)?;
    interrupt::catch(InterruptAction::Exit("the image was not finished"))?;
    let picture = match args.output {
        Some(path) => {
            let format = format_by_name(&path, "end it in .png or .ppm")?;
            output::refuse_source(&path, &args.scene, &model)?;
            let output = Output::open(&path)?;
            Some((path, format, output))
        }
        None => None,
    };
    let size = model.camera.value.pixels;
    let progress = Progress::new(size[1]);
    let renderer = Renderer::new(args.threads.unwrap_or(0).into())?;
    let plan = Plan::new(&model);
    if args.colours {
        let proof = colours::prove(&args.of_colours, &renderer, plan, &progress);
        progress.end();
        return colours::report(&args.of_colours, proof?, picture);
    }
    let verdicts = verify::picture(&renderer, &plan, &|| {
        progress.step();
        ControlFlow::Continue(())
    });
    progress.end();
    let verdicts = verdicts.map_err(|_| Failure::Interrupted("the image was not finished"))?;
    let count = |wanted| verdicts.iter().filter(|verdict| **verdict == wanted).count();
    let (ties, contradicted) = (count(Verdict::Tie), count(Verdict::Contradicted));
    let proven = verdicts.len() - ties - contradicted;
    let percent = 100.0 * proven as f64 / verdicts.len() as f64;
    print(&format!(
        "{proven} of {} pixels proven ({percent:.4} %), {}, {contradicted} contradicted\n",
        verdicts.len(),
        text::count(ties, "tie"),
    ))?;
    if let Some((path, format, output)) = picture {
        let colour = |verdict: &Verdict| match verdict {
            Verdict::Proven => [0; 3],
            Verdict::Tie => [255; 3],
            Verdict::Contradicted => [255, 0, 0],
        };
        let bytes = verdicts.iter().flat_map(colour).collect();
        output::write_image(&path, output, |out| format.write(out, size, iter::once(Ok(bytes))))?;
    }
    if contradicted > 0 {
        return Err(Failure::Failed(format!(
            "the tracer finds another object at {}",
            text::count(contradicted, "pixel")
        )));
    }
    Ok(())
}
