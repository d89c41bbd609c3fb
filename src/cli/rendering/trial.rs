//! Notices, once an image is rendered, whether the tracer finds other objects in it than the first.

use crate::options::size::Region;
use crate::process::messages;
use std::path::Path;
use std::time::Duration;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::text::{count, shown};
use tabray_core::world::accuracy::Accuracy;
use tabray_tools::clock;
use tabray_tools::verify::{self, Trial};

/// The largest part of the time of a render that the trial of its pixels takes, and a time that it may take in any case.
const PART: u32 = 100;
const FREE: Duration = Duration::from_millis(5);

/// Tries some pixels of an image whose render took some time, and warns if the tracer is mistaken there. The texts tell
/// how the image is made: they decide which pixels are tried. The classic method is meant to lose hits.
pub fn warn_of_mistakes(
    (plan, region): (&Plan, &Region),
    renderer: &Renderer,
    made: &[(&str, String)],
    scene: &Path,
    took: Duration,
) {
    if plan.camera.accuracy == Accuracy::Classic || !verify::is_searched_for(plan.model) {
        return;
    }
    let name: String = made.iter().map(|(_, text)| &**text).collect();
    let region = [&region.columns, &region.rows];
    let Trial { pixels, contradicted } = renderer.run(|| {
        let end = clock::now() + FREE.max(took / PART);
        verify::trial(plan, region, &name, &|| clock::now() >= end)
    });
    if contradicted > 0 {
        messages::warning(
            &format!(
                "the tracer finds another object than the first at {contradicted} of {} that were tried",
                count(pixels, "pixel")
            ),
            Some(&format!("`tabray verify {}` tries all, and with `-o` shows where it does", shown(scene))),
        );
    }
}
