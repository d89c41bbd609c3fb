//! Each entity type's scene through the commands that measure and explain.

use crate::common::load;
use crate::common::program::{folder, outcome, scene, tabray};
use rayon::prelude::*;
use std::fs;

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
    scenes.par_iter().for_each(|path| {
        let size = format!("{}.pixeldim=32 24", load(path).camera.args.name());
        for command in COMMANDS {
            let words = command.split(' ').map(|word| match word {
                "@" => path.display().to_string(),
                word => word.to_owned(),
            });
            let (status, _, err) = outcome(tabray(&folder).args(words).args(["--set", &size]));
            assert!(matches!(status, 0 | 1) && !err.contains("internal error"), "{command}, {path:?}: {err}");
        }
    });
}
