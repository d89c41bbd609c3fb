//! Without a subcommand: the notes' program, a filter from a scene to its dump and its image.

use crate::files::input::Source;
use crate::files::output::Output;
use crate::files::provenance::Provenance;
use crate::options::set;
use crate::options::size::Region;
use crate::options::stop::Stop;
use crate::process::failure::Failure;
use crate::process::interrupt::{self, InterruptAction};
use crate::process::messages;
use crate::rendering::bands::TileRender;
use crate::rendering::job::Job;
use crate::rendering::stats::Stats;
use std::io::Write;
use std::path::Path;
use tabray_core::output::picture::Format;
use tabray_core::render::division::Grid;
use tabray_core::render::plan::Plan;
use tabray_core::render::tiles::BAND;
use tabray_core::text::visible_lines;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::dump;
use tabray_lang::reader::{Loaded, ReadOptions};
use tabray_lang::registry::Registry;
use tabray_tools::threads::renderer_with;

pub fn run(registry: &Registry) -> Result<(), Failure> {
    let standard = Path::new("-");
    let output = Output::open(standard)?;
    // The course's own image, unless the camera asks for another method.
    let chosen =
        ReadOptions { by_default: Accuracy::Classic, may_share_names: true, ..ReadOptions::default() };
    let source = Source::read(standard, &set::Args::default())?;
    let Loaded { model, warnings, .. } = source.load_by(registry, chosen).map_err(Failure::Scene)?;
    if model.camera.value.alpha {
        return Err(Failure::usage("the image on standard output is a PPM, which cannot be transparent")
            .help(
                "`tabray render SCENE -o image.png` makes the transparent image; or leave out `alpha yes`",
            ));
    }
    interrupt::catch(InterruptAction::Exit("the image was not finished"))?;
    let _ = write!(std::io::stderr(), "{}", visible_lines(&dump::notes(&model)));
    // The dump comes first, as the course's logs have it.
    messages::warnings(&warnings);
    let region = Region::whole(&model.camera.value);
    let tiles = TileRender {
        plan: &Plan::new(&model),
        region: &region,
        tiles: 0..Grid { size: region.size() }.count(),
        renderer: &renderer_with(0)?,
        at_once: BAND,
        stop: &Stop::default(),
        stats: &Stats::default(),
        counts: false,
    };
    Job { tiles, path: standard, made: &Provenance::default() }.bytes(output, Format::Ppm, None).map(|_| ())
}
