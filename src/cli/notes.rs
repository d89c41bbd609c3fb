//! Without a subcommand: the notes' program, a filter from a scene to its dump and its image.

use crate::cli::files::input::Source;
use crate::cli::files::output::Output;
use crate::cli::options::set;
use crate::cli::options::size::Part;
use crate::cli::options::stop::Stop;
use crate::cli::process::failure::Failure;
use crate::cli::process::interrupt::{self, InterruptAction};
use crate::cli::process::messages;
use crate::cli::rendering::job::Job;
use crate::output::picture::Format;
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::render::tiles::BAND;
use crate::scene::dump;
use crate::scene::reader::{Loaded, ReadOptions};
use crate::scene::registry::Registry;
use crate::world::accuracy::Accuracy;
use std::io::Write;
use std::path::Path;

pub fn run(registry: &Registry) -> Result<(), Failure> {
    let standard = Path::new("-");
    let output = Output::open(standard)?;
    // The course's own image, unless the camera asks for another method.
    let chosen =
        ReadOptions { by_default: Accuracy::Classic, may_share_names: true, ..ReadOptions::default() };
    let source = Source::read(standard, &set::Args::default())?;
    let Loaded { model, warnings, .. } = source.load_by(registry, chosen).map_err(Failure::Scene)?;
    interrupt::catch(InterruptAction::Exit("the image was not finished"))?;
    let _ = write!(std::io::stderr(), "{}", dump::notes(&model));
    // The dump comes first, as the course's logs have it.
    messages::warnings(&warnings);
    let job = Job {
        plan: &Plan::new(&model),
        part: &Part::whole(&model.camera.value),
        renderer: &Renderer::new(0)?,
        format: Format::Ppm,
        path: standard,
        made: &[],
        at_once: BAND,
        stop: &Stop::default(),
        stats: None,
    };
    job.run(output, None)
}
