//! `tabray verify`: proves, pixel by pixel, which object is seen, or what its colour is.

mod colours;
mod form;
mod objects;

use crate::command::{Command, Group, Run};
use crate::files::output::{self, Output, format_by_name};
use crate::options::{method, scene, threads};
use crate::process::failure::Failure;
use crate::process::interrupt::{self, InterruptAction};
use crate::process::progress::Progress;
use form::{Form, PictureFile, Premises};
use std::ops::ControlFlow;
use std::path::PathBuf;
use tabray_core::render::plan::Plan;
use tabray_lang::registry::Registry;
use tabray_tools::verify;

/// Prove which object each pixel shows, or the bytes of its colour
///
/// The proof is about the real ray through the centre of the pixel, and the scene's numbers as they are read: each is
/// the f64 nearest to what is written, or the value of a formula as f64 computes it. Numbers that were rounded before
/// the proof starts, such as the rays of a `fisheye` or the vertices of a turned mesh, are printed as assumptions. The
/// proof uses intervals of 53 bits, which contain all rounding errors, and then intervals of 237 bits. It does not use
/// the methods that render the image, although these use the same equations and intervals where their own arithmetic
/// does not decide. A pixel that 237 bits leave undecided is a tie: two objects may coincide there. The exit status is
/// 1 if the tracer finds an object that is neither the first nor part of a tie.
///
/// If the plugin of a shape has no equation, the proof covers only rays that miss its bounds, or meet another object
/// before them. The other pixels are not certified.
///
/// With --colours, the proof covers every decision behind a pixel: each hit, shadow, mirror and pane, and the tile or
/// texel that is hit. A pixel is proven if the intervals of its colour contain a single byte for each channel, that of
/// the image. A pixel is off by rounding where the true ray passes exactly through an edge, or where a level is a whole
/// number. The exit status is 1 if a byte differs by more.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    scene: scene::Args,
    /// Write an image of the result: black for proven pixels, white for ties, blue for pixels that are not certified, red
    /// where the tracer finds another object; a .png or .ppm file. With --colours, white for open pixels, and grey where
    /// the image differs by rounding
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Prove the colours of pixels, byte by byte
    #[arg(long)]
    colours: bool,
    #[command(flatten)]
    of_colours: colours::Args,
    /// Print the counts, of all pixels and of each object's, the first pixels of each kind and what is assumed as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    method: method::Args,
    #[command(flatten)]
    threads: threads::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray verify ball.ray
  tabray verify ball.ray -o proven.png
  tabray verify ball.ray --json
  tabray verify ball.ray --colours";

inventory::submit! {
    Command::new("verify", Group::Measuring, &Run(run)).placed(2, 14)
}

fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let model = args.scene.load(registry, args.method.accuracy()?)?;
    interrupt::catch(InterruptAction::Exit("the image was not finished"))?;
    let picture = match args.output {
        Some(path) => {
            let format = format_by_name(&path, "end it in .png or .ppm")?;
            output::refuse_source(&path, &args.scene.path, &model)?;
            let output = Output::open(&path)?;
            Some(PictureFile { path, format, output })
        }
        None => None,
    };
    let size = model.camera.value.pixels;
    let progress = Progress::new(size[1]);
    let renderer = args.threads.renderer()?;
    let plan = Plan::new(&model);
    let premises = Premises::of(&plan, args.colours);
    let form = Form { size, premises, is_json: args.json };
    if args.colours {
        let proof = colours::prove(&args.of_colours, &renderer, plan, &progress);
        progress.end();
        return colours::report(proof?, &form, picture);
    }
    let pixels = verify::picture(&renderer, &plan, &|| {
        progress.step();
        ControlFlow::Continue(())
    });
    progress.end();
    let pixels = pixels.map_err(|_| Failure::Interrupted("the image was not finished"))?;
    objects::report(&model, &pixels, &form, picture)
}
