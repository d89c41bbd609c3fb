//! What a scheduler is to run, in words for a shell.

use std::path::{Path, PathBuf};
use tabray_cli::process::failure::Failure;
use tabray_core::text;

/// An order that was checked, in words for a shell.
pub struct Job {
    pub scene: String,
    pub image: String,
    /// The image, or the name of the frames.
    pub path: PathBuf,
    pub parts: u32,
    /// The options of each part, each after a space.
    pub options: String,
    /// The command that puts the parts together, without the program.
    pub last: String,
}

impl Job {
    /// Returns the command that renders a part, without the program; the number of the part is a word for the shell.
    pub fn part(&self, number: &str) -> String {
        let Self { scene, image, parts, options, .. } = self;
        format!("render {scene} -o {image} --part {number}/{parts} --resume{options}")
    }

    /// Refuses an absolute path where all paths are relative to a folder.
    pub fn refuse_absolute(&self, folder: &str) -> Result<(), Failure> {
        let is_outside = |word: &str| word.trim_start_matches(['\'', '$']).starts_with('/');
        match [&self.scene, &self.image].into_iter().find(|word| is_outside(word)) {
            Some(path) => Err(Failure::usage(format!("{path} is not relative to {folder}"))
                .help(format!("in the container, {folder} is mounted as /scenes"))),
            None => Ok(()),
        }
    }
}

/// Quotes a path for a shell. What a script or a log could show as something else is refused.
pub fn word(path: &Path) -> Result<String, Failure> {
    let sound = path.to_str().filter(|path| !path.contains(char::is_control));
    let Some(sound) = sound else {
        return Err(Failure::usage(format!("a script cannot name `{}`", text::shown(path)))
            .help("give it a name in UTF-8 without line ends and other control characters"));
    };
    // A path is no option.
    let own = if sound.starts_with('-') { Path::new(".").join(path) } else { path.to_owned() };
    Ok(text::quoted(own.as_os_str()))
}
