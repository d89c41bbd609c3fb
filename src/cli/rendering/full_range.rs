//! Renders an image into a file of full range: colours before they are clamped and rounded to levels.

use crate::files::output::{self, Output};
use crate::options::size::Region;
use crate::options::stop::Stop;
use crate::process::failure::Failure;
use crate::process::progress::Progress;
use crate::process::{memory, messages};
use crate::rendering::job;
use crate::rendering::stats::Stats;
use std::path::Path;
use tabray_core::output::full_range::FullRange;
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::RayStats;
use tabray_core::render::renderer::{RenderCallbacks, Renderer};
use tabray_core::text;

/// The memory for a pixel, in bytes: its colour and its encoding.
pub const PIXEL: usize = 12 * 4;

/// The message if a render is stopped.
const UNKEPT: &str = "an EXR or a PFM is written only when it is complete: nothing is written";

/// Renders a part of an image, and writes it once it is whole: its formats cannot mark pixels that are not rendered.
pub fn render(
    (plan, region): (&Plan, &Region),
    (renderer, stop): (&Renderer, &Stop),
    (format, path): (FullRange, &Path),
    output: Output,
    stats: &Stats,
) -> Result<(), Failure> {
    let [width, height] = region.size();
    memory::refuse_too_large(PIXEL.saturating_mul(width).saturating_mul(height), "the image")?;
    let progress = Progress::new(height);
    stop.begin_unkept(UNKEPT);
    let overseer = RenderCallbacks { stops: &|| stop.is_due(), row: &|| progress.step() };
    let tally = &stats.tally;
    let add = |part: RayStats| tally.add(&part);
    let mut pixels = None;
    stats.timed(|| pixels = renderer.colours(plan, [&region.columns, &region.rows], overseer, &add));
    progress.end();
    let flaws = stats.tally.flaws();
    job::warn_of(&flaws, plan.model);
    job::tell_of_far(flaws.far);
    job::report_proofs(stats.tally.proofs(), plan);
    let Some(pixels) = pixels else {
        stop.report();
        messages::note(UNKEPT);
        return Err(Failure::Stopped);
    };
    output::write_image(path, output, |out| format.write(out, [width, height], &pixels))
}

/// Returns the error for options that these formats cannot serve.
pub fn refuse(path: &Path, what: &str) -> Failure {
    Failure::Usage(
        format!(
            "`{}` cannot be {what}: an EXR or a PFM is written only when it is complete",
            text::shown(path)
        ),
        Some("name a .png or .ppm file, or leave out the option".to_owned()),
    )
}
