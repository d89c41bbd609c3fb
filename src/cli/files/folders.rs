//! Folders in the place of scenes: they stand for the scenes in them.

use crate::process::failure::Failure;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use tabray_core::text;

/// Tells whether a file in a folder is a scene, by its name.
pub fn is_scene(path: &Path) -> bool {
    let is_hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
    let extension = path.extension().and_then(OsStr::to_str).unwrap_or_default();
    !is_hidden && ["ray", "toml"].iter().any(|known| extension.eq_ignore_ascii_case(known))
}

/// Returns the scenes in a folder, sorted.
pub fn scenes(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let list = || -> io::Result<Vec<PathBuf>> {
        let mut scenes = Vec::new();
        for file in fs::read_dir(folder)? {
            let path = file?.path();
            if is_scene(&path) && path.is_file() {
                scenes.push(path);
            }
        }
        scenes.sort();
        Ok(scenes)
    };
    list().map_err(|error| {
        let reason = text::reason(&error);
        Failure::Unread(format!("cannot read the folder `{}`: {reason}", text::shown(folder)), None)
    })
}

/// Returns the scenes in a folder, sorted, of which there is at least one.
pub fn some_scenes(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let scenes = scenes(folder)?;
    if scenes.is_empty() {
        let message = format!("there is no scene in the folder `{}`", text::shown(folder));
        return Err(Failure::Unread(message, Some("the names of scenes end in .ray or .toml".to_owned())));
    }
    Ok(scenes)
}

/// Puts the scenes of each folder in its place; returns whether there was a folder.
pub fn open(named: &mut Vec<PathBuf>) -> Result<bool, Failure> {
    let is_folder = named.iter().any(|path| path.is_dir());
    if is_folder {
        let opened =
            named.drain(..).map(|path| if path.is_dir() { some_scenes(&path) } else { Ok(vec![path]) });
        *named = opened.collect::<Result<Vec<_>, _>>()?.concat();
    }
    Ok(is_folder)
}
