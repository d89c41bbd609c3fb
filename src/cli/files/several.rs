//! Several scenes for one command: the names of their images, the summary, and the exit status.

use crate::files::{input, output};
use crate::process::failure::{Failure, report, status};
use crate::process::progress;
use std::collections::HashMap;
use std::path::{self, Path, PathBuf};
use std::time::Instant;
use tabray_core::text::{self, list};

/// The maximum number of scenes that the summary names.
const NAMED: usize = 10;

/// Tells whether an output is a folder for the images of scenes, rather than the image of one.
pub fn is_folder(output: Option<&Path>, scenes: usize) -> bool {
    output.is_some_and(|path| {
        let ends = path.as_os_str().to_string_lossy().ends_with(path::is_separator);
        scenes > 1 || ends || (path.is_dir() && path.extension().is_none())
    })
}

/// Returns the path of the image of one scene.
pub fn target(output: Option<&Path>, scene: &Path, extension: &str) -> Result<PathBuf, Failure> {
    match (output, scene.file_name()) {
        (Some(path), _) => Ok(path.to_owned()),
        (None, Some(name)) if !input::is_standard(scene) => Ok(Path::new(name).with_extension(extension)),
        _ => Err(Failure::usage("a scene from standard input has no name to give its image")
            .help("name a file with `-o FILE`; `-o -` writes to standard output")),
    }
}

/// Returns the path of each scene's image in a folder, which is made where it does not exist.
pub fn targets(scenes: &[PathBuf], output: Option<&Path>, extension: &str) -> Result<Vec<PathBuf>, Failure> {
    if let Some(file) = output.filter(|path| is_file_name(path)) {
        let message =
            format!("`{}` is not a folder for the images of {} scenes", text::shown(file), scenes.len());
        let help = "name a folder with `-o DIR`; the images have the names of their scenes";
        return Err(Failure::usage(message).help(help));
    }
    let mut of: HashMap<PathBuf, &Path> = HashMap::new();
    let mut targets = Vec::new();
    for scene in scenes {
        let name = scene.file_name().filter(|_| !input::is_standard(scene)).ok_or_else(|| {
            Failure::usage("a scene from standard input has no name to give its image")
                .help("render it alone, and name a file with `-o FILE`")
        })?;
        let target = output.unwrap_or(Path::new("")).join(Path::new(name).with_extension(extension));
        if let Some(other) = of.insert(target.clone(), scene) {
            let (one, other, target) = (text::shown(other), text::shown(scene), text::shown(target));
            let message = format!("`{one}` and `{other}` would have the same image, `{target}`");
            return Err(
                Failure::usage(message).help("render them one after the other, into folders of their own")
            );
        }
        targets.push(target);
    }
    output.map_or(Ok(()), output::create_folder)?;
    Ok(targets)
}

/// Tells whether a path is not meant as a folder: it is a file, or it is named like an image.
fn is_file_name(path: &Path) -> bool {
    let name = path.as_os_str().to_string_lossy();
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let is_image =
        extension.is_some_and(|extension| ["png", "ppm", "exr", "pfm"].contains(&extension.as_str()));
    name == "-" || path.is_file() || (is_image && !path.is_dir() && !name.ends_with(path::is_separator))
}

/// Runs a function for each scene, continues after a failure, and reports at the end how many have failed. The exit
/// status is the worst of all.
pub fn for_each_scene(
    scenes: &[PathBuf],
    mut one: impl FnMut(usize) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let start = Instant::now();
    let (mut worst, mut failed) = (0, Vec::new());
    for (index, scene) in scenes.iter().enumerate() {
        progress::begin(index, scenes.len());
        if let Err(failure) = one(index) {
            report(&failure);
            worst = worst.max(status(&failure));
            failed.push(text::shown(scene));
        }
    }
    progress::clear_overall();
    let all = scenes.len();
    if failed.is_empty() {
        let seconds = start.elapsed().as_secs_f64();
        crate::process::messages::note(&format!("rendered {} in {seconds:.2} s", text::count(all, "scene")));
        return Ok(());
    }
    let named = list(failed.iter().take(NAMED).map(String::as_str));
    let more = failed.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let message =
        format!("{} of {} could not be rendered: {named}{more}", failed.len(), text::count(all, "scene"));
    crate::process::messages::error(&message, None);
    Err(Failure::Several(worst))
}
