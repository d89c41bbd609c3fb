//! Each entity type's scene, scenes made at random and the gallery through the commands that measure and explain.

use crate::choose::free::free;
use crate::common::load;
use crate::common::program::{folder, outcome, scene, tabray};
#[cfg(target_os = "linux")]
use crate::performance::of_children;
use rayon::prelude::*;
use std::env;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The commands, with a scene of the working directory in place of `@`.
const COMMANDS: [&str; 6] = [
    "choose @ --max-error 2 --time-limit 2s",
    "chart @ --time-limit 2s",
    "bench @ --seconds 0.01",
    "verify @",
    "plan @",
    "probe @ 16 12",
];

#[test]
fn each_entity_type_goes_through_the_commands_that_measure() {
    let folder = folder();
    let entries = fs::read_dir(scene("entities")).expect("the folder");
    let mut scenes: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "ray"));
    assert!(scenes.len() >= 62, "{} scenes", scenes.len());
    scenes
        .par_iter()
        .for_each(|path| COMMANDS.iter().for_each(|command| goes_through(&folder, command, path)));
}

/// Runs a command on a scene at a small size.
fn goes_through(folder: &TempDir, command: &str, path: &Path) {
    let size = format!("{}.pixeldim=32 24", load(path).camera.args.name());
    let words = command.split(' ').map(|word| match word {
        "@" => path.display().to_string(),
        word => word.to_owned(),
    });
    let (status, _, err) = outcome(tabray(folder).args(words).args(["--set", &size]));
    assert!(matches!(status, 0 | 1) && !err.contains("internal error"), "{command}, {path:?}: {err}");
}

/// `TABRAY_FREE_SCENES` random scenes, and as many of the gallery, in place of two.
#[test]
fn free_scenes_and_the_gallery_go_through_choose_and_chart() {
    let count = env::var("TABRAY_FREE_SCENES").map_or(2, |count| count.parse().expect("a number of scenes"));
    let folder = folder();
    let made = (0..count as u64).map(|seed| {
        let path = folder.path().join(format!("free-{seed}.ray"));
        fs::write(&path, free(seed, [32, 24])).expect("a file");
        path
    });
    let entries =
        fs::read_dir(scene("gallery")).expect("the folder").map(|entry| entry.expect("an entry").path());
    let mut gallery: Vec<_> =
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "ray")).collect();
    gallery.sort();
    let scenes: Vec<_> = made.chain(gallery.into_iter().take(count)).collect();
    for command in &COMMANDS[..2] {
        scenes.par_iter().for_each(|path| goes_through(&folder, command, path));
        #[cfg(target_os = "linux")]
        println!("{command}: {:.0} s of CPU time of all programs so far", of_children().0.as_secs_f64());
    }
}
