//! `bench --sampling certain`: what `--max-error --certain` proves, whether samples contradict it, and what it costs.

use crate::certain::{self, Outcome};
use std::path::Path;
use tabray_cli::process::failure::{Failure, print};
use tabray_core::scene::model::Model;
use tabray_core::text::short;
use tabray_tools::threads::renderer_with;

/// The limits that are measured, in levels.
const LIMITS: [f64; 3] = [1.0, 2.0, 4.0];

/// Measures the scenes, and prints a table in Markdown.
pub fn run(models: Vec<(String, Model)>, size: Option<[usize; 2]>) -> Result<(), Failure> {
    let renderer = renderer_with(0)?;
    print(
        "| scene | levels | pixels certified | worst of them | contradicted | bound of the others, mean | most | footprints per pixel | CPU seconds | without |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    )?;
    for (path, mut model) in models {
        let camera = &mut model.camera.value;
        camera.pixels = size.unwrap_or(camera.pixels);
        let scene = Path::new(&path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let truth = certain::truth(&renderer, &mut model);
        for levels in LIMITS {
            let outcome = certain::measure(&renderer, &mut model, levels / 255.0, &truth);
            let Outcome { certified, worst, contradicted, open: [mean, most], footprints, .. } = outcome;
            let Outcome { seconds, without, .. } = outcome;
            let share = (1e4 * certified).floor() / 100.0;
            print(&format!(
                "| {scene} | {} | {share:.2} % | {worst:.2} | {contradicted} | {mean:.1} | {most:.1} | {footprints:.1} | \
                 {seconds:.2} | {without:.2} |\n",
                short(levels)
            ))?;
        }
    }
    Ok(())
}
