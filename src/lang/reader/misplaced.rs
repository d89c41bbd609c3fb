//! Guesses of the intended file for a name that does not exist: one with another extension, or in a nearby folder.

use std::path::{Component, Path, PathBuf};
use tabray_core::files;
use tabray_core::text::{nearest_file, shown};

/// The extensions of supported images.
pub const IMAGES: [&str; 13] =
    ["ppm", "png", "pgm", "pbm", "pnm", "jpg", "jpeg", "webp", "bmp", "tif", "tiff", "hdr", "exr"];

/// The maximum number of searched folders, and of files in each.
const FOLDERS: usize = 64;
const FILES: usize = 4096;

/// Returns the name of the image that a scene in `folder` probably meant by a name that does not exist.
pub fn image(folder: &Path, written: &str) -> Option<String> {
    let slashes = written.replace('\\', "/");
    if slashes != written && files::is_file(&folder.join(&slashes)) {
        return Some(slashes);
    }
    let written = Path::new(written);
    let name = written.file_name()?;
    let own = written.parent().unwrap_or(Path::new(""));
    let same = |place: &Path| like(&folder.join(place), written).map(|name| place.join(name));
    let places = places(folder, own);
    let exact =
        || places.iter().map(|place| place.join(name)).find(|path| files::is_file(&folder.join(path)));
    let found = same(own).or_else(exact).or_else(|| places.iter().find_map(|place| same(place)));
    let found = found.or_else(|| nearest_file(&folder.join(written)).map(|near| own.join(near)));
    found.map(shown)
}

/// Returns the folders near the one that a scene names, relative to the scene's folder.
fn places(folder: &Path, own: &Path) -> Vec<PathBuf> {
    let up = Path::new("..");
    let mut places = vec![up.join(own)];
    let mut rest = own.components();
    if rest.next().is_some_and(|first| matches!(first, Component::ParentDir | Component::Normal(_))) {
        places.push(rest.as_path().to_owned());
        // This is the path without any `..`, beside the scene.
        let is_up = |part: &Component<'_>| *part == Component::ParentDir;
        places.push(own.components().filter(|part| !is_up(part)).collect());
    }
    places.extend([PathBuf::new(), up.to_owned()]);
    for within in [Path::new(""), up] {
        let entries = files::read_dir(&folder.join(within)).into_iter().flatten().take(FILES);
        let folders = entries.filter_map(Result::ok).filter(|entry| entry.path().is_dir());
        let mut folders: Vec<_> = folders.map(|folder| within.join(folder.file_name())).collect();
        // The order of a folder's entries is arbitrary.
        folders.sort_unstable();
        places.extend(folders);
    }
    places.truncate(FOLDERS);
    places
}

/// Returns the name of an image in a folder with the same name except for its extension and letter case.
fn like(folder: &Path, written: &Path) -> Option<String> {
    let stem = written.file_stem()?.to_str()?;
    let names = files::read_dir(folder)
        .ok()?
        .take(FILES)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let is_like = |name: &String| {
        let path = Path::new(name);
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        IMAGES.iter().any(|image| extension.eq_ignore_ascii_case(image))
            && path
                .file_stem()
                .and_then(|stem| stem.to_str())
                .is_some_and(|own| own.eq_ignore_ascii_case(stem))
    };
    names.filter(is_like).min()
}
